//! `weald bench --render`: how long the parts of a drawn picture take on the device, by its own clock.

use std::fmt::Display;
use std::time::Duration;

use weald::engine::device::Device;
use weald::picture::{Camera, Stage, View};
use weald::recipe::{Overrides, Recipe};
use weald::{Field, Landscape};
use weald_gpu::{Gpu, RenderOptions, Renderer};

use crate::engine::with_memory;
use crate::failure::Failure;

/// Mountains with lakes, on a kilometre-wide scale, of which the pictures are drawn.
const GROUND: &str = "\
[landscape]
size = 1024
cell = 10.0
seed = 11
[[step]]
do = \"diamond-square\"
relief = 1500.0
roughness = 0.95
[[output]]
layer = \"height\"
file = \"height.npy\"
";

/// Share of the relief up to which there is water.
const WATER: f32 = 0.3;

/// Pixels and pictures on a card, and on software that acts as one.
const ON_A_CARD: ([u32; 2], u32) = ([1920, 1080], 40);
const ON_SOFTWARE: ([u32; 2], u32) = ([640, 360], 3);

/// Measures and prints a line for each camera.
pub(super) fn run(memory: Option<u64>, print: &mut dyn FnMut(&dyn Display)) -> Result<(), Failure> {
    let gpu = with_memory(Gpu::for_drawing()?, memory)?;
    print(&gpu.adapter());
    let (size, times) = if gpu.is_software() { ON_SOFTWARE } else { ON_A_CARD };
    if gpu.is_software() {
        print(&"software that acts as a graphics card: a small picture, and times that say little");
    }
    let view = View { width: size[0], height: size[1], field_of_view_deg: 50.0, ..View::default() };
    let stage = Stage::new(&view, &landscape()?)?;
    let mut renderer = Renderer::new(&gpu, &stage, RenderOptions { size, samples: 4 })?;
    let [width, height] = size;
    print(&format!("milliseconds of {width} × {height} pixels with 4 samples, the least of {times}"));
    print(&"camera     shadows   ground  sides and sky     film  picture   triangles");
    for (name, camera) in cameras(&stage) {
        let timings = renderer.measure(&camera, times)?;
        let triangles = renderer.triangles(&camera)?;
        let [shadows, ground, behind, film, picture] =
            [timings.shadows, timings.ground, timings.behind, timings.film, timings.picture]
                .map(milliseconds);
        print(&format!(
            "{name:<9} {shadows:>8.2} {ground:>8.2} {behind:>14.2} {film:>8.2} {picture:>8.2} {triangles:>11}"
        ));
    }
    Ok(())
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// The ground with water in its valleys, which stands.
fn landscape() -> Result<Landscape, Failure> {
    let recipe = Recipe::parse("bench.toml", GROUND, &Overrides::default())?;
    let mut landscape = recipe.landscape()?;
    let height = landscape.field("height")?;
    let (low, high) = height.range(None).unwrap_or((0.0, 0.0));
    let level = low + WATER * (high - low);
    let water = height.values().iter().map(|height| (level - height).max(0.0)).collect();
    let water = Field::from_values(height.size(), water);
    landscape.insert("water", "m", water);
    Ok(landscape)
}

/// The whole from afar, a flight, and a person's view.
fn cameras(stage: &Stage) -> Vec<(&'static str, Camera)> {
    let middle = stage.middle();
    let at = |east: f32, south: f32, above: f32| {
        let ground = stage.top_at([f64::from(east), f64::from(south)]).unwrap_or(0.0);
        stage.camera().at([east, -south, ground + above])
    };
    let level = |camera: Camera| camera.towards([middle[0], middle[1], camera.eye[2]]);
    vec![
        ("whole", stage.camera()),
        ("flight", at(5100.0, 8200.0, 400.0).towards(middle)),
        ("person", level(at(5100.0, 7000.0, 1.7))),
    ]
}
