//! A device as the library's recipes and figures draw with it.

use weald::Error;
use weald::engine::device::Device;
use weald::picture::{Camera, GrassRate, Image, RenderDevice, RenderRequest, Rendering};

use super::grass_look::GrassLook;
use super::options::Options;
use super::renderer::Renderer;
use super::tables::{GrassRow, Measuring, grass_tables};
use crate::gpu::Gpu;

impl RenderDevice for Gpu {
    fn adapter(&self) -> String {
        Device::adapter(self)
    }

    fn check(&self, size: [u32; 2], samples: u32) -> Result<(), Error> {
        Options { size, samples }.check(self)
    }

    fn set_up<'a>(&self, request: &RenderRequest<'a>) -> Result<Box<dyn Rendering + 'a>, Error> {
        let size = [request.view.width, request.view.height];
        let options = Options { size, samples: request.samples };
        let mut renderer = Renderer::planted(self, (request.scene, request.landscape), options)?;
        if !request.is_film && request.samples > 1 {
            renderer.set_grass_look(GrassLook::of_a_still());
        }
        Ok(Box::new(renderer))
    }

    fn grass_rates(&self, most_sets: u32) -> Result<Vec<GrassRate>, Error> {
        let what = Measuring { most_drawn: most_sets, ..Measuring::of(self) };
        let rate = |row: &GrassRow| GrassRate {
            table: row.table,
            view: row.standpoint.name(),
            level: row.look.level.unwrap_or_default(),
            sets: row.sets[0],
            drawn: row.sets[1],
            size: what.size,
            rate: row.frames_per_second(),
            source: row.source.unwrap_or_default(),
        };
        Ok(grass_tables(self, what, &mut |_| Ok(()))?.iter().map(rate).collect())
    }
}

impl Rendering for Renderer {
    fn draw(&mut self, camera: &Camera, seconds: f64) -> Result<Image, Error> {
        self.set_time(seconds as f32);
        self.render(camera)
    }
}
