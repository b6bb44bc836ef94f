//! Holds a simulation in hand as a window does: runs, paints, takes back, draws two views, resizes, picks and saves.

use std::{error::Error, sync::Arc};
use weald::edit::{Brush, Effect, Setting};
use weald::engine::Engine;
use weald::picture::{LitScene, View};
use weald::recipe::{Cache, Overrides, Recipe, Session, SessionOptions, Silent, source::Value};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer, SceneUpdate, Screen};

const RECIPE: &str = "landscape = { size = 128, cell = 20.0 }\nstep = [{ do = 'diamond-square', relief = 400.0 }, \
    { do = 'hydraulic', model = 'stava' }, { do = 'slope' }]\noutput = [{ layer = 'slope', file = 'slope.tif' }]\n";

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, Into::into);
    let gpu = Gpu::any()?; // one device for the simulation and its pictures; `Gpu::shared` takes that of a window
    let live = Live::new(&gpu, weald::Size::square(128)?)?;
    let cache = Some(Arc::new(Cache::in_memory(1 << 28)));
    let engine = Engine::Device(Arc::new(gpu.shown_in(&live)));
    let options = SessionOptions { engine, cache, ..SessionOptions::default() };
    let recipe = Recipe::parse("held.toml", RECIPE, &Overrides::default())?;
    let mut session = Session::open(recipe, options, &Silent)?;
    let (view, start) = (View::default(), session.history().simulation().start().clone());
    let scene = LitScene::new(&view, &start)?.to_follow();
    let options = RenderOptions { size: [480, 270], samples: 1 };
    let mut renderer = Renderer::planted(&gpu, (&scene, &start), options)?;
    let cameras = [scene.camera(), scene.camera().turned([1280.0, -1280.0, 200.0], 60.0)];
    let mut screens = [renderer.screen([480, 270])?, renderer.screen([320, 320])?];
    let frame = |renderer: &mut Renderer, screens: &mut [Screen; 2]| {
        renderer.follow(&scene, &live)?; // nothing is read back, and nothing is waited for
        screens.iter_mut().zip(&cameras).try_for_each(|(screen, camera)| renderer.draw_on(screen, camera))
    };
    session.advance(200)?;
    screens[0].ask([240.5, 150.5]);
    frame(&mut renderer, &mut screens)?;
    let mut picks = Vec::new();
    while picks.is_empty() {
        picks = screens[0].answers()?; // some frames later in a window
    }
    let place = picks[0].ground.ok_or("there is no ground in the middle of the picture")?.place;
    session.paint(Brush::dab(Effect::AddWater { depth: 30.0 }, place, 300.0))?;
    session.set(Setting { key: "rain".into(), value: Value::Number(0.2) })?;
    session.history().name("flooded");
    session.advance(100)?;
    renderer.resize_screen(&mut screens[1], [480, 270])?;
    frame(&mut renderer, &mut screens)?;
    std::fs::write(folder.join("flood.png"), screens[0].image()?.to_png(&[]))?;
    std::fs::write(folder.join("flood-beside.png"), screens[1].image()?.to_png(&[]))?;
    session.history().undo()?; // the steps since; then what is done begins a branch
    session.history().go_to(1)?;
    session.advance(100)?;
    renderer.update(SceneUpdate::of(&scene.changed(&view, &session.landscape()?.0)?.to_follow()))?;
    frame(&mut renderer, &mut screens)?; // in its new colours and light of the sky, of another thread in a window
    std::fs::write(folder.join("dry.png"), screens[0].image()?.to_png(&[]))?;
    let flooded = session.history().names()["flooded"];
    session.history().go_to(flooded)?;
    session.save(&folder.join("held.toml"))?; // `weald run held.toml` gives the same bits on the same device
    let slope = session.finish(&Silent)?.field("slope")?.range(None);
    println!("{}: {slope:?} after {} steps, painted at {place:?}", folder.display(), session.steps());
    Ok(())
}
