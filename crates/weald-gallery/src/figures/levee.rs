//! A painted levee holds a river back from low ground.

use super::layered::{CUT_OPEN, Look, SOURCE, ground, material, simulated};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_land::edit::{Area, Brush, Canvas, Effect, Falloff};
use weald_picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "levee",
    title: "A painted levee",
    source: SOURCE,
    shows: "A stroke of the brush lays a levee of the topmost material beside a river that leaves its bed, \
            and the low ground behind it stays dry.",
    seconds: 2,
    make: Make::Alone(make),
};

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (columns, rows, iterations) = job.choose((128, 80, 2500), (40, 32, 80));
    let start = lowland(Size::new(columns, rows)?);
    let guarded = with_levee(&start)?;
    let keys = format!(
        "erosion = 0.0\nsources = [{{ x = {:?}, y = {:?}, radius = 3.0, rate = 0.12 }}]",
        0.06 * columns as f64,
        0.35 * rows as f64
    );
    let flooded = simulated(&start, iterations, &keys)?;
    let held = simulated(&guarded, iterations, &keys)?;
    let stages =
        [("before", &start), ("after, without a levee", &flooded), ("after, behind a painted levee", &held)];
    let caption = format!("A river that leaves its bed, before and after {iterations} steps: {CUT_OPEN}");
    let image = Look { exaggeration: 3.0, along: Along::Column, at: 0.5 }.stages(&stages)?;
    let plates = vec![Plate { name: "stages", caption, image }];
    let names = ["without, before", "without, after", "with, before", "with, after"];
    let lands = names.into_iter().zip([&start, &flooded, &guarded, &held]);
    let lands: Vec<Lowland> = lands.map(|(name, landscape)| Lowland::of(name, landscape)).collect();
    let measured = Measured {
        header: texts(["levee", "flooded behind it", "share", "river, m"]),
        rows: lands.iter().map(Lowland::row).collect(),
        remarks: texts([
            "Cells beyond the levee with more than a centimetre of water, and their share of the ground there; the \
             greatest depth of the river half way.",
        ]),
    };
    Ok(FigureOutput { plates, measured, claims: claims(&lands), ..FigureOutput::default() })
}

/// Middle of the river's bed, as a share of the way from north to south.
const RIVER: f64 = 0.35;
/// Middle of the levee, in the same way.
const LEVEE: f64 = 0.52;

/// A plain that falls gently to the south of a shallow river, which falls to the east.
fn lowland(size: Size) -> Landscape {
    let rows = size.rows as f64;
    let height = Field::from_function(size, |x, y| {
        let south = y as f64 + 0.5 - RIVER * rows;
        // Half way the bed runs out, and the river leaves it.
        let depth = 0.6 * (2.0 - 4.0 * x as f64 / size.columns as f64).clamp(0.0, 1.0);
        let bed = (depth - 0.1 * south.abs()).max(0.0);
        let north = 0.08 * (-south - 6.0).max(0.0);
        (20.0 - 0.01 * x as f64 + north - 0.02 * south.max(0.0) - bed) as f32
    });
    let mut landscape = ground(height, 1.0, vec![material("rock", "rock"), material("soil", "soil")]);
    landscape.materials[1].thickness = 2.0;
    landscape
}

/// The ground with a line of the topmost material painted along the river.
fn with_levee(start: &Landscape) -> Result<Landscape, Error> {
    let mut landscape = start.clone();
    let (size, cell) = (landscape.domain.size, landscape.domain.cell);
    let mut canvas = Canvas::level(Area { first: [0, 0], size }, cell, &landscape.materials);
    let y = LEVEE * size.rows as f64 * cell;
    let soil = landscape.materials[1].clone();
    Brush {
        path: vec![[0.0, y], [size.columns as f64 * cell, y]],
        radius: 4.0 * cell,
        falloff: Falloff::Smooth,
        strength: 1.0,
        effect: Effect::Add { material: soil.name.clone(), thickness: 3.0 },
    }
    .paint(&mut canvas)?;
    let levee = &canvas.thickness[0];
    let height = start.field("height")?;
    let raised = height.values().iter().zip(levee.values()).map(|(ground, levee)| ground + levee).collect();
    let soils = levee.values().iter().map(|levee| soil.thickness as f32 + levee).collect();
    landscape.insert("height", "m", Field::from_values(size, raised));
    landscape.insert(&soil.name, "m", Field::from_values(size, soils));
    Ok(landscape)
}

/// Water on the land behind the levee, and in the river before it.
struct Lowland {
    name: &'static str,
    flooded: usize,
    share: f64,
    river: f32,
}

impl Lowland {
    fn of(name: &'static str, landscape: &Landscape) -> Self {
        let size = landscape.domain.size;
        let dry = Field::filled(size, 0.0);
        let water = landscape.field("water").unwrap_or(&dry);
        let first = (LEVEE * size.rows as f64) as usize + 4;
        let behind = size.columns * (size.rows - first);
        let flooded = (first..size.rows).flat_map(|y| water.row(y)).filter(|&&depth| depth > 0.01).count();
        let river = (0..first).map(|y| water.at(size.columns / 2, y)).fold(0.0, f32::max);
        Self { name, flooded, share: flooded as f64 / behind as f64, river }
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.name.to_owned(),
            self.flooded.to_string(),
            format!("{:.0} %", 100.0 * self.share),
            format!("{:.2}", self.river),
        ]
    }
}

fn claims(lands: &[Lowland]) -> Vec<Claim> {
    let [without, with] = [&lands[1], &lands[3]];
    let river = with.river > 0.0 && with.river >= 0.9 * without.river;
    vec![Claim::new(
        "Soil that a user adds changes where the water goes: land behind a painted levee stays dry",
        Verdict::of(without.share > 0.2 && with.flooded == 0 && river),
        format!("flooded are {} cells without the levee, {} with it", without.flooded, with.flooded),
    )]
}
