//! The leaves, stems and limbs of a kind of plants on a device.

use std::cmp::Reverse;

use weald::Error;
use weald::grow::ifs::limbs::{Corner, LEVELS, Limb, Limbs};
use wgpu::{BindingResource, BufferUsages, TextureFormat, TextureUsages};

use super::lists::{LISTS, SEATS, SHARED_SEATS, VIEWS};
use super::pipelines::VERTEX_WORDS;
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::render::records::Records;
use crate::render::textures::{Canvas, Shape};
use crate::transfer;

/// Bytes of an indexed indirect draw.
pub(super) const DRAW: u64 = 20;

/// Words of how a limb is carried, and limbs beside each other in a row of a texture, as `carried.wgsl` has them.
const CARRIED: u64 = 4;
const CARRIED_ACROSS: u32 = 4096;

/// Leaves and stems: their corners, triangles of them, and what each list draws in each view.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) corners: Store,
    pub(super) indices: Store,
    pub(super) draws: Store,
}

impl Mesh {
    pub(super) fn new(gpu: &Gpu, limbs: &Limbs) -> Result<Self, Error> {
        let (indices, templates) = lists(limbs);
        let corners: Vec<_> = limbs.corners.iter().map(|corner| vertex(corner, &limbs.limbs)).collect();
        let usage = BufferUsages::STORAGE | BufferUsages::INDIRECT;
        Ok(Self {
            corners: filled(gpu, "leaves of plants", corners.as_flattened(), BufferUsages::VERTEX)?,
            indices: filled(gpu, "corners of leaves", &indices, BufferUsages::INDEX)?,
            draws: filled(gpu, "draws of plants", &templates, usage)?,
        })
    }
}

/// Limbs in their layers, and room for how they are carried on each seat: for the limbs on them, and for leaves.
#[derive(Debug)]
pub(super) struct CarriedLimbs {
    pub(super) layers: Store,
    pub(super) carried: Store,
    limbs: Records,
    texels: Canvas,
}

impl CarriedLimbs {
    pub(super) fn new(gpu: &Gpu, limbs: &Limbs) -> Result<Self, Error> {
        let seats = u64::from(SEATS.iter().sum::<u32>() + SHARED_SEATS);
        let count = limbs.limbs.len() as u64;
        let places = seats * count.max(1);
        let records = Records::new(gpu, "limbs of plants", count)?;
        let packed: Vec<_> = limbs.limbs.iter().map(Limb::packed).collect();
        records.write(gpu, &packed)?;
        Ok(Self {
            layers: filled(gpu, "layers of limbs", &layers(limbs), BufferUsages::STORAGE)?,
            carried: Store::new(
                gpu,
                "limbs as they are carried",
                4 * CARRIED * places,
                BufferUsages::STORAGE,
            )?,
            limbs: records,
            texels: carried_texels(gpu, places)?,
        })
    }

    /// What leaves read.
    pub(super) fn for_leaves(&self) -> BindingResource<'_> {
        BindingResource::TextureView(&self.texels.view)
    }

    /// The limbs, and what leaves read.
    pub(super) fn textures(&self) -> [BindingResource<'_>; 2] {
        [self.limbs.resource(), self.for_leaves()]
    }
}

/// A buffer that holds these words.
pub(super) fn filled(gpu: &Gpu, what: &str, words: &[u32], usage: BufferUsages) -> Result<Store, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(words);
    let store =
        Store::new(gpu, what, bytes.len() as u64, usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC)?;
    transfer::write(gpu, &store.buffer, bytes)?;
    Ok(store)
}

/// Room for how so many limbs are carried, from which leaves read.
fn carried_texels(gpu: &Gpu, places: u64) -> Result<Canvas, Error> {
    let rows = places.div_ceil(u64::from(CARRIED_ACROSS)).try_into().unwrap_or(u32::MAX);
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
    let shape = Shape::flat([CARRIED_ACROSS, rows], TextureFormat::Rgba32Uint, usage);
    Canvas::new(gpu, "limbs as leaves read them", shape)
}

/// A corner with the limb on which it is, none for what no wind moves.
fn vertex(corner: &Corner, limbs: &[Limb]) -> [u32; VERTEX_WORDS] {
    let limb = limbs.get(corner.limb as usize).map_or([0; 8], Limb::packed);
    let words = corner.packed().into_iter().chain(limb).collect::<Vec<_>>();
    words.try_into().expect("twelve words of a corner and eight of a limb")
}

