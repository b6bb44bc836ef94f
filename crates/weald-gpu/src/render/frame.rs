//! What one picture is drawn from: `frame.wgsl`.

use weald::Error;
use weald::picture::Camera;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBindingType, BufferUsages, CompareFunction,
    FilterMode, Sampler, SamplerBindingType, SamplerDescriptor, ShaderStages, TextureSampleType,
    TextureViewDimension,
};

use super::cascades::{CASCADES, Cascades};
use super::lattice::Viewpoint;
use super::levels::MAX_LEVELS;
use super::textures::Canvas;
use super::upload::Upload;
use crate::gpu::Gpu;
use crate::memory::Store;

/// Nearest distance that is drawn, in metres.
const NEAREST: f32 = 0.05;

/// The shader's struct.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Numbers {
    eye: [f32; 4],
    forward: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    stand: [f32; 4],
    moment: [f32; 4],
    slides: [[f32; 4]; MAX_LEVELS],
    sun_right: [f32; 4],
    sun_up: [f32; 4],
    cascades: [[f32; 4]; CASCADES],
    detail_points: [[f32; 4]; CASCADES - 1],
    woods: [f32; 4],
    shares: [f32; CASCADES],
    stale: [f32; CASCADES],
    before: [[f32; 4]; 4],
    pixel: [f32; 4],
}

/// The picture before one that takes light from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureBefore {
    pub(super) camera: Camera,
    /// Which pixels are lit anew all the same, and in how many turns all are.
    pub(super) turn: u32,
    pub(super) turns: u32,
}

/// What a camera's ground was selected for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub(super) stand: Viewpoint,
    pub(super) slides: [[f32; 4]; MAX_LEVELS],
    /// The point from which detail is chosen.
    pub(super) detail_from: [f32; 3],
    /// Seconds since the beginning.
    pub(super) seconds: f32,
    /// Whether water is left out.
    pub(super) is_dry: bool,
    pub(super) cascades: Cascades,
    /// How far trees of woods are drawn one by one, in metres.
    pub(super) woods: f32,
    /// How many times as far as in a moving picture blades of grass reach, and metres up to which all of them stand where
    /// they reach no farther.
    pub(super) grass: [f32; 2],
    /// The cascades that are drawn anew.
    pub(super) stale: [bool; CASCADES],
    /// The picture before, where light is taken from it.
    pub(super) before: Option<PictureBefore>,
}

/// The uniforms of a picture on the device, and what shadows are looked up in.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) layout: BindGroupLayout,
    pub(super) group: BindGroup,
    /// The numbers alone, for what throws shadows.
    pub(super) caster_layout: BindGroupLayout,
    pub(super) caster_group: BindGroup,
    /// The numbers by which each cascade of the sun is drawn: the last, which no camera changes, has none of a camera.
    pub(super) cascade_groups: [BindGroup; CASCADES],
    numbers: Store,
    of_cascades: [Store; CASCADES],
    sampler: Sampler,
}

impl Frame {
    pub(super) fn new(gpu: &Gpu, shadows: &Canvas, canopy: &Canvas) -> Result<Self, Error> {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let store = || Store::new(gpu, "the numbers of a picture", size_of::<Numbers>() as u64, usage);
        let numbers = store()?;
        let of_cascades = [store()?, store()?, store()?, store()?];
        let device = &gpu.context.device;
        let layout = |entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some("frame"), entries })
        };
        let (layout, caster_layout) = (layout(&entries()), layout(&entries()[..1]));
        let sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("shadows"),
            compare: Some(CompareFunction::LessEqual),
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..SamplerDescriptor::default()
        });
        let group = bind(gpu, &layout, (&numbers, &sampler), [shadows, canopy])?;
        let alone = |numbers: &Store| {
            let entry = BindGroupEntry { binding: 0, resource: numbers.buffer.as_entire_binding() };
            bound(gpu, &caster_layout, &[entry])
        };
        let caster_group = alone(&numbers)?;
        let [a, b, c, d] = &of_cascades;
        let cascade_groups = [alone(a)?, alone(b)?, alone(c)?, alone(d)?];
        Ok(Self { layout, group, caster_layout, caster_group, cascade_groups, numbers, of_cascades, sampler })
    }

    /// Takes another canopy.
    pub(super) fn plant(&mut self, gpu: &Gpu, shadows: &Canvas, canopy: &Canvas) -> Result<(), Error> {
        self.group = bind(gpu, &self.layout, (&self.numbers, &self.sampler), [shadows, canopy])?;
        Ok(())
    }

    /// Sets the numbers of the next picture.
    pub(super) fn write(&self, into: &mut Upload<'_>, camera: &Camera, size: [u32; 2], drawn: &Drawn) {
        write(into, &self.numbers, (camera, size), drawn);
    }

    /// Sets those of a cascade of the sun, whose detail is chosen from a viewpoint; the last is drawn once for all moments,
    /// so that nothing slides there, and plants stand in the wind of the first one.
    pub(super) fn write_cascade(
        &self,
        into: &mut Upload<'_>,
        (number, stand): (usize, Viewpoint),
        shown: (&Camera, [u32; 2]),
        drawn: &Drawn,
    ) {
        let own = if let Some([x, y, z, _]) = drawn.cascades.detail_points.get(number) {
            Drawn { stand, detail_from: [*x, *y, *z], ..*drawn }
        } else {
            Drawn { slides: [[1e30, 2e30, 0.0, 0.0]; MAX_LEVELS], seconds: 0.0, ..*drawn }
        };
        write(into, &self.of_cascades[number], shown, &own);
    }
}

