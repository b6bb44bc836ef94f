//! Holds a simulation in hand, as a window does: runs it, paints on it, takes it back, draws two views of it as it goes,
//! gives them other sizes, asks what is seen at a pixel, keeps and saves it.

use std::sync::Arc;

use weald::edit::{Brush, Effect, Setting};
use weald::engine::Engine;
use weald::picture::{LitScene, View};
use weald::recipe::{Cache, Overrides, Recipe, Session, SessionOptions, Silent, source::Value};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer, SceneUpdate, Screen};

const RECIPE: &str = "[landscape]\nsize = 128\ncell = 20.0\n[[step]]\ndo = \"diamond-square\"\nrelief = 400.0\n\
    [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\n[[step]]\ndo = \"slope\"\n\
    [[output]]\nlayer = \"slope\"\nfile = \"slope.tif\"\n";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, Into::into);
    // One device for the simulation and its pictures; `Gpu::shared` takes that of a window.
    let gpu = Gpu::any()?;
    let live = Live::new(&gpu, weald::Size::square(128)?)?;
    let cache = Some(Arc::new(Cache::in_memory(1 << 28)));
    let engine = Engine::Device(Arc::new(gpu.shown_in(&live)));
    let recipe = Recipe::parse("held.toml", RECIPE, &Overrides::default())?;
    let mut session =
        Session::open(recipe, SessionOptions { engine, cache, ..SessionOptions::default() }, &Silent)?;
    let (view, start) = (View::default(), session.history().simulation().start().clone());
    let scene = LitScene::new(&view, &start)?.to_follow();
    let mut renderer = Renderer::new(&gpu, &scene, RenderOptions { size: [480, 270], samples: 1 })?;
    renderer.plant(&scene, &start)?;
    let cameras = [scene.camera(), scene.camera().turned([1280.0, -1280.0, 200.0], 60.0)];
    let mut screens = [renderer.screen([480, 270])?, renderer.screen([320, 320])?];
    // A frame: nothing is read back, and nothing is waited for.
    let frame = |renderer: &mut Renderer, screens: &mut [Screen; 2]| {
        renderer.follow(&scene, &live)?;
        screens.iter_mut().zip(&cameras).try_for_each(|(screen, camera)| renderer.draw_on(screen, camera))
    };

    session.advance(200)?;
    screens[0].ask([240.5, 150.5]);
    frame(&mut renderer, &mut screens)?;
    let pick = loop {
        if let Some(pick) = screens[0].answers()?.pop() {
            break pick; // some frames later in a window
        }
    };
    let place = pick.ground.ok_or("there is no ground in the middle of the picture")?.place;
    session.paint(Brush::dab(Effect::AddWater { depth: 30.0 }, place, 300.0))?;
    session.set(Setting { key: "rain".into(), value: Value::Number(0.2) })?;
    session.history().name("flooded");
    session.advance(100)?;
    renderer.resize_screen(&mut screens[1], [480, 270])?;
    frame(&mut renderer, &mut screens)?;
    for (name, screen) in ["flood.png", "flood-beside.png"].iter().zip(&screens) {
        std::fs::write(folder.join(name), screen.image()?.to_png(&[]))?;
    }

    session.history().undo()?; // the steps since; then what is done begins a branch
    session.history().go_to(1)?;
    session.advance(100)?;
    let now = scene.changed(&view, &session.landscape()?.0)?.to_follow(); // of another thread, in a window
    renderer.update(SceneUpdate::of(&now))?; // colours, and the light of the sky
    frame(&mut renderer, &mut screens)?;
    std::fs::write(folder.join("dry.png"), screens[0].image()?.to_png(&[]))?;
    let flooded = session.history().names()["flooded"];
    session.history().go_to(flooded)?;
    session.save(&folder.join("held.toml"))?; // `weald run held.toml` gives the same bits on the same device
    let slope = session.finish(&Silent)?.field("slope")?.range(None);
    println!("{}: {slope:?} after {} steps, painted at {place:?}", folder.display(), session.steps());
    Ok(())
}
