//! `weald bench --render`: how long the passes of a `render` picture take on the device, by its own clock; how many frames of
//! grass it draws in a second, beside those of the source; and what its parts take as sets become more.

use std::fmt::Display;
use std::time::{Duration, Instant};

use weald::engine::device::Device;
use weald::grow::grass::Packed;
use weald::picture::{Camera, LitScene, View};
use weald::recipe::{Overrides, Recipe, ViewRequest};
use weald::{Field, Landscape};
use weald_gpu::bench::{GrassRow, Measuring, frame_budget, grass_tables};
use weald_gpu::{Gpu, RenderOptions, Renderer, Timings};

use crate::arguments::BenchArguments;
use crate::engine::with_memory;
use crate::failure::Failure;
use crate::interrupt;
use crate::values::Point;

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

/// What prints a line.
type Print<'a> = dyn FnMut(&dyn Display) + 'a;

/// Measures, and prints a line for each picture. An interruption may end it at once: nothing is written.
pub(super) fn run(arguments: &BenchArguments, print: &mut Print<'_>) -> Result<(), Failure> {
    interrupt::end_at_once()?;
    let gpu = with_memory(Gpu::for_drawing()?, arguments.gpu_memory)?;
    let usual = Measuring::of(&gpu);
    let what = Measuring { most_drawn: arguments.sets.unwrap_or(usual.most_drawn), ..usual };
    print(&gpu.adapter());
    if gpu.is_software() {
        print(&"software that acts as a graphics card: a small picture, and times that say little");
    }
    if !arguments.recipe.is_empty() {
        return recipes(&gpu, arguments, print);
    }
    let [width, height] = what.size;
    let times = what.times;
    print(&format!(
        "milliseconds of {width} × {height} pixels with 4 samples, the least of {times}; water is what the"
    ));
    print(&"ground takes longer with it; plants has the samples of all pixels brought together in it");
    let bytes = size_of::<Packed>();
    print(&format!("a set of six blades takes {bytes} bytes, and 229 more for what is chosen and drawn"));
    if what.most_drawn < u32::MAX {
        print(&format!(
            "pictures of more than {} sets of grass are left out: --sets draws more",
            what.most_drawn
        ));
    }
    landscapes(&gpu, what, print)?;
    tables(&gpu, what, print)?;
    budget(&gpu, what, print)
}

/// The first view of each recipe, or a person's, warm; beside it how long the same picture takes that is marched on the
/// processor, by which machines can be told apart.
fn recipes(gpu: &Gpu, arguments: &BenchArguments, print: &mut Print<'_>) -> Result<(), Failure> {
    let [width, height] = SIZE_OF_RECIPES;
    print(&format!(
        "milliseconds of {width} × {height} pixels with one sample, the least of {TIMES_OF_RECIPES}; first is what \
         the first takes, with all that is compiled and sent for it\n\n{:<38}{PARTS}  \
         moving  marched  marched/moving   first",
        "recipe"
    ));
    let keys = arguments.standing.map_or_else(Vec::new, standing);
    for recipe in &arguments.recipe {
        let request =
            ViewRequest { recipe: recipe.clone(), overrides: Overrides::default(), keys: keys.clone() };
        let (parsed, view) = request.recipe()?;
        let view = View { width, height, ..view };
        let landscape = parsed.landscape()?;
        let scene = LitScene::with_crags(&view, &landscape)?;
        let options = RenderOptions { size: SIZE_OF_RECIPES, samples: 1 };
        let begun = Instant::now();
        let mut renderer = Renderer::planted(gpu, (&scene, &landscape), options)?;
        let camera = scene.camera();
        renderer.render(&camera)?;
        let first = begun.elapsed();
        let cameras = moving(&scene, arguments.standing.is_some());
        let pace = renderer.pace(&cameras)?.div_f64(cameras.len() as f64);
        let timings = renderer.measure(&camera, TIMES_OF_RECIPES)?;
        let begun = Instant::now();
        view.seen_from(&landscape, camera)?;
        let marched = begun.elapsed();
        let ratio = marched.as_secs_f64() / pace.as_secs_f64().max(1e-9);
        print(&format!(
            "{:<38}{} {:>8.2} {:>8.0} {ratio:>15.1} {:>7.0}",
            recipe.display().to_string(),
            parts(&timings),
            milliseconds(pace),
            milliseconds(marched),
            milliseconds(first)
        ));
    }
    Ok(())
}

/// Size of the pictures of recipes, and how many of each are drawn.
const SIZE_OF_RECIPES: [u32; 2] = [640, 360];
const TIMES_OF_RECIPES: u32 = 5;

/// How a camera moves: seconds from one picture to the next, degrees that it turns in a second, metres that it walks in one at
/// least, and seconds to where it looks.
const APART: f64 = 0.1;
const TURN_DEG: f64 = 5.0;
const WALK: f64 = 1.4;
const FLIGHT: f64 = 60.0;

/// Pictures of a camera that moves.
const MOVED: u32 = 30;

