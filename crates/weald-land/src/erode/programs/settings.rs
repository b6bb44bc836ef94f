//! The variants in which shaders are put together.

use crate::erode::advection::Advection;
use crate::erode::links::Links;
use crate::erode::setting::Setting;
use crate::erode::thermal::{Scheme, Slide, SlideConstants};
use pulp::Arch;
use weald_core::grid::Size;

/// What decides about the passes of a [`Setting`].
#[derive(Clone, Copy)]
pub(super) struct Variant {
    pub(super) masked: bool,
    pub(super) open: bool,
    pub(super) advection: Option<Advection>,
    pub(super) slide: Option<Scheme>,
}

impl Variant {
    pub(super) fn made(self) -> Setting {
        let Self { masked, open, advection, slide } = self;
        let constants = SlideConstants { talus: 0.8, strength: 0.05 };
        let slide = slide.map(|scheme| Slide::new(scheme, constants));
        Setting { links: links(masked), open, advection, slide, arch: Arch::new() }
    }
}

pub(super) fn settings() -> impl Iterator<Item = Variant> {
    let advections = [None].into_iter().chain(advections().map(Some));
    let borders = [(false, false), (true, false), (true, true)];
    borders.into_iter().flat_map(move |(masked, open)| {
        advections.clone().flat_map(move |advection| {
            slides().into_iter().map(move |slide| Variant { masked, open, advection, slide })
        })
    })
}

pub(super) fn advections() -> impl Iterator<Item = Advection> + Clone {
    let conserving = Advection::FluxCorrected { epsilon: 0.001 };
    [Advection::SemiLagrangian, Advection::MacCormack, conserving].into_iter()
}

pub(super) fn slides() -> [Option<Scheme>; 4] {
    [None, Some(Scheme::Axis), Some(Scheme::Isotropic), Some(Scheme::IsotropicSymmetric)]
}

pub(super) fn links(masked: bool) -> Links {
    Links::new(Size { columns: 2, rows: 2 }, masked)
}
