//! Ground and water of a running simulation become the surfaces that are drawn, without coming back from the device.

use weald::error::{Limit, Quantity};
use weald::picture::LitScene;
use weald::{Error, Size};
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, CommandEncoderDescriptor, ComputePassDescriptor,
};

use super::follower::Follower;
use super::renderer::Renderer;
use crate::live::Live;

/// Control points along the side of a workgroup, and beyond each border, as the shader has them.
const GROUP: u32 = 16;
const RIM: u32 = 2;

/// Share of the relief by which ground may rise or sink while it is followed, and stay in sight of all that is drawn.
const SLACK: f32 = 0.25;

impl Renderer {
    /// Takes ground and water of a simulation as they are now for the next pictures. `scene` is the one that the renderer
    /// was made of, which came from [`LitScene::to_follow`].
    ///
    /// # Errors
    /// [`Error::Limit`] for a simulation of another size than the scene has, [`Error::Device`] where the device fails.
    pub fn follow(&mut self, scene: &LitScene, live: &Live) -> Result<(), Error> {
        let (size, cells) = (live.size(), scene.cells());
        if [size.columns, size.rows] != cells {
            return Err(other_size(size, cells).into());
        }
        if self.follower.is_none() {
            self.terrain.widen(SLACK);
            self.follower = Some(Follower::new(&self.gpu, scene)?);
        }
        self.shadows.whole_is_drawn = false;
        let Some(follower) = &self.follower else { return Ok(()) };
        let [ground, depth] = live.stores();
        let map = |name| BindingResource::TextureView(self.maps.view(name));
        let resources = [
            follower.numbers.buffer.as_entire_binding(),
            ground.buffer.as_entire_binding(),
            depth.buffer.as_entire_binding(),
            map("land"),
            map("top"),
            map("bed"),
            map("level"),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        let context = &self.gpu.context;
        context.attempt("following a simulation", || {
            let group = context.device.create_bind_group(&BindGroupDescriptor {
                label: Some("follow"),
                layout: &follower.pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(&follower.pipeline);
            pass.set_bind_group(0, &group, &[]);
            let groups = cells.map(|cells| (cells as u32 + 2 * RIM).div_ceil(GROUP));
            pass.dispatch_workgroups(groups[0], groups[1], 1);
            drop(pass);
            context.queue.submit([encoder.finish()]);
            Ok(())
        })
    }
}

/// The first side that is not that of the stage.
fn other_size(size: Size, cells: [usize; 2]) -> Limit {
    let [columns, rows] = cells;
    let (asked, side) = if size.columns == columns { (size.rows, rows) } else { (size.columns, columns) };
    let limit = Limit::new(Quantity::CellsPerSide, asked as u64, side as u64..=side as u64);
    limit
        .of(format!("a simulation of {size} cells, followed on a stage of {columns} × {rows}"))
        .remedy("pictures have up to 4096 a side")
}
