//! Ground and water of a running simulation become the surfaces that are drawn, without coming back from the device.

use weald::error::{Limit, Quantity};
use weald::picture::LitScene;
use weald::{Error, Size};
use wgpu::CommandEncoderDescriptor;

use super::follower::Follower;
use super::renderer::Renderer;
use crate::live::Live;

/// Share of the relief by which ground may rise or sink until its bounds are known, and from then on until they are known
/// anew, and stay in sight of all that is drawn.
const SLACK: f32 = 0.25;
const LATER_SLACK: f32 = 0.05;

impl Renderer {
    /// Takes ground and water as they are now for the next pictures: of a simulation on the same device, or what
    /// [`Live::paint`] brought there. Shadows, grass, plants and what is culled follow; the light of the sky and the colours
    /// of the ground stay. `scene` is the one that the renderer was made of, which came from [`LitScene::to_follow`]. Waits
    /// for nothing, but that the first time pipelines are made.
    ///
    /// # Errors
    /// [`Error::Limit`] for a simulation of another size than the scene has, [`Error::Device`] where the device fails.
    pub fn follow(&mut self, scene: &LitScene, live: &Live) -> Result<(), Error> {
        let (size, cells) = (live.size(), scene.cells());
        if [size.columns, size.rows] != cells {
            return Err(other_size(size, cells).into());
        }
        self.gpu.context.tend("following a simulation")?;
        if self.follower.is_none() {
            self.terrain.widen(SLACK);
            self.follower = Some(Follower::new(&self.gpu, scene, &self.maps, self.terrain.squares())?);
        }
        self.renew_bounds()?;
        self.forget_light();
        self.terrain.patch_heights.forget();
        let Some(follower) = &mut self.follower else { return Ok(()) };
        let context = &self.gpu.context;
        let mut encoder = context.device.create_command_encoder(&CommandEncoderDescriptor::default());
        follower.encode(&self.gpu, &mut encoder, &self.maps, live);
        if let Some(plants) = &mut self.plants {
            plants.stand(&mut encoder, [&self.frame.caster_group, &self.maps.group]);
        }
        context.queue.submit([encoder.finish()]);
        follower.submitted();
        Ok(())
    }

    /// Takes the bounds of the ground that have come.
    fn renew_bounds(&mut self) -> Result<(), Error> {
        let Some(follower) = &mut self.follower else { return Ok(()) };
        if let Some(bounds) = follower.bounds()? {
            self.terrain.renew(bounds, LATER_SLACK);
        }
        Ok(())
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
