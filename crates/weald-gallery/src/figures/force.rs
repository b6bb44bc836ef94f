//! Force-based erosion against dissolution on the same ground.

use super::layered::{CUT_OPEN, Look, SOURCE, four, ground, material, simulated};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "force",
    title: "Force-based erosion against dissolution",
    source: SOURCE,
    shows: "Running water cuts where it is fast and leaves its bed rough. Dissolution softens whatever \
            lies under water, fast or slow, and what softened creeps and evens the bed out.",
    seconds: 2,
    make: Make::Alone(make),
};

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (columns, rows, iterations) = job.choose((128, 80, 2000), (40, 32, 60));
    let start = stream(Size::new(columns, rows)?);
    let keys = format!(
        "sources = [{{ x = {:?}, y = {:?}, radius = 3.0, rate = 0.04 }}]",
        0.1 * columns as f64,
        0.5 * rows as f64
    );
    let forced = simulated(&start, iterations, &format!("{keys}\nerosion = 4.0\nviscosity = 0.2"))?;
    let dissolved =
        simulated(&start, iterations, &format!("{keys}\nerosion = 0.0\ndissolution = {{ depth = 0.3 }}"))?;
    let landscapes = [&start, &forced, &dissolved];
    let names = ["before", "force-based", "dissolution"];
    let titles = ["before", "after force-based erosion", "after dissolution"];
    let stages: Vec<_> = titles.into_iter().zip(landscapes).collect();
    let caption =
        format!("Before, and after {iterations} steps of force-based erosion and of dissolution: {CUT_OPEN}");
    let image = Look { exaggeration: 1.2, along: Along::Column, at: 0.6 }.stages(&stages)?;
    let plates = vec![Plate { name: "stages", caption, image }];
    let beds = names.into_iter().zip(landscapes);
    let beds = beds.map(|(name, after)| Bed::of(name, &start, after)).collect::<Result<Vec<_>, _>>()?;
    let measured = Measured {
        header: texts(["erosion", "deepest cut, m", "moved, m³", "roughness of the bed, m"]),
        rows: beds.iter().map(Bed::row).collect(),
        remarks: texts([
            "Without the first fifth, where the source is, and the edge. The bed is what lies within four \
             cells of the middle of the valley; its roughness is the mean difference to the mean of four \
             neighbours.",
        ]),
    };
    Ok(FigureOutput { plates, measured, claims: claims(&beds), ..FigureOutput::default() })
}

/// A valley with a stream bed, rough from humps a few cells wide, in deep soil.
fn stream(size: Size) -> Landscape {
    let rows = size.rows as f64;
    let height = Field::from_function(size, |x, y| {
        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
        let middle = 0.5 * rows + 0.08 * rows * libm::sin(x / 15.0);
        let away = (y - middle).abs();
        let humps = 0.25 * libm::sin(x * 0.9) * libm::cos(y * 0.8);
        (25.0 - 0.06 * x + 0.12 * away + 0.5 * (away - 4.0).clamp(0.0, 4.0) + humps) as f32
    });
    let mut landscape = ground(height, 1.0, vec![material("rock", "rock"), material("soil", "soil")]);
    landscape.materials[1].thickness = 8.0;
    landscape
}

/// What became of the stream's bed.
struct Bed {
    erosion: &'static str,
    deepest_cut: f64,
    moved: f64,
    roughness: f64,
}

impl Bed {
    fn of(erosion: &'static str, start: &Landscape, after: &Landscape) -> Result<Self, Error> {
        let (before, height) = (start.field("height")?, after.field("height")?);
        let size = height.size();
        let inner: Vec<usize> = (2..size.rows - 2)
            .flat_map(|y| (size.columns / 5..size.columns - 4).map(move |x| size.index(x, y)))
            .collect();
        let lost = |&at: &usize| f64::from(before.values()[at] - height.values()[at]);
        Ok(Self {
            erosion,
            deepest_cut: inner.iter().map(lost).fold(0.0, f64::max),
            moved: inner.iter().map(|at| lost(at).abs()).sum(),
            roughness: roughness(height, &inner),
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.erosion.to_owned(),
            format!("{:.2}", self.deepest_cut),
            format!("{:.0}", self.moved),
            format!("{:.3}", self.roughness),
        ]
    }
}

fn claims(beds: &[Bed]) -> Vec<Claim> {
    let [before, forced, dissolved] = [&beds[0], &beds[1], &beds[2]];
    let deeper = dissolved.deepest_cut > 0.5 && forced.deepest_cut > 1.3 * dissolved.deepest_cut;
    let (was, rough, even) = (before.roughness, forced.roughness, dissolved.roughness);
    vec![
        Claim::new(
            "Force-based erosion cuts where water is fast",
            Verdict::of(deeper && rough > was),
            format!(
                "its deepest cut is {:.2} m, that of dissolution {:.2} m; it roughens the bed from \
                 {was:.3} to {rough:.3} m",
                forced.deepest_cut, dissolved.deepest_cut
            ),
        ),
        Claim::new(
            "Dissolution softens what lies under water and evens the bed out",
            Verdict::of(dissolved.moved > 0.0 && even < 0.2 * was),
            format!("roughness of the bed falls from {was:.3} to {even:.3} m"),
        ),
    ]
}

fn roughness(height: &Field, inner: &[usize]) -> f64 {
    let size = height.size();
    let in_bed = |&&at: &&usize| {
        let (x, y) = ((at % size.columns) as f64 + 0.5, (at / size.columns) as f64 + 0.5);
        (y - size.rows as f64 * (0.5 + 0.08 * libm::sin(x / 15.0))).abs() < 4.0
    };
    let rough = |&at: &usize| {
        let mean = four(size, at).iter().map(|&next| f64::from(height.values()[next])).sum::<f64>() / 4.0;
        (f64::from(height.values()[at]) - mean).abs()
    };
    let bed: Vec<f64> = inner.iter().filter(in_bed).map(rough).collect();
    bed.iter().sum::<f64>() / bed.len().max(1) as f64
}
