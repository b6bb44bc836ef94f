//! Scattered plants on a device: chosen there for the camera and for each cascade of the sun, and drawn leaf by leaf.
//!
//! A set of plants is a mesh of limbs (`weald::grow::ifs::limbs`) and 32 bytes per plant. Each picture, passes over all
//! plants sort them, for each view that is drawn, into lists by how high they are seen, in pixels (`choose.wgsl`): a list for each
//! level of detail, one for each transition between two, in which the leaves of both are drawn, the ones becoming
//! broader and the others narrower (`plants.wgsl`). A list is one indirect draw. Leaves bend in the wind limb by limb
//! (`leaves.wgsl`).
//!
//! A plant takes 213 bytes of a device: itself, its place in the lists of five views, as it is seen in each of them
//! (`seen.wgsl`), and its share of what counts them. A kind of plant takes 4 MB or so, and 32 bytes for each limb of the plants that
//! are seen largest, which are carried once for all of their leaves (`carry.wgsl`), half of them for limbs and half for leaves:
//! 80 MB for ferns.

mod batch;
mod lists;
mod mesh;
mod pipelines;
mod wood;

use std::ops::Range;
use weald::picture::LitScene;
use weald::{Error, Landscape};

use wgpu::{BindGroup, CommandEncoder, ComputePassDescriptor, IndexFormat, RenderPass};

use super::cascades::CASCADES;
use super::layouts::Layouts;
use crate::gpu::Gpu;
use batch::Batch;
use lists::{LISTS, LISTS_OF_FINEST, SEATED_LISTS, SEATS};
use mesh::DRAW;
use pipelines::Pipelines;
use wood::{REACH, Wood};

/// All scattered plants of a landscape, and the trees of its woods.
#[derive(Debug)]
pub(super) struct Plants {
    sets: Vec<Batch>,
    wood: Option<Wood>,
    /// Whether the trees of woods are drawn one by one for the next camera.
    has_trees: bool,
    pipelines: Pipelines,
    /// Height in metres of the tallest scattered plant.
    pub(super) tallest: f32,
}

impl Plants {
    /// Brings them to a device; `None` where a landscape has none.
    pub(super) fn new(
        gpu: &Gpu,
        (scene, landscape): (&LitScene, &Landscape),
        layouts: Layouts<'_>,
        samples: u32,
    ) -> Result<Option<Self>, Error> {
        let grown = landscape.all_plants().filter(|(_, plants)| !plants.plants.is_empty());
        let mut grown = grown.peekable();
        if grown.peek().is_none() && !scene.has_woods() {
            return Ok(None);
        }
        let pipelines = Pipelines::new(gpu, scene, layouts, samples)?;
        let sizes = landscape.all_plants().flat_map(|(_, plants)| &plants.plants).map(|plant| plant.size);
        let tallest = sizes.fold(0.0, f32::max);
        let sets = grown.map(|(_, plants)| Batch::new(gpu, scene, (landscape, plants), &pipelines.groups));
        let sets = sets.collect::<Result<_, _>>()?;
        let wood = if scene.has_woods() { Some(Wood::new(gpu, &pipelines)?) } else { None };
        Ok(Some(Self { sets, wood, has_trees: false, pipelines, tallest }))
    }

    /// How far the trees of woods are drawn one by one, in metres, where the nearest ground in sight is so far away: not at all
    /// from farther away than that.
    pub(super) fn reach_of_trees(&mut self, nearest: f32) -> f32 {
        self.has_trees = self.wood.is_some() && nearest < REACH;
        if self.has_trees { REACH } else { 0.0 }
    }

    /// Encodes that the trees of woods stand around a point.
    pub(super) fn grow(&mut self, encoder: &mut CommandEncoder, groups: [&BindGroup; 2], from: [f32; 3]) {
        if let Some(wood) = self.wood.as_mut().filter(|_| self.has_trees) {
            wood.grow(encoder, groups, &self.pipelines, from);
        }
    }

    /// What is drawn: scattered plants, and trees of woods where these are.
    fn drawn(&self) -> impl Iterator<Item = &Batch> {
        let trees = self.wood.iter().filter(|_| self.has_trees).flat_map(|wood| &wood.kinds);
        self.sets.iter().chain(trees)
    }

