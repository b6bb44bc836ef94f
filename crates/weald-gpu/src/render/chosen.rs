//! The grass that is left after culling, by level of detail, read back: for tests and benches.

use std::sync::Arc;

use weald::Error;
use weald::grow::grass::Packed;
use weald::grow::grass::choice::LISTS;
use weald::picture::Camera;
use wgpu::{BufferUsages, CommandEncoderDescriptor};

use super::grass::Grass;
use super::grass_layer::LoadedSets;
use super::picture::read_back;
use super::renderer::Renderer;
use crate::gpu::Gpu;
use crate::memory::Store;

/// The sets of one grass, and those of them that a picture draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The sets, in their order.
    pub sets: Vec<Packed>,
    /// The numbers of those at each level of detail, from the finest blades to the coarsest.
    pub lists: [Vec<u32>; LISTS],
}

impl Renderer {
    /// What the picture of a camera draws of each grass.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn chosen(&mut self, camera: &Camera) -> Result<Vec<Chosen>, Error> {
        let context = self.gpu.context.clone();
        context.attempt("choosing grass", || {
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.aim((&Arc::clone(&self.own), true), (camera, None), &mut encoder)?;
            context.queue.submit([encoder.finish()]);
            Ok(())
        })?;
        let loaded = self.grass.iter().flat_map(Grass::loaded);
        loaded.map(|loaded| Chosen::of(&self.gpu, loaded)).collect()
    }
}

impl Renderer {
    /// Where the roots of the grass are that the picture of a camera draws, and those of all plants.
    #[doc(hidden)]
    pub fn roots_for_a_test(&mut self, camera: &Camera) -> Result<[Vec<[f32; 3]>; 2], Error> {
        self.render(camera)?;
        let mut grass = Vec::new();
        for loaded in self.grass.iter().flat_map(Grass::loaded) {
            let (lit, starts) = (loaded.lit[0].words(&self.gpu)?, words(&self.gpu, &loaded.starts)?);
            let count = starts.last().copied().unwrap_or(0);
            let root = |set: &[u32]| [0, 1, 2].map(|at| f32::from_bits(set[at]));
            grass.extend(lit.chunks_exact(8).take(count as usize).map(root));
        }
        let plants = self.plants.as_ref().map_or_else(|| Ok(Vec::new()), |plants| plants.roots(&self.gpu))?;
        Ok([grass, plants])
    }
}

impl Chosen {
    fn of(gpu: &Gpu, loaded: &LoadedSets) -> Result<Self, Error> {
        let (kept, starts) = (words(gpu, &loaded.kept)?, words(gpu, &loaded.starts)?);
        let sets = words(gpu, &loaded.sets)?;
        let begin = |list: usize| starts[list * loaded.runs() as usize] as usize;
        Ok(Self {
            sets: sets.chunks_exact(4).map(|set| [set[0], set[1], set[2], set[3]]).collect(),
            lists: std::array::from_fn(|list| kept[begin(list)..begin(list + 1)].to_vec()),
        })
    }
}

/// The words of a buffer.
fn words(gpu: &Gpu, store: &Store) -> Result<Vec<u32>, Error> {
    let bytes = store.buffer.size();
    let landing =
        Store::new(gpu, "a buffer to read back", bytes, BufferUsages::COPY_DST | BufferUsages::MAP_READ)?;
    let mut encoder = gpu.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(&store.buffer, 0, &landing.buffer, 0, bytes);
    gpu.context.queue.submit([encoder.finish()]);
    read_back(gpu, &landing.buffer, bytemuck::pod_collect_to_vec::<u8, u32>)
}