/// The limbs in layers, those on the ground first, each layer on the one before and beginning with those that coarse levels of
/// detail have: how many layers there are; for each level where each layer's limbs end that it has; and the limbs in that order.
fn layers(limbs: &Limbs) -> Vec<u32> {
    let mut depths: Vec<usize> = Vec::with_capacity(limbs.limbs.len());
    for limb in &limbs.limbs {
        depths.push(limb.parent.map_or(0, |parent| depths[parent as usize] + 1));
    }
    let coarsest = coarsest_levels(limbs);
    let key = |limb: u32| (depths[limb as usize], Reverse(coarsest[limb as usize]));
    let mut order: Vec<u32> = (0..limbs.limbs.len() as u32).collect();
    order.sort_by_key(|&limb| key(limb));
    let count = depths.iter().max().map_or(0, |deepest| deepest + 1);
    let end = |level, layer| order.partition_point(|&limb| key(limb) <= (layer, Reverse(level))) as u32;
    let ends = (0..LEVELS as u32).flat_map(|level| (0..count).map(move |layer| (level, layer)));
    let ends = ends.map(|(level, layer)| end(level, layer));
    [count as u32].into_iter().chain(ends).chain(order.iter().copied()).collect()
}

/// The coarsest level of detail of which some corner hangs on each limb, or on one that it carries.
fn coarsest_levels(limbs: &Limbs) -> Vec<u32> {
    let mut coarsest = vec![0; limbs.limbs.len()];
    for corner in &limbs.corners {
        let level = corner.levels[1];
        let mut on = Some(corner.limb);
        // What carries it has been climbed to where it has that level.
        while let Some(known) =
            on.and_then(|limb| coarsest.get_mut(limb as usize)).filter(|known| **known < level)
        {
            *known = level;
            on = on.and_then(|limb| limbs.limbs[limb as usize].parent);
        }
    }
    coarsest
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

#[cfg(test)]
mod tests {
    use super::super::batch::limbs_of;
    use super::*;
    use crate::render::records::WORDS;

    #[test]
    fn layers_hold_every_limb_once_and_each_on_the_layer_before() {
        let ifs = weald::grow::ifs::shapes::find("fern").expect("built in").ifs();
        let of_fern = limbs_of(&ifs);
        let (limbs, layers) = (&of_fern.limbs, layers_of(&of_fern, 0));
        let mut layer_of = vec![usize::MAX; limbs.len()];
        for (layer, numbers) in layers.iter().enumerate() {
            for &limb in numbers {
                let before = limbs[limb as usize].parent.map(|parent| layer_of[parent as usize]);
                assert_eq!(before, layer.checked_sub(1), "limb {limb}");
                layer_of[limb as usize] = layer;
            }
        }
        assert!(layers.len() > 2 && layers.concat().len() == limbs.len() && !layer_of.contains(&usize::MAX));
    }

    /// The limbs of each layer that a level of detail has, as the shader finds them.
    fn layers_of(limbs: &Limbs, level: usize) -> Vec<Vec<u32>> {
        let words = layers(limbs);
        let count = words[0] as usize;
        let (ends, order) = words[1..].split_at(LEVELS * count);
        let of = |layer: usize| {
            let start = if layer == 0 { 0 } else { ends[layer - 1] };
            order[start as usize..ends[level * count + layer] as usize].to_vec()
        };
        (0..count).map(of).collect()
    }

    #[test]
    fn a_level_of_detail_has_the_limbs_on_which_its_leaves_hang_and_those_that_carry_them() {
        for shape in ["fern", "spruce"] {
            let limbs = limbs_of(&weald::grow::ifs::shapes::find(shape).expect("built in").ifs());
            let mut counts = Vec::new();
            for level in 0..LEVELS {
                let has: std::collections::HashSet<u32> =
                    layers_of(&limbs, level).into_iter().flatten().collect();
                // A list of a level may pass into the next one.
                for corner in
                    limbs.triangles_of([level, (level + 1).min(LEVELS - 1)].map(|level| level as u32))
                {
                    let mut on = Some(limbs.corners[corner as usize].limb)
                        .filter(|&limb| (limb as usize) < limbs.limbs.len());
                    while let Some(limb) = on {
                        assert!(has.contains(&limb), "limb {limb} of level {level} of {shape}");
                        on = limbs.limbs[limb as usize].parent;
                    }
                }
                counts.push(has.len());
            }
            assert!(counts.is_sorted_by(|a, b| a >= b) && counts[2] < counts[0], "{shape}: {counts:?}");
        }
    }

    #[test]
    fn a_placed_plant_takes_thirty_two_bytes_and_a_kind_of_it_a_few_megabytes() {
        let ifs = weald::grow::ifs::shapes::find("fern").expect("built in").ifs();
        let limbs = limbs_of(&ifs);
        let (indices, draws) = lists(&limbs);
        let bytes = 4 * (indices.len() + VERTEX_WORDS * limbs.corners.len() + 8 * limbs.limbs.len());
        assert!((1 << 20..6 << 20).contains(&bytes), "{bytes}");
        assert_eq!((4 * WORDS, draws.len()), (32, VIEWS * LISTS * DRAW as usize / 4));
    }
}
