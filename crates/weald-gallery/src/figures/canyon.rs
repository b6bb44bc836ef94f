//! A canyon in level beds: hard ones stand as ledges, soft ones are cut back.

use super::layered::{self, CUT_OPEN, Look, SOURCE, ground, material, simulated};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "canyon",
    title: "A canyon in layers",
    source: SOURCE,
    shows: "Water cuts through layers from the top down. Hard layers stand as ledges, soft ones are cut back to the \
            slope on which they rest.",
    seconds: 2,
    make: Make::Alone(make),
};

const CELL: f64 = 5.0;

/// A bed between two heights in metres.
struct Bed {
    name: &'static str,
    bottom: f32,
    top: f32,
}

const BEDS: [Bed; 3] = [
    Bed { name: "granite", bottom: 68.0, top: 84.0 },
    Bed { name: "shale", bottom: 84.0, top: 100.0 },
    Bed { name: "sandstone", bottom: 100.0, top: 120.0 },
];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (columns, rows, iterations) = job.choose((192, 128, 2400), (48, 32, 60));
    let start = plateau(Size::new(columns, rows)?);
    let after = simulated(&start, iterations, &keys(columns, rows))?;
    let caption = format!("Before and after {iterations} steps: {CUT_OPEN}");
    let image = Look { exaggeration: 0.8, along: Along::Column, at: 0.55 }
        .stages(&[("before", &start), ("after", &after)])?;
    let heights = [start.field("height")?, after.field("height")?];
    let walls: Vec<Wall> = BEDS.iter().rev().map(|bed| Wall::of(bed, heights)).collect();
    Ok(FigureOutput {
        plates: vec![Plate { name: "stages", caption, image }],
        measured: Measured {
            header: texts(["bed", "width before, m", "after", "slope before, °", "after"]),
            rows: walls.iter().map(Wall::row).collect(),
            remarks: texts([
                "Mean width of the valley at half the height of the bed, and mean slope of the walls there, \
                 between a fifth and four fifths of its height.",
            ]),
        },
        claims: claims(&walls),
        ..FigureOutput::default()
    })
}

/// A plateau of level beds above a lowland, with a shallow winding valley.
fn plateau(size: Size) -> Landscape {
    let (columns, rows) = (size.columns as f64, size.rows as f64);
    let height = Field::from_function(size, |x, y| {
        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
        let middle = rows * (0.5 + 0.12 * libm::sin(x / columns * 7.0));
        let valley = 98.0 - 0.03 * CELL * x + 0.7 * CELL * (y - middle).abs();
        let cliff = 8.0 + 0.8 * CELL * (0.9 * columns - x);
        valley.min(120.0 - 0.005 * CELL * x).min(cliff).max(14.0 - 0.02 * CELL * x) as f32
    });
    ground(height, CELL, materials())
}

fn materials() -> Vec<Material> {
    let bed = |name, like, erodibility, talus_deg, bottom| Material {
        erodibility,
        talus_deg,
        bottom,
        ..material(name, like)
    };
    let mut beds = vec![
        bed("granite", "rock", 0.01, 75.0, None),
        bed("shale", "clay", 0.05, 32.0, Some(84.0)),
        bed("sandstone", "rock", 0.004, 75.0, Some(100.0)),
        material("sand", "sand"),
    ];
    beds[2].colour = [0.82, 0.60, 0.38];
    beds
}

fn keys(columns: usize, rows: usize) -> String {
    let y = rows as f64 * (0.5 + 0.12 * libm::sin(0.7)) * CELL;
    format!(
        "capacity = 4.0\nerosion = 1.0\ndeposition = 0.05\n\
         viscosity = 5.0\ntransport = \"maccormack\"\ndissolution = {{ depth = 0.2 }}\n\
         slippage = {{ strength = 0.05 }}\nsources = [{{ x = {:?}, y = {y:?}, radius = 20.0, rate = 0.05 }}]",
        0.1 * columns as f64 * CELL
    )
}

/// The valley's walls in one bed, before and after.
struct Wall {
    bed: &'static str,
    widths: [f64; 2],
    slopes_deg: [f64; 2],
}

impl Wall {
    fn of(bed: &Bed, heights: [&Field; 2]) -> Self {
        Self {
            bed: bed.name,
            widths: heights.map(|height| width(height, bed)),
            slopes_deg: heights.map(|height| slope(height, bed)),
        }
    }

    fn row(&self) -> Vec<String> {
        let numbers = self.widths.iter().chain(&self.slopes_deg).map(|number| format!("{number:.0}"));
        std::iter::once(self.bed.to_owned()).chain(numbers).collect()
    }
}

fn claims(walls: &[Wall]) -> Vec<Claim> {
    let [sandstone, shale] = [&walls[0], &walls[1]];
    let [before, hard] = sandstone.slopes_deg;
    let soft = shale.slopes_deg[1];
    let [narrow, wide] = shale.widths;
    vec![
        Claim::new(
            "Hard layers stand as ledges",
            Verdict::of(hard > before + 5.0 && hard > soft + 12.0),
            format!("the sandstone steepens from {before:.0}° to {hard:.0}°, the shale lies at {soft:.0}°"),
        ),
        Claim::new(
            "Soft layers are cut back",
            Verdict::of(wide > 1.5 * narrow),
            format!("the valley in the shale widens from {narrow:.0} to {wide:.0} m"),
        ),
    ]
}

/// The part of the plateau that is measured: away from source and cliff.
fn columns(height: &Field) -> std::ops::Range<usize> {
    let columns = height.size().columns;
    columns / 3..columns * 3 / 4
}

fn width(height: &Field, bed: &Bed) -> f64 {
    let middle = f32::midpoint(bed.bottom, bed.top);
    let below = |x: usize| (1..height.size().rows - 1).filter(|&y| height.at(x, y) < middle).count();
    let columns = columns(height);
    CELL * columns.clone().map(below).sum::<usize>() as f64 / columns.len() as f64
}

/// Mean steepest slope in degrees of the cells at the height of a bed; 0 where there is none.
fn slope(height: &Field, bed: &Bed) -> f64 {
    let fifth = (bed.top - bed.bottom) / 5.0;
    let range = bed.bottom + fifth..bed.top - fifth;
    let size = height.size();
    let cells = columns(height).flat_map(|x| (1..size.rows - 1).map(move |y| size.index(x, y)));
    let falls: Vec<f64> = cells
        .filter(|&at| range.contains(&height.values()[at]))
        .map(|at| layered::steepest_fall(height, at, CELL))
        .collect();
    let cells = falls.len().max(1);
    libm::atan(falls.into_iter().fold(0.0, |sum, fall| sum + fall) / cells as f64).to_degrees()
}
