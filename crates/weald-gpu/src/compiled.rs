//! Passes as pipelines, and what they are bound to.

use std::sync::PoisonError;

use weald::Error;
use weald::engine::program::{MAX_BUFFERS, Pass, Program};
use weald::error::{DeviceError, DeviceErrorKind, Quantity};
use weald::grow::ifs::shader::Shader;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, ComputePipeline,
    ComputePipelineDescriptor, PipelineCompilationOptions, PipelineLayoutDescriptor, ShaderModuleDescriptor,
    ShaderSource, ShaderStages,
};

use crate::gpu::Gpu;

/// A compiled pass, which programs with the same module share.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    pub(crate) pipeline: ComputePipeline,
    layout: BindGroupLayout,
}

/// What a pass is bound to, by binding.
pub(crate) type Bindings<'a> = Vec<(u32, BindingResource<'a>)>;

impl Pipeline {
    /// The pipeline of a pass, compiled where it is new.
    pub(crate) fn of(gpu: &Gpu, program: &Program, pass: &Pass) -> Result<Self, Error> {
        let what = format!("pass `{}` of `{}`", pass.name, program.name);
        let buffers = program.bound(pass).len() + usize::from(pass.tallies);
        if buffers > MAX_BUFFERS {
            let message = format!("{what} binds {buffers} buffers; at most {MAX_BUFFERS} work");
            let (what, asked, allowed) = (Quantity::Buffers, buffers as u64, 0..=MAX_BUFFERS as u64);
            let kind = DeviceErrorKind::OverLimit { what, asked, allowed };
            return Err(DeviceError::new(kind, message).into());
        }
        Self::known(gpu, &what, (pass.name, program.module(pass)), &entries(program, pass))
    }

    /// The pipeline of a shader of plants.
    pub(crate) fn of_plants(gpu: &Gpu, shader: &Shader) -> Result<Self, Error> {
        let uniforms = shader.uniforms.iter().map(|_| BufferBindingType::Uniform);
        let storage = shader.buffers.iter().map(|&(_, written)| storage(written));
        let kinds = (0..).zip(uniforms.chain(storage));
        let entries: Vec<_> = kinds.map(|(binding, kind)| entry(binding, kind, false)).collect();
        Self::known(gpu, shader.name, (shader.name, shader.source()), &entries)
    }

    /// A module whose entry point has this name, compiled where it is new.
    fn known(
        gpu: &Gpu,
        what: &str,
        (name, module): (&str, String),
        entries: &[BindGroupLayoutEntry],
    ) -> Result<Self, Error> {
        let key = (name.to_owned(), module);
        let mut known = gpu.context.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((pipeline, layout)) = known.get(&key) {
            return Ok(Self { pipeline: pipeline.clone(), layout: layout.clone() });
        }
        let compiled = gpu.context.attempt(what, || Ok(Self::compile(gpu, name, &key.1, entries)))?;
        known.insert(key, (compiled.pipeline.clone(), compiled.layout.clone()));
        Ok(compiled)
    }

    /// Compiles a module whose entry point has this name.
    pub(crate) fn compile(gpu: &Gpu, name: &str, module: &str, entries: &[BindGroupLayoutEntry]) -> Self {
        let device = &gpu.context.device;
        let layout =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(name), entries });
        let whole = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let source = ShaderSource::Wgsl(module.into());
        let module = device.create_shader_module(ShaderModuleDescriptor { label: Some(name), source });
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&whole),
            module: &module,
            entry_point: Some(name),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { pipeline, layout }
    }

    /// Binds resources.
    pub(crate) fn bind(&self, gpu: &Gpu, bindings: Bindings<'_>) -> Result<BindGroup, Error> {
        let entries: Vec<_> =
            bindings.into_iter().map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        let description = BindGroupDescriptor { label: None, layout: &self.layout, entries: &entries };
        gpu.context.attempt("binding buffers", || Ok(gpu.context.device.create_bind_group(&description)))
    }
}

/// The bindings that [`Program::module`] declares.
fn entries(program: &Program, pass: &Pass) -> Vec<BindGroupLayoutEntry> {
    let mut entries = vec![entry(0, BufferBindingType::Uniform, true)];
    if !program.constants.name.is_empty() {
        entries.push(entry(1, BufferBindingType::Uniform, false));
    }
    if !program.weather.name.is_empty() {
        entries.push(entry(2, BufferBindingType::Uniform, true));
    }
    let written = program.bound(pass).into_iter().map(|(_, written)| written);
    let written = written.chain(pass.tallies.then_some(true));
    entries.extend((3..).zip(written).map(|(binding, written)| entry(binding, storage(written), false)));
    entries
}

fn storage(written: bool) -> BufferBindingType {
    BufferBindingType::Storage { read_only: !written }
}

/// A binding of a buffer.
pub(crate) fn entry(binding: u32, ty: BufferBindingType, has_dynamic_offset: bool) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
        count: None,
    }
}
