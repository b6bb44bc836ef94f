//! Heights of the vertices of patches, worked out once for all pictures in which a patch is drawn: `patch_heights.wgsl`.
//!
//! The ground at a vertex is a spline of sixteen control points, and beyond the border of three times as many. A patch keeps its
//! heights in a slot of one buffer for as long as it is drawn; the shadows' cascades draw mostly the same ones. Where a vertex
//! slides onto a neighbour, its height is that of the parabola through the ground where it begins, half-way and at its end.

use std::collections::HashMap;
use std::num::NonZero;

use weald::Error;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, BufferBinding, BufferBindingType, BufferUsages,
    ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions,
    PipelineLayout, ShaderModule, ShaderStages,
};

use super::lattice::{Patch, QUADS};
use super::upload::Upload;
use crate::gpu::Gpu;
use crate::gpu::context::Context;
use crate::memory::Store;

/// Group of the heights in what draws the ground, and bindings of theirs, as the shader has them.
pub(super) const HEIGHTS_GROUP: u32 = 3;
const HEIGHTS_BINDING: u32 = 0;
const ASKED_BINDING: u32 = 6;
const FILLED_BINDING: u32 = 7;

/// Vertices of a patch.
const VERTICES: u64 = (QUADS as u64 + 1) * (QUADS as u64 + 1);

/// Bytes of a vertex: the height at it, and half of its way onto its neighbour.
const VERTEX_BYTES: u64 = 8;

/// Patches for which there is room at first.
const ROOM: usize = 2048;

/// Pictures after which a patch that none of them has may lose its slot: several views are drawn in turns.
const DRAWN_LATELY: u32 = 4;

/// Vertices of a workgroup, and workgroups of a row of them, as the shader has it.
const GROUP: u64 = 64;
const GROUPS_A_ROW: u32 = 32_768;

/// What tells patches from each other: the bits of their corner and spacing.
type Key = [u32; 3];

/// Where the heights of a patch are, and the picture that had it last.
#[derive(Clone, Copy, Debug)]
struct Slot {
    number: u32,
    used: u32,
}

/// A patch whose heights are to be worked out.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Asked {
    corner: [f32; 2],
    spacing: f32,
    slot: u32,
}

/// Which patch has which slot.
#[derive(Debug)]
struct Slots {
    room: usize,
    taken: HashMap<Key, Slot>,
    free: Vec<u32>,
    picture: u32,
    asked: Vec<Asked>,
}

impl Slots {
    fn new(room: usize) -> Self {
        let free = (0..room as u32).rev().collect();
        Self { room, taken: HashMap::new(), free, picture: 0, asked: Vec::new() }
    }

    /// The slot of a patch in the picture that is drawn, which is asked for where it has none.
    fn of(&mut self, patch: &Patch) -> u32 {
        let Patch { corner, spacing, .. } = *patch;
        let key = [corner[0], corner[1], spacing].map(f32::to_bits);
        if let Some(slot) = self.taken.get_mut(&key) {
            slot.used = self.picture;
            return slot.number;
        }
        if self.free.is_empty() {
            self.make_room();
        }
        let number = self.free.pop().expect("room was made");
        self.taken.insert(key, Slot { number, used: self.picture });
        self.asked.push(Asked { corner, spacing, slot: number });
        number
    }

    /// Takes slots from patches that were not drawn lately, or makes twice as many.
    fn make_room(&mut self) {
        let (picture, free) = (self.picture, &mut self.free);
        self.taken.retain(|_, slot| {
            let is_kept = picture.wrapping_sub(slot.used) < DRAWN_LATELY;
            if !is_kept {
                free.push(slot.number);
            }
            is_kept
        });
        // What has lost its slot is not asked for any more.
        let taken = &self.taken;
        self.asked.retain(|asked| taken.contains_key(&asked.key()));
        if self.free.is_empty() {
            self.free.extend((self.room as u32..2 * self.room as u32).rev());
            self.room *= 2;
        }
    }

    /// Has all heights worked out anew.
    fn ask_for_all(&mut self) {
        let asked = |(&[x, y, spacing], slot): (&Key, &Slot)| Asked {
            corner: [x, y].map(f32::from_bits),
            spacing: f32::from_bits(spacing),
            slot: slot.number,
        };
        self.asked = self.taken.iter().map(asked).collect();
    }

