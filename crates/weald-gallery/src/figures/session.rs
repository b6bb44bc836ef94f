//! A session at the running simulation, as a film: a river is painted, a levee raised across it, an outlet cut.

use std::time::Instant;

use super::layered::SOURCE;
use super::{Claim, Figure, FigureOutput, Film, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald::recipe::{Overrides, Recipe, Session, SessionOptions, Silent};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_land::edit::{Brush, Effect, Falloff};
use weald_picture::{GroundColour, Image, LitScene, RenderDevice, RenderRequest, View};

pub(super) const FIGURE: Figure = Figure {
    id: "session",
    title: "A session: a river painted, a levee raised, an outlet cut",
    source: SOURCE,
    shows: "The user works on the running simulation: paints water and material, and sees at once where the water goes. \
            The source draws 20 pictures a second on its graphics card, on 2048 × 1024 cells.",
    seconds: 90,
    make: Make::Drawn(make),
};

/// A valley that falls to the east, with low hills, under soil.
const RECIPE: &str = "[landscape]\nsize = [192, 112]\ncell = 4.0\nseed = 9\n\n\
    [[material]]\nname = \"rock\"\ncolour = \"#7d8088\"\n\n\
    [[material]]\nname = \"soil\"\nthickness = 8.0\ncolour = \"#8f9a5a\"\n\n\
    [[step]]\ndo = \"plane\"\nslope = 0.16\nazimuth_deg = 170.0\nheight = 60.0\n\n\
    [[step]]\ndo = \"plane\"\nslope = 0.16\nazimuth_deg = 10.0\nheight = 60.0\ninto = \"south\"\n\n\
    [[step]]\ndo = \"max\"\nwith = \"south\"\n\n\
    [[step]]\ndo = \"smooth\"\nradius = 60.0\n\n\
    [[step]]\ndo = \"fbm\"\nrelief = 16.0\nwavelength = 240.0\ninto = \"hills\"\n\n\
    [[step]]\ndo = \"add\"\nwith = \"hills\"\n\n\
    [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\nboundary = \"open\"\nrain = 0.0\nevaporation = 0.0\n\n\
    [[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";

/// The bed of the river as it is painted, in metres east and south.
const BED: [[f64; 2]; 7] = [
    [30.0, 190.0],
    [120.0, 240.0],
    [230.0, 195.0],
    [340.0, 250.0],
    [460.0, 205.0],
    [610.0, 245.0],
    [768.0, 220.0],
];

/// The levee that is raised across it, and the place where the outlet is cut.
const LEVEE: [[f64; 2]; 2] = [[470.0, 40.0], [500.0, 410.0]];
const OUTLET: [[f64; 2]; 3] = [[400.0, 240.0], [485.0, 255.0], [600.0, 245.0]];

/// Frames of each part of the film, and steps between two frames.
const FRAMES: [usize; 3] = [14, 22, 20];
const STEPS: u64 = 60;

/// Frames per second of the film as it is shown, and of the source.
const SHOWN: f64 = 8.0;
const SOURCE_RATE: f64 = 20.0;

/// What was seen at the end of a part.
struct Stage {
    name: &'static str,
    image: Image,
    /// Water above and below the levee, in m³.
    water: [f64; 2],
}

fn make(job: GalleryJob, device: &dyn RenderDevice) -> Result<FigureOutput, Error> {
    let mut filmed = Filmed::new(job, device)?;
    filmed.paint(&river(), Effect::Remove { material: "soil".to_owned(), thickness: 3.0 }, 18.0)?;
    filmed.paint(&BED[..1], Effect::Source { rate: 0.05 }, 18.0)?;
    let mut stages = vec![filmed.part("a river is painted", FRAMES[0])?];
    filmed.paint(&LEVEE, Effect::Add { material: "soil".to_owned(), thickness: 16.0 }, 44.0)?;
    stages.push(filmed.part("a levee is raised across it", FRAMES[1])?);
    filmed.paint(&OUTLET, Effect::Remove { material: "soil".to_owned(), thickness: 40.0 }, 36.0)?;
    stages.push(filmed.part("an outlet is cut", FRAMES[2])?);
    let rate = filmed.frames.len() as f64 / filmed.began.elapsed().as_secs_f64();
    let rows: Vec<Image> = stages.iter().map(|stage| stage.image.titled(stage.name)).collect();
    let adapter = device.adapter();
    let plates = vec![Plate {
        name: "stages",
        caption: "The end of each part".to_owned(),
        image: Image::below(&rows, 6),
    }];
    let films = vec![Film {
        name: "film",
        caption: format!("The session, {STEPS} steps from frame to frame"),
        frames: filmed.frames,
        per_second: SHOWN,
    }];
    let measured = Measured {
        header: texts(["after", "water above the levee, m³", "below, m³"]),
        rows: stages.iter().map(Stage::row).collect(),
        remarks: vec![format!(
            "{rate:.2} frames per second on {adapter}, each with {STEPS} steps on 192 × 112 cells and a picture of a scene that \
             is made anew; a window follows the simulation without that (`weald bench --studio`)."
        )],
    };
    Ok(FigureOutput { plates, films, measured, claims: claims(&stages, rate, &adapter) })
}

/// The bed, smooth between its points.
fn river() -> Vec<[f64; 2]> {
    let at = |place: usize| BED[place.min(BED.len() - 1)];
    let mut path = Vec::new();
    for piece in 0..BED.len() - 1 {
        let [before, from, to, after] =
            [at(piece.saturating_sub(1)), at(piece), at(piece + 1), at(piece + 2)];
        for step in 0..8 {
            let t = f64::from(step) / 8.0;
            // Catmull and Rom's spline goes through its points.
            path.push([0, 1].map(|axis| {
                let [p, q, r, s] = [before[axis], from[axis], to[axis], after[axis]];
                q + 0.5 * t * (r - p + t * (2.0 * p - 5.0 * q + 4.0 * r - s + t * (3.0 * (q - r) + s - p)))
            }));
        }
    }
    path.push(BED[BED.len() - 1]);
    path
}

/// A session of which pictures are taken.
struct Filmed<'a> {
    session: Session,
    device: &'a dyn RenderDevice,
    view: View,
    scene: LitScene,
    frames: Vec<Image>,
    job: GalleryJob,
    began: Instant,
}