fn write(into: &mut Upload<'_>, store: &Store, (camera, size): (&Camera, [u32; 2]), drawn: &Drawn) {
    let with = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
    let [x, y] = drawn.stand.place;
    let [near_x, near_y, near_z] = drawn.detail_from;
    let [across, down] = [0, 1].map(|axis| 2.0 * camera.half[axis] / size[axis] as f32);
    let numbers = Numbers {
        eye: with(camera.eye, camera.pixel_angle(size[0] as usize)),
        forward: with(camera.forward, NEAREST),
        right: with(camera.right, camera.half[0]),
        up: with(camera.up, camera.half[1]),
        stand: [x, y, drawn.stand.above, f32::from(drawn.is_dry)],
        moment: [drawn.seconds, near_x, near_y, near_z],
        slides: drawn.slides,
        sun_right: with(drawn.cascades.right, drawn.cascades.depths[0]),
        sun_up: with(drawn.cascades.up, drawn.cascades.depths[1]),
        cascades: drawn.cascades.squares,
        detail_points: drawn.cascades.detail_points,
        woods: [drawn.woods, 0.0, 0.0, 0.0],
        shares: drawn.cascades.shares,
        stale: drawn.stale.map(f32::from),
        pixel: [across, down, drawn.grass[0], drawn.grass[1]],
        before: drawn.before.map_or([[0.0; 4]; 4], |before| numbers_before(camera, before)),
    };
    into.write(store, bytemuck::bytes_of(&numbers));
}

/// The eye from the one before, exact where both are near, and that camera.
fn numbers_before(camera: &Camera, before: PictureBefore) -> [[f32; 4]; 4] {
    let PictureBefore { camera: Camera { eye, forward, right, up, half }, turn, turns } = before;
    let with = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
    let moved = std::array::from_fn(|axis| camera.eye[axis] - eye[axis]);
    [with(moved, turns as f32), with(forward, turn as f32), with(right, half[0]), with(up, half[1])]
}

fn bind(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    (numbers, sampler): (&Store, &Sampler),
    [shadows, canopy]: [&Canvas; 2],
) -> Result<BindGroup, Error> {
    let entries = [
        BindGroupEntry { binding: 0, resource: numbers.buffer.as_entire_binding() },
        BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&shadows.view) },
        BindGroupEntry { binding: 2, resource: BindingResource::Sampler(sampler) },
        BindGroupEntry { binding: 3, resource: BindingResource::TextureView(&canopy.view) },
    ];
    bound(gpu, layout, &entries)
}

fn bound(gpu: &Gpu, layout: &BindGroupLayout, entries: &[BindGroupEntry<'_>]) -> Result<BindGroup, Error> {
    let description = BindGroupDescriptor { label: Some("frame"), layout, entries };
    gpu.context.attempt("binding a picture", || Ok(gpu.context.device.create_bind_group(&description)))
}

/// The bindings of `frame.wgsl`, `shadows.wgsl` and `canopy.wgsl`.
fn entries() -> [BindGroupLayoutEntry; 4] {
    let numbers = BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let depths = BindingType::Texture {
        sample_type: TextureSampleType::Depth,
        view_dimension: TextureViewDimension::D2Array,
        multisampled: false,
    };
    let entry = |binding, ty| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT | ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let leaves = BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    let comparison = BindingType::Sampler(SamplerBindingType::Comparison);
    [entry(0, numbers), entry(1, depths), entry(2, comparison), entry(3, leaves)]
}