    /// Forgets all patches.
    fn forget(&mut self) {
        *self = Self { picture: self.picture, ..Self::new(self.room) };
    }
}

impl Asked {
    fn key(&self) -> Key {
        [self.corner[0], self.corner[1], self.spacing].map(f32::to_bits)
    }
}

/// The heights on the device.
#[derive(Debug)]
pub(super) struct PatchHeights {
    slots: Slots,
    pub(super) layouts: HeightsLayouts,
    heights: Store,
    asked: Store,
    /// What draws the ground is bound to.
    pub(super) group: BindGroup,
}

/// The layouts of what draws the ground by its heights, and of what works them out.
#[derive(Debug)]
pub(super) struct HeightsLayouts {
    pub(super) drawing: BindGroupLayout,
    pub(super) filling: BindGroupLayout,
}

impl PatchHeights {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let slots = Slots::new(ROOM);
        let layouts = HeightsLayouts {
            drawing: layout(gpu, &[(HEIGHTS_BINDING, ShaderStages::VERTEX, true)]),
            filling: layout(
                gpu,
                &[
                    (ASKED_BINDING, ShaderStages::COMPUTE, true),
                    (FILLED_BINDING, ShaderStages::COMPUTE, false),
                ],
            ),
        };
        let heights = room(gpu, VERTICES * VERTEX_BYTES * slots.room as u64)?;
        let asked = room(gpu, (ROOM * size_of::<Asked>()) as u64)?;
        let group = bind(gpu, &layouts.drawing, [(HEIGHTS_BINDING, whole(&heights))]);
        Ok(Self { slots, layouts, heights, asked, group })
    }

    /// Begins another picture.
    pub(super) fn begin(&mut self) {
        self.slots.picture = self.slots.picture.wrapping_add(1);
    }

    /// The slot of a patch in the picture that is drawn.
    pub(super) fn slot(&mut self, patch: &Patch) -> u32 {
        self.slots.of(patch)
    }

    /// Has all heights worked out anew: the ground has become another one.
    pub(super) fn forget(&mut self) {
        self.slots.forget();
    }

    /// Encodes the work on the heights that patches of this picture have not yet, before those are drawn.
    pub(super) fn fill(
        &mut self,
        into: &mut Upload<'_>,
        pipeline: &ComputePipeline,
        groups: [&BindGroup; 2],
    ) -> Result<(), Error> {
        let gpu = into.gpu;
        let bytes = VERTICES * VERTEX_BYTES * self.slots.room as u64;
        if self.heights.buffer.size() < bytes {
            self.heights = room(gpu, bytes)?;
            self.group = bind(gpu, &self.layouts.drawing, [(HEIGHTS_BINDING, whole(&self.heights))]);
            self.slots.ask_for_all();
        }
        let count = self.slots.asked.len() as u64;
        let Some(bytes) = NonZero::new(count * size_of::<Asked>() as u64) else { return Ok(()) };
        if self.asked.buffer.size() < bytes.get() {
            self.asked = room(gpu, bytes.get().next_power_of_two())?;
        }
        into.write(&self.asked, bytemuck::cast_slice(&self.slots.asked));
        self.slots.asked.clear();
        let asked = BufferBinding { buffer: &self.asked.buffer, offset: 0, size: Some(bytes) };
        let bound = [(ASKED_BINDING, asked), (FILLED_BINDING, whole(&self.heights))];
        let filling = bind(gpu, &self.layouts.filling, bound);
        let description = ComputePassDescriptor { label: Some("heights of patches"), timestamp_writes: None };
        let mut pass = into.encoder.begin_compute_pass(&description);
        pass.set_pipeline(pipeline);
        for (at, group) in (0..).zip([groups[0], groups[1], &filling]) {
            pass.set_bind_group(at, group, &[]);
        }
        let workgroups = (count * VERTICES).div_ceil(GROUP) as u32;
        pass.dispatch_workgroups(workgroups.min(GROUPS_A_ROW), workgroups.div_ceil(GROUPS_A_ROW), 1);
        Ok(())
    }
}