    /// Encodes the choice of what is drawn for the camera and in cascades that are drawn anew.
    pub(super) fn choose(
        &self,
        encoder: &mut CommandEncoder,
        groups: [&BindGroup; 2],
        stale: [bool; CASCADES],
    ) {
        let drawn = stale.iter().zip(&SEATS[1..]).filter(|(is_stale, _)| **is_stale);
        let views = 1 + drawn.clone().count() as u32;
        // The camera's seats, those that plants share, and those of cascades.
        let carried = 2 + drawn.filter(|(_, seats)| **seats > 0).count() as u32;
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for set in self.drawn() {
            pass.set_bind_group(2, &set.choose, &[]);
            let [count, line_up, place] = &self.pipelines.choose;
            for (pipeline, [across, down]) in
                [(count, [set.groups, views]), (line_up, [views, 1]), (place, [set.groups, views])]
            {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(across, down, 1);
            }
            pass.set_bind_group(2, &set.carry, &[]);
            pass.set_pipeline(&self.pipelines.carry);
            pass.dispatch_workgroups(SEATS.into_iter().max().unwrap_or(0), carried, 1);
        }
    }

    /// Encodes that all stand on the ground as it is now.
    pub(super) fn stand(&mut self, encoder: &mut CommandEncoder, groups: [&BindGroup; 2]) {
        self.wood.iter_mut().for_each(Wood::forget);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipelines.stand);
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for set in &self.sets {
            pass.set_bind_group(2, &set.stand, &[]);
            pass.dispatch_workgroups(set.groups, 1, 1);
        }
    }

    /// Draws the light of all plants that the camera sees.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>) {
        let [whole, divided] = &self.pipelines.light;
        for set in self.drawn() {
            let near = if set.is_divided { divided } else { whole };
            pass.set_pipeline(near);
            self.draw_lists(pass, set, (0, 0..LISTS_OF_FINEST));
            pass.set_pipeline(whole);
            self.draw_lists(pass, set, (0, LISTS_OF_FINEST..LISTS));
        }
    }

    /// Draws what throws shadows into a cascade, 0 for the first.
    pub(super) fn cast(&self, pass: &mut RenderPass<'_>, cascade: usize) {
        pass.set_pipeline(&self.pipelines.caster);
        for set in self.drawn() {
            self.draw_lists(pass, set, (1 + cascade, 0..LISTS));
        }
    }

    /// The list and number of each plant that was chosen for the camera, set by set.
    pub(super) fn chosen(&self, gpu: &Gpu) -> Result<Vec<Vec<[u32; 2]>>, Error> {
        self.sets.iter().map(|set| set.chosen(gpu)).collect()
    }

    /// Where the roots of all plants are.
    pub(super) fn roots(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, Error> {
        Ok(self.sets.iter().map(|set| set.roots(gpu)).collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Where the roots of the trees of woods are that stand around the camera.
    pub(super) fn trees(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, Error> {
        let kinds = self.wood.iter().flat_map(|wood| &wood.kinds);
        Ok(kinds.map(|kind| kind.roots(gpu)).collect::<Result<Vec<_>, _>>()?.concat())
    }

    fn draw_lists(&self, pass: &mut RenderPass<'_>, set: &Batch, (view, lists): (usize, Range<usize>)) {
        pass.set_bind_group(2, &set.draw, &[]);
        pass.set_vertex_buffer(0, set.mesh.corners.buffer.slice(..));
        pass.set_index_buffer(set.mesh.indices.buffer.slice(..), IndexFormat::Uint32);
        let start_of = |list: usize| set.starts.buffer.slice(4 * (view * LISTS + list) as u64..);
        pass.set_vertex_buffer(2, start_of(SEATED_LISTS));
        pass.set_bind_group(3, &self.pipelines.which, &[self.pipelines.numbers.offset(view)]);
        for list in lists {
            let number = view * LISTS + list;
            pass.set_vertex_buffer(1, start_of(list));
            pass.draw_indexed_indirect(&set.mesh.draws.buffer, DRAW * number as u64);
        }
    }
}
