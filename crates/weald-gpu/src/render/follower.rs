//! The pipeline that makes surfaces of the ground and water of a running simulation.

use weald::Error;
use weald::picture::LitScene;
use wgpu::{
    ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions, ShaderModuleDescriptor,
    ShaderSource,
};

use crate::gpu::Gpu;
use crate::memory::Store;
use crate::transfer::uniform;

/// What makes surfaces.
#[derive(Debug)]
pub(super) struct Follower {
    pub(super) pipeline: ComputePipeline,
    pub(super) numbers: Store,
}

impl Follower {
    pub(super) fn new(gpu: &Gpu, scene: &LitScene) -> Result<Self, Error> {
        let numbers = uniform(gpu, "what is followed", &scene.follow())?;
        gpu.context.attempt("making the pipeline that follows a simulation", || {
            let device = &gpu.context.device;
            let source = ShaderSource::Wgsl(LitScene::FOLLOW.into());
            let module =
                device.create_shader_module(ShaderModuleDescriptor { label: Some("follow"), source });
            let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some("follow"),
                layout: None,
                module: &module,
                entry_point: Some("follow_ground"),
                compilation_options: PipelineCompilationOptions::default(),
                cache: None,
            });
            Ok(Self { pipeline, numbers })
        })
    }
}