/// The pipeline that works heights out, by a module of all shaders of a picture.
pub(super) fn pipeline(
    context: &Context,
    (module, layout): (&ShaderModule, &PipelineLayout),
    has_horizon: bool,
) -> ComputePipeline {
    let constants = [("HORIZON", f64::from(has_horizon))];
    let make = || {
        context.device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("heights of patches"),
            layout: Some(layout),
            module,
            entry_point: Some("fill_heights"),
            compilation_options: PipelineCompilationOptions {
                constants: &constants,
                ..PipelineCompilationOptions::default()
            },
            cache: None,
        })
    };
    context.known.computing((module.clone(), format!("heights of patches {has_horizon}")), make)
}

/// A buffer of so many bytes.
fn room(gpu: &Gpu, bytes: u64) -> Result<Store, Error> {
    Store::new(gpu, "heights of patches", bytes, BufferUsages::STORAGE | BufferUsages::COPY_DST)
}

fn whole(store: &Store) -> BufferBinding<'_> {
    BufferBinding { buffer: &store.buffer, offset: 0, size: None }
}

/// A layout of storage buffers: binding, who sees it, and whether it is only read.
fn layout(gpu: &Gpu, bindings: &[(u32, ShaderStages, bool)]) -> BindGroupLayout {
    let entries: Vec<_> = bindings
        .iter()
        .map(|&(binding, visibility, read_only)| BindGroupLayoutEntry {
            binding,
            visibility,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    let description = BindGroupLayoutDescriptor { label: Some("heights of patches"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

fn bind<const COUNT: usize>(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    buffers: [(u32, BufferBinding<'_>); COUNT],
) -> BindGroup {
    let entries = buffers
        .map(|(binding, buffer)| BindGroupEntry { binding, resource: BindingResource::Buffer(buffer) });
    let description = BindGroupDescriptor { label: Some("heights of patches"), layout, entries: &entries };
    gpu.context.device.create_bind_group(&description)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(number: usize, spacing: f32) -> Patch {
        Patch { corner: [0.5 + number as f32, 0.5], spacing, level: 0.0 }
    }

    /// Patches that are drawn in one picture, with their slots.
    fn draw(slots: &mut Slots, numbers: std::ops::Range<usize>) -> Vec<u32> {
        slots.picture += 1;
        numbers.map(|number| slots.of(&patch(number, 1.0))).collect()
    }

    #[test]
    fn a_patch_keeps_its_slot_and_is_asked_for_once() {
        let mut slots = Slots::new(8);
        let first = draw(&mut slots, 0..5);
        assert_eq!(slots.asked.len(), 5);
        assert_ne!(slots.of(&patch(0, 2.0)), first[0], "another spacing is another patch");
        slots.asked.clear();
        assert_eq!(draw(&mut slots, 0..5), first);
        assert!(slots.asked.is_empty());
    }

    #[test]
    fn patches_of_one_picture_have_slots_of_their_own_however_many_they_are() {
        let mut slots = Slots::new(8);
        for count in [8, 9, 40, 100] {
            let mut all = draw(&mut slots, 0..count);
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count);
            assert!(all.iter().all(|&slot| (slot as usize) < slots.room));
        }
    }

    #[test]
    fn slots_of_patches_that_are_drawn_no_more_are_given_to_others() {
        let mut slots = Slots::new(64);
        for picture in 0..200 {
            draw(&mut slots, 10 * picture..10 * picture + 10);
            slots.asked.clear();
        }
        assert_eq!(slots.room, 64);
        let again = draw(&mut slots, 0..10).len();
        assert_eq!(slots.asked.len(), again, "what lost its slot is asked for again");
    }

    #[test]
    fn what_lost_its_slot_before_it_was_worked_out_does_not_write_over_others() {
        let mut slots = Slots::new(16);
        for picture in 0..20 {
            draw(&mut slots, 10 * picture..10 * picture + 10);
        }
        let mut asked: Vec<_> = slots.asked.iter().map(|asked| asked.slot).collect();
        asked.sort_unstable();
        let count = asked.len();
        asked.dedup();
        assert_eq!(asked.len(), count, "two patches are asked for in one slot");
    }

    #[test]
    fn another_ground_has_all_heights_worked_out_anew() {
        let mut slots = Slots::new(8);
        draw(&mut slots, 0..5);
        slots.asked.clear();
        slots.forget();
        draw(&mut slots, 0..5);
        assert_eq!(slots.asked.len(), 5);
    }
}
