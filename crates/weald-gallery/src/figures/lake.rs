//! A source fills a hollow until its water finds an outlet, which it then carves.

use super::layered::{CUT_OPEN, Look, SOURCE, ground, material, simulated};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "lake",
    title: "A lake finds its outlet",
    source: SOURCE,
    shows: "A source fills a hollow. The lake rises to the lowest place of its rim and spills over it; what spills \
            carves the outlet deeper, and the lake sinks with it.",
    seconds: 4,
    make: Make::Alone(make),
};

/// Height of the lowest place of the rim, in metres.
const OUTLET: f32 = 9.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (columns, rows, iterations) = job.choose((120, 72, [600, 6000, 3000]), (40, 24, [40, 60, 80]));
    let start = hollow(Size::new(columns, rows)?);
    let stages = Stages { columns, rows, iterations };
    let filling = simulated(&start, iterations[0], &stages.keys(0.0))?;
    let full = stages.full(&start)?;
    let spilling = simulated(&full, iterations[2], &stages.keys(1.0))?;
    let landscapes = [&start, &filling, &full, &spilling];
    let titles = ["before", "filling", "full to its outlet", "after the spill has carved the outlet"];
    let drawn: Vec<_> = titles.into_iter().zip(landscapes).collect();
    let caption =
        format!("Before, filling, full to its outlet, and after the spill has carved it: {CUT_OPEN}");
    let image = Look { exaggeration: 1.0, along: Along::Row, at: 0.5 }.stages(&drawn)?;
    let plates = vec![Plate { name: "stages", caption, image }];
    let names = ["before", "filling", "full", "spilled"].into_iter().zip(landscapes);
    let levels = names.map(|(name, landscape)| Levels::of(name, landscape)).collect::<Result<Vec<_>, _>>()?;
    let measured = Measured {
        header: texts(["stage", "lake level, m", "outlet, m", "water beyond it, m³"]),
        rows: levels.iter().map(Levels::row).collect(),
        remarks: texts([
            "Level in the middle of the lake; the outlet is the highest ground on the lowest path out of it.",
        ]),
    };
    Ok(FigureOutput { plates, measured, claims: claims(&levels), ..FigureOutput::default() })
}

struct Stages {
    columns: usize,
    rows: usize,
    iterations: [u32; 3],
}

impl Stages {
    fn keys(&self, erosion: f64) -> String {
        format!(
            "erosion = {erosion:?}\ninitial_water = \"stands\"\nviscosity = 0.2\nslippage = {{}}\n\
             sources = [{{ x = {:?}, y = {:?}, radius = 3.0, rate = 0.05 }}]",
            self.columns as f64 / 3.0,
            self.rows as f64 / 2.0
        )
    }

    /// Over-full water that has run off until it rests at the outlet.
    fn full(&self, start: &Landscape) -> Result<Landscape, Error> {
        let mut brimming = start.clone();
        let height = start.field("height")?.clone();
        let above = |&ground: &f32| (OUTLET + 0.3 - ground).max(0.0);
        let water = height.values().iter().map(above).collect();
        brimming.insert("stands", "m", Field::from_values(height.size(), water));
        let mut full = simulated(&brimming, self.iterations[1], "erosion = 0.0\ninitial_water = \"stands\"")?;
        let water = full.field("water")?.clone();
        full.insert("stands", "m", water);
        Ok(full)
    }
}

/// A hollow in a plain, with a lower place in the east of its rim from which the ground falls away.
fn hollow(size: Size) -> Landscape {
    let (columns, rows) = (size.columns as f64, size.rows as f64);
    let height = Field::from_function(size, |x, y| {
        let (east, south) = (x as f64 + 0.5 - columns / 3.0, y as f64 + 0.5 - rows / 2.0);
        let away = libm::sqrt(east * east + south * south) - rows * 0.3;
        let plain = 12.0 + (0.4 * away).clamp(-7.0, 0.0);
        let beyond = (east - rows * 0.3 - 4.0).max(0.0);
        let notch = f64::from(OUTLET) - 0.12 * beyond + 0.02 * south * south;
        if east > 0.0 { plain.min(notch) as f32 } else { plain as f32 }
    });
    let size = height.size();
    let mut landscape = ground(height, 1.0, vec![material("rock", "rock"), material("soil", "soil")]);
    landscape.materials[1].thickness = 6.0;
    landscape.insert("stands", "m", Field::filled(size, 0.0));
    landscape
}

/// Heights of a stage in metres.
struct Levels {
    stage: &'static str,
    lake: f32,
    outlet: f32,
    /// Water beyond the outlet in cubic metres.
    spilt: f32,
}

impl Levels {
    fn of(stage: &'static str, landscape: &Landscape) -> Result<Self, Error> {
        let (height, size) = (landscape.field("height")?, landscape.domain.size);
        let dry = Field::filled(size, 0.0);
        let water = landscape.field("water").unwrap_or(&dry);
        let (x, y) = (size.columns / 3, size.rows / 2);
        let rim = x..size.columns - 1;
        // Every way out crosses each of these columns.
        let lowest = |x: usize| (0..size.rows).map(|y| height.at(x, y)).fold(f32::INFINITY, f32::min);
        let beyond = size.columns * 3 / 4..size.columns - 1;
        Ok(Self {
            stage,
            lake: height.at(x, y) + water.at(x, y),
            outlet: rim.map(lowest).fold(f32::NEG_INFINITY, f32::max),
            spilt: beyond.flat_map(|x| (0..size.rows).map(move |y| water.at(x, y))).sum(),
        })
    }

    fn row(&self) -> Vec<String> {
        let Self { stage, lake, outlet, spilt } = self;
        vec![(*stage).to_owned(), format!("{lake:.3}"), format!("{outlet:.3}"), format!("{spilt:.1}")]
    }
}

fn claims(levels: &[Levels]) -> Vec<Claim> {
    let [before, filling, full, spilled] = [0, 1, 2, 3].map(|stage| &levels[stage]);
    let rises = before.lake < filling.lake && filling.lake < full.lake && filling.spilt == 0.0;
    let carved = full.outlet - spilled.outlet > 0.5 && full.lake - spilled.lake > 0.5;
    vec![
        Claim::new(
            "A lake rises to the lowest place of its rim",
            Verdict::of(rises && (full.lake - full.outlet).abs() < 0.01),
            format!("it stands at {:.3} m, its outlet at {:.3} m", full.lake, full.outlet),
        ),
        Claim::new(
            "What spills carves the outlet, and the lake sinks with it",
            Verdict::of(carved && spilled.spilt > 0.0),
            format!(
                "the outlet sinks by {:.2} m, the lake by {:.2} m",
                full.outlet - spilled.outlet,
                full.lake - spilled.lake
            ),
        ),
    ]
}
