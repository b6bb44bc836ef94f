//! Holds a simulation in hand: runs it, paints on it, changes it, draws it as it goes, takes it back, keeps and saves it.

use std::sync::Arc;

use weald::edit::{Brush, Effect, Setting};
use weald::engine::Engine;
use weald::picture::{Camera, LitScene, View};
use weald::recipe::{Cache, Overrides, Recipe, Session, SessionOptions, Silent, source::Value};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer};

const RECIPE: &str = r#"
[landscape]
size = 128
cell = 20.0
[[step]]
do = "diamond-square"
relief = 400.0
[[step]]
do = "hydraulic"
model = "stava"
[[step]]
do = "slope"
[[output]]
layer = "slope"
file = "slope.tif"
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, Into::into);
    // One device for the simulation and its pictures, which see it without anything being read back.
    let gpu = Gpu::any()?;
    let live = Live::new(&gpu, weald::Size::square(128)?)?;
    let cache = Some(Arc::new(Cache::in_memory(1 << 28)));
    let engine = Engine::Device(Arc::new(gpu.shown_in(&live)));
    let recipe = Recipe::parse("held.toml", RECIPE, &Overrides::default())?;
    let options = SessionOptions { engine, cache, ..SessionOptions::default() };
    let mut session = Session::open(recipe, options, &Silent)?;
    let view = View { width: 480, height: 270, ..View::default() };
    let scene = LitScene::new(&view, session.history().simulation().start())?.to_follow();
    let mut renderer = Renderer::new(&gpu, &scene, RenderOptions { size: [480, 270], samples: 1 })?;
    let eye = scene.camera();
    let mut draw = |name: &str, camera: &Camera| -> Result<(), Box<dyn std::error::Error>> {
        renderer.follow(&scene, &live)?;
        Ok(std::fs::write(folder.join(name), renderer.render(camera)?.to_png(&[]))?)
    };

    session.advance(200)?;
    session.paint(Brush::dab(Effect::AddWater { depth: 30.0 }, [1300.0, 1200.0], 300.0))?;
    session.set(Setting { key: "rain".into(), value: Value::Number(0.2) })?;
    session.history().name("flooded");
    session.advance(100)?;
    draw("flood.png", &eye)?;
    draw("flood-beside.png", &eye.turned([1280.0, -1280.0, 200.0], 60.0))?;

    session.history().go_to(1)?; // before the flood; what is done now begins a branch
    session.advance(100)?;
    draw("dry.png", &eye)?;
    let flooded = session.history().names()["flooded"];
    session.history().go_to(flooded)?;
    session.save(&folder.join("held.toml"))?; // `weald run held.toml` gives the same bits on the same device
    let slope = session.finish(&Silent)?.field("slope")?.range(None);
    println!("{}: {slope:?} after {} steps", folder.display(), session.steps());
    Ok(())
}
