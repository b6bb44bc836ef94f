//! What one view is drawn onto, and how shaders see it.

use std::sync::{Arc, Mutex};

use weald::Error;
use wgpu::BindGroup;

use super::ground::depths_groups;
use super::options::Options;
use super::passes::Passes;
use super::reprojection::Reprojection;
use super::targets::Targets;
use super::tone_mapping::ToneMapping;
use crate::gpu::Gpu;

/// The canvases of a view.
#[derive(Debug)]
pub(super) struct Onto {
    pub(super) options: Options,
    pub(super) targets: Targets,
    /// The depths of the ground, as its light is drawn from them, alone, with the light of clouds, and with kinds by number.
    pub(super) depths: [BindGroup; 3],
    /// The light, as a picture is made from it.
    pub(super) light: BindGroup,
    /// What grass around a camera is kept for: it lives as long as the view does, whatever its size.
    pub(super) viewer: Arc<()>,
    /// What a window keeps of its last picture.
    pub(super) reprojection: Mutex<Reprojection>,
}

impl Onto {
    pub(super) fn new(
        gpu: &Gpu,
        (passes, film): (&Passes, &ToneMapping),
        options: Options,
        viewer: Arc<()>,
    ) -> Result<Self, Error> {
        options.check(gpu)?;
        let targets = Targets::new(gpu, options)?;
        let depths = depths_groups(gpu, &passes.depths, &targets);
        let light = film.light_of(gpu, &targets);
        Ok(Self { options, targets, depths, light, viewer, reprojection: Mutex::default() })
    }
}