/// Cameras along a path that begins at that of a scene: what pictures have in common is drawn once. A person walks over the
/// ground; others fly to what the camera looks at within a minute.
fn moving(scene: &LitScene, walks: bool) -> Vec<Camera> {
    let camera = scene.camera();
    let [east, north] = [0, 1].map(|axis| f64::from(scene.middle()[axis] - camera.eye[axis]));
    let speed = if walks { WALK } else { (east.hypot(north) / FLIGHT).max(WALK) };
    let run = f64::from(camera.forward[0].hypot(camera.forward[1])).max(1e-6);
    let ground =
        |[east, north, _]: [f32; 3]| scene.top_at([f64::from(east), -f64::from(north)]).unwrap_or_default();
    let at = |number: u32| {
        let gone = (f64::from(number) * APART * speed / run) as f32;
        let [east, north, up] = camera.eye;
        let eye = [east + gone * camera.forward[0], north + gone * camera.forward[1], up];
        let rise = if walks { ground(eye) - ground(camera.eye) } else { 0.0 };
        let eye = [eye[0], eye[1], up + rise];
        camera.at(eye).turned(eye, f64::from(number) * TURN_DEG * APART)
    };
    (1..=MOVED).map(at).collect()
}

/// The keys of a person's view from there.
fn standing(Point { east, south, .. }: Point) -> Vec<(String, String)> {
    let keys = [("eye", format!("[{east}, {south}]")), ("eye_height", "1.7".to_owned())];
    keys.map(|(key, value)| (key.to_owned(), value)).into()
}

/// Mountains and lakes without grass.
fn landscapes(gpu: &Gpu, what: Measuring, print: &mut Print<'_>) -> Result<(), Failure> {
    let [width, height] = what.size;
    let view = View { width, height, field_of_view_deg: 50.0, ..View::default() };
    let scene = LitScene::new(&view, &landscape()?)?;
    let mut renderer = Renderer::new(gpu, &scene, RenderOptions { size: what.size, samples: 4 })?;
    print(&format!("\n{:<38}{PARTS} triangles", "mountains and lakes"));
    for (name, camera) in cameras(&scene) {
        let timings = renderer.measure(&camera, what.times)?;
        let triangles = renderer.triangles(&camera)?;
        print(&format!("{name:<38}{} {triangles:>9}", parts(&timings)));
    }
    Ok(())
}

/// Tables 1 to 3 of the source.
fn tables(gpu: &Gpu, what: Measuring, print: &mut Print<'_>) -> Result<(), Failure> {
    print(&"\nframes a second of grass; source: Kim and Cho 2009, Core 2 Duo E8500 and GeForce 9600 GT");
    print(&"table  view  level    sets   drawn     ours   source   ms of the grass");
    let mut tell = |row: &GrassRow| {
        let GrassRow { table, standpoint, sets: [all, drawn], timings, .. } = row;
        let level = row.look.level.unwrap_or_default();
        let grass = milliseconds(timings.choice + timings.grass);
        print(&format!(
            "{table:>5}  {:<4}  {level:>5} {all:>7} {drawn:>7} {:>8.2} {:>8.2} {grass:>17.2}",
            standpoint.name(),
            row.frames_per_second(),
            row.source.unwrap_or_default(),
        ));
        Ok(())
    };
    grass_tables(gpu, what, &mut tell)?;
    Ok(())
}

/// The parts of a picture by the number of sets.
fn budget(gpu: &Gpu, what: Measuring, print: &mut Print<'_>) -> Result<(), Failure> {
    print(&format!("\n{:<38}{PARTS}", "   sets    drawn  culled  thinned   sown"));
    let mut tell = |row: &GrassRow| {
        let [all, drawn] = row.sets;
        let [culled, thinned] = [row.look.culled, row.look.thinned].map(|is| if is { "yes" } else { "no" });
        let wanted = row.wanted;
        print(&format!(
            "{wanted:>7} {drawn:>8}  {culled:<6}  {thinned:<7} {all:<7}   {}",
            parts(&row.timings)
        ));
        Ok(())
    };
    frame_budget(gpu, what, &mut tell)?;
    Ok(())
}

/// Names of the columns of [`parts`].
const PARTS: &str = " shadows   ground    water   behind   choice    grass   plants     tone  picture";

fn parts(timings: &Timings) -> String {
    let Timings { choice, shadows, ground, water, behind, grass, plants, tone_mapping, picture } = *timings;
    let parts = [shadows, ground, water, behind, choice, grass, plants, tone_mapping, picture];
    parts.map(|part| format!("{:>8.2}", milliseconds(part))).join(" ")
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
fn cameras(scene: &LitScene) -> Vec<(&'static str, Camera)> {
    let middle = scene.middle();
    let at = |east: f32, south: f32, above: f32| {
        let ground = scene.top_at([f64::from(east), f64::from(south)]).unwrap_or(0.0);
        scene.camera().at([east, -south, ground + above])
    };
    let level = |camera: Camera| camera.towards([middle[0], middle[1], camera.eye[2]]);
    vec![
        ("whole", scene.camera()),
        ("flight", at(5100.0, 8200.0, 400.0).towards(middle)),
        ("person", level(at(5100.0, 7000.0, 1.7))),
    ]
}