impl<'a> Filmed<'a> {
    fn new(job: GalleryJob, device: &'a dyn RenderDevice) -> Result<Self, Error> {
        let recipe = Recipe::parse("session.toml", RECIPE, &Overrides::default())?;
        let mut session = Session::open(recipe, SessionOptions::default(), &Silent)?;
        let [width, height] = job.choose([640, 360], [64, 36]);
        let view = View {
            width,
            height,
            azimuth_deg: 150.0,
            altitude_deg: 38.0,
            sun_azimuth_deg: 255.0,
            sun_altitude_deg: 34.0,
            ground: Some(GroundColour::Materials),
            ..View::default()
        };
        let scene = LitScene::new(&view, &session.landscape()?.0)?;
        Ok(Self { session, device, view, scene, frames: Vec::new(), job, began: Instant::now() })
    }

    fn paint(&mut self, path: &[[f64; 2]], effect: Effect, radius: f64) -> Result<(), Error> {
        let brush = Brush { path: path.to_vec(), radius, falloff: Falloff::Smooth, strength: 1.0, effect };
        self.session.paint(brush)
    }

    /// Lets it run for so many frames.
    fn part(&mut self, name: &'static str, frames: usize) -> Result<Stage, Error> {
        let (frames, steps) = self.job.choose((frames, STEPS), (2, 4));
        for _ in 0..frames {
            self.session.advance(steps)?;
            self.frame()?;
        }
        let (landscape, _) = self.session.landscape()?;
        let image = self.frames.last().cloned().unwrap_or_else(|| Image::paper(1, 1));
        Ok(Stage { name, image, water: water(&landscape)? })
    }

    fn frame(&mut self) -> Result<(), Error> {
        let (landscape, _) = self.session.landscape()?;
        let scene = self.scene.changed(&self.view, &landscape)?;
        let request = RenderRequest {
            view: &self.view,
            scene: &scene,
            landscape: &landscape,
            samples: 4,
            is_film: true,
        };
        let seconds = self.frames.len() as f64 / SHOWN;
        self.frames.push(self.device.set_up(&request)?.draw(&self.scene.camera(), seconds)?);
        Ok(())
    }
}

/// Water to the west of the levee and to the east of it.
fn water(landscape: &Landscape) -> Result<[f64; 2], Error> {
    let (water, cell): (&Field, f64) = (landscape.field("water")?, landscape.domain.cell);
    let middle = (0.5 * (LEVEE[0][0] + LEVEE[1][0]) / cell) as usize;
    let mut volumes = [0.0; 2];
    for (place, depth) in water.values().iter().enumerate() {
        volumes[usize::from(place % water.size().columns >= middle)] += f64::from(*depth) * cell * cell;
    }
    Ok(volumes)
}

impl Stage {
    fn row(&self) -> Vec<String> {
        let [above, below] = self.water;
        vec![self.name.to_owned(), format!("{above:.0}"), format!("{below:.0}")]
    }
}

fn claims(stages: &[Stage], rate: f64, adapter: &str) -> Vec<Claim> {
    let [river, levee, outlet] = [0, 1, 2].map(|part| stages[part].water);
    vec![
        Claim::new(
            "Water follows what the user paints: a river its bed, a lake behind a levee, a flood through an outlet",
            Verdict::of(levee[0] > 2.0 * river[0] && outlet[0] < 0.7 * levee[0]),
            format!(
                "above the levee {:.0}, then {:.0}, then {:.0} m³ of water",
                river[0], levee[0], outlet[0]
            ),
        ),
        Claim::new(
            "The user works at 20 frames per second",
            Verdict::of(rate >= SOURCE_RATE),
            format!("{rate:.2} frames per second on {adapter}"),
        ),
    ]
}
