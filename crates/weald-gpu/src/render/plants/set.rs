//! The plants of one kind on a device.

use weald::grow::Fractal;
use weald::grow::ifs::foliage::{Colours, Habit};
use weald::grow::ifs::limbs::{Corner, LEVELS, Limb, Limbs};
use weald::picture::{Stage, linear_of_srgb};
use weald::plants::{Plant, Plants};
use weald::random::{hash2, unit};
use weald::{Error, Landscape};
use wgpu::{BindGroup, BufferUsages};

use super::pipelines::Groups;
use super::{LISTS, VIEWS};
use crate::gpu::Gpu;
use crate::memory::Store;

/// Bytes of an indexed indirect draw.
pub(super) const DRAW: u64 = 20;

/// Plants of a workgroup, as `choose.wgsl` has it.
const GROUP: u32 = 256;

/// Words of a plant, as `plants.wgsl` has them.
const WORDS: usize = 8;

/// Distance in metres by which roots reach into the ground, beside the height of the plant.
const ROOTED: f32 = 0.01;

/// Plants of one kind.
#[derive(Debug)]
pub(super) struct Set {
    pub(super) choose: BindGroup,
    pub(super) draw: BindGroup,
    pub(super) indices: Store,
    pub(super) draws: Store,
    /// Workgroups that look at all plants.
    pub(super) groups: u32,
    _stores: [Store; 7],
}

impl Set {
    pub(super) fn new(
        gpu: &Gpu,
        stage: &Stage,
        (landscape, plants): (&Landscape, &Plants),
        groups: &Groups,
    ) -> Result<Self, Error> {
        let known = Fractal::named(&landscape.fractals, &plants.kind);
        let fractal = known.ok_or_else(|| Error::Run(format!("there is no fractal `{}`", plants.kind)))?;
        let limbs = Limbs::of(&fractal.ifs, Habit::of(&fractal.ifs, None));
        let stood: Vec<_> =
            (0..).zip(&plants.plants).filter_map(|(n, plant)| stood(stage, n, plant)).collect();
        let count = stood.len().max(1) as u64;
        let workgroups = count.div_ceil(u64::from(GROUP));
        let filled = |what: &str, words: &[u32], usage| filled(gpu, what, words, usage);
        let room = |what: &str, words: u64| Store::new(gpu, what, 4 * words, BufferUsages::STORAGE);
        let table = BufferUsages::STORAGE;
        let kind = filled("a kind of plants", &kind(&limbs), BufferUsages::UNIFORM)?;
        let plants = filled("plants", stood.as_flattened(), table)?;
        let kept = room("plants in sight", count * VIEWS as u64)?;
        let starts = room("lists of plants", (VIEWS * LISTS) as u64)?;
        let counts = room("counts of plants", workgroups * (VIEWS * LISTS) as u64)?;
        let (indices, templates) = lists(&limbs);
        let draws = filled("draws of plants", &templates, table | BufferUsages::INDIRECT)?;
        let indices = filled("corners of leaves", &indices, BufferUsages::INDEX)?;
        let corners: Vec<_> = limbs.corners.iter().map(Corner::packed).collect();
        let limbs: Vec<_> = limbs.limbs.iter().map(Limb::packed).collect();
        let limbs = filled("limbs of plants", limbs.as_flattened(), table)?;
        let corners = filled("leaves of plants", corners.as_flattened(), table)?;
        let choose = groups.choose(gpu, &[&kind, &plants, &kept, &starts, &draws, &counts])?;
        let draw = groups.draw(gpu, &[&kind, &plants, &kept, &starts, &limbs, &corners])?;
        let stores = [kind, plants, kept, starts, counts, limbs, corners];
        Ok(Self { choose, draw, indices, draws, groups: workgroups as u32, _stores: stores })
    }
}

/// A buffer that holds these words.
fn filled(gpu: &Gpu, what: &str, words: &[u32], usage: BufferUsages) -> Result<Store, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(words);
    let store = Store::new(gpu, what, bytes.len() as u64, usage | BufferUsages::COPY_DST)?;
    crate::transfer::write(gpu, &store.buffer, bytes)?;
    Ok(store)
}

/// Colours in linear light, and how far the plant reaches.
fn kind(limbs: &Limbs) -> [u32; 8] {
    let [a, b, c] = linear_of_srgb(Colours::USUAL.leaf);
    let [d, e, f] = linear_of_srgb(Colours::USUAL.stem);
    [a, b, c, limbs.radius(), d, e, f, 0.0].map(f32::to_bits)
}

/// A plant on the ground that is drawn, as the device has it; none where there is no land.
fn stood(stage: &Stage, number: i64, plant: &Plant) -> Option<[u32; WORDS]> {
    let [east, south, _] = plant.place;
    let up = stage.bed_at([east, south])? - ROOTED * plant.size;
    let [x, y, z, w] = plant.rotation().map(|part| u32::from(((32767.0 * part).round() as i16) as u16));
    let chance = unit(hash2(0x9e37, number, 3)) as f32;
    let [east, north, up, size] = [east as f32, -south as f32, up, plant.size].map(f32::to_bits);
    Some([east, north, up, size, x | y << 16, z | w << 16, plant.phase.to_bits(), chance.to_bits()])
}

/// The corners of all lists, and what each draws of them in each view.
fn lists(limbs: &Limbs) -> (Vec<u32>, Vec<u32>) {
    let last = LEVELS as u32 - 1;
    let (mut indices, mut draws) = (Vec::new(), Vec::new());
    for list in 0..LISTS as u32 {
        let corners = limbs.triangles_of([list / 2, list.div_ceil(2).min(last)]);
        draws.extend([corners.len() as u32, 0, indices.len() as u32, 0, 0]);
        indices.extend(corners);
    }
    (indices, draws.repeat(VIEWS))
}
