//! Every program that the processes can give, for tests of the shaders.

mod layered;
mod settings;

use pulp::Arch;
use settings::{advections, links, settings};

use super::fluvial_step;
use super::han::{Han, HanConstants};
use super::mei::{Mei, MeiConstants, Slope};
use super::transport_step::Carrying;
use weald_engine::program::Program;
use weald_engine::stencil::chain::Process;

/// The programs of every process in every variant that has passes or switches of its own.
pub fn programs() -> Vec<Program> {
    let water = settings().flat_map(|setting| {
        let limited = [true, false].into_iter().map(move |limiter| (setting, limiter));
        limited.flat_map(|variant| [1.0, 0.5].map(|deposit_ratio| (variant, deposit_ratio)))
    });
    let models = water.flat_map(|((setting, limiter), deposit_ratio)| {
        let mei = |slope| {
            let constants = MeiConstants { deposit_ratio, ..MEI };
            Mei { constants, limiter, slope, setting: setting.made() }.program()
        };
        [
            Han { constants: HanConstants { deposit_ratio, ..HAN }, limiter, setting: setting.made() }
                .program(),
            mei(Slope::MeanSine),
            mei(Slope::Central),
        ]
    });
    let carrying = [false, true].into_iter().flat_map(|masked| {
        advections()
            .map(move |advection| Carrying { advection, links: links(masked), arch: Arch::new() }.program())
    });
    carrying.chain(models).chain(layered::programs()).chain(fluvial_step::programs()).collect()
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
