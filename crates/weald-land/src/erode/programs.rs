//! Every program that the processes can give, for tests of the shaders.

mod layered;

use pulp::Arch;

use super::advection::Advection;
use super::han::{Han, HanConstants};
use super::links::Links;
use super::mei::{Mei, MeiConstants};
use super::setting::Setting;
use super::thermal::{Scheme, Slide, SlideConstants};
use super::transport_step::Carrying;
use weald_core::grid::Size;
use weald_engine::program::Program;
use weald_engine::stencil::chain::Process;

/// The programs of every process in every variant that has passes or switches of its own.
pub fn programs() -> Vec<Program> {
    let water = settings().flat_map(|setting| {
        let limited = [true, false].into_iter().map(move |limiter| (setting, limiter));
        limited.flat_map(|variant| [1.0, 0.5].map(|deposit_ratio| (variant, deposit_ratio)))
    });
    let models = water.flat_map(|((setting, limiter), deposit_ratio)| {
        [
            Han { constants: HanConstants { deposit_ratio, ..HAN }, limiter, setting: setting.made() }
                .program(),
            Mei { constants: MeiConstants { deposit_ratio, ..MEI }, limiter, setting: setting.made() }
                .program(),
        ]
    });
    let carrying = [false, true].into_iter().flat_map(|masked| {
        advections()
            .map(move |advection| Carrying { advection, links: links(masked), arch: Arch::new() }.program())
    });
    carrying.chain(models).chain(layered::programs()).collect()
}

const HAN: HanConstants = HanConstants {
    flow_rate: 0.4,
    capacity: 10.0,
    uptake_by_speed: 0.005,
    uptake_by_capacity: 0.0,
    deposit_ratio: 1.0,
    epsilon: 0.001,
    velocity_epsilon: 0.1,
};

const MEI: MeiConstants = MeiConstants {
    flow_rate: 0.1,
    capacity: 0.05,
    erosion: 0.1,
    deposition: 0.1,
    deposit_ratio: 1.0,
    epsilon: 0.001,
    velocity_epsilon: 0.0001,
};

/// What decides about the passes of a [`Setting`].
#[derive(Clone, Copy)]
struct Variant {
    masked: bool,
    open: bool,
    advection: Option<Advection>,
    slide: Option<Scheme>,
}

impl Variant {
    fn made(self) -> Setting {
        let Self { masked, open, advection, slide } = self;
        let constants = SlideConstants { talus: 0.8, strength: 0.05 };
        let slide = slide.map(|scheme| Slide::new(scheme, constants));
        Setting { links: links(masked), open, advection, slide, arch: Arch::new() }
    }
}

fn settings() -> impl Iterator<Item = Variant> {
    let advections = [None].into_iter().chain(advections().map(Some));
    let borders = [(false, false), (true, false), (true, true)];
    borders.into_iter().flat_map(move |(masked, open)| {
        advections.clone().flat_map(move |advection| {
            slides().into_iter().map(move |slide| Variant { masked, open, advection, slide })
        })
    })
}

fn advections() -> impl Iterator<Item = Advection> + Clone {
    let conserving = Advection::FluxCorrected { epsilon: 0.001 };
    [Advection::SemiLagrangian, Advection::MacCormack, conserving].into_iter()
}

fn slides() -> [Option<Scheme>; 4] {
    [None, Some(Scheme::Axis), Some(Scheme::Isotropic), Some(Scheme::IsotropicSymmetric)]
}

fn links(masked: bool) -> Links {
    Links::new(Size { columns: 2, rows: 2 }, masked)
}
