//! How large k may be: a lake at rest with the least ripples, left to itself.

use super::views::laid_out;
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::{LayerName, Length};
use weald_core::random::signed2;
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::erode::hydraulic::{HanKeys, Hydraulic, Model};
use weald_picture::{Image, Scale, encode};

pub(super) const FIGURE: Figure = Figure {
    id: "stability",
    title: "How large k may be",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, section on parameters",
    shows: "The scheme is explicit: beyond a certain k waves grow without bound. On a lake at rest a wave of the \
            shortest length grows when k > 1/2, so recipes cannot ask for more.",
    seconds: 1,
    make: Make::Alone(make),
};

/// The last two lie on either side of the bound, closely.
const RATES: [f64; 4] = [0.4, 0.49, 0.5, 0.501];

/// Depth of the lake and height of its ripples, in cells.
const DEPTH: f32 = 100.0;
const RIPPLES: f32 = 0.01;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (side, iterations) = job.choose((64, 300), (16, 300));
    let lakes =
        RATES.map(|rate| left_alone(side, iterations, rate)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let growth: Vec<f64> = lakes.iter().map(amplification).collect();
    let drawn = RATES.iter().zip(&lakes).map(|(rate, lake)| surface(lake).titled(&format!("k = {rate:?}")));
    let images: Vec<Image> = drawn.collect();
    let rows = RATES.iter().zip(&growth);
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "lake",
            caption: format!(
                "The corner of a lake after {iterations} steps with k of 0.4, 0.49, 0.5 and 0.501"
            ),
            image: laid_out(&images, 4),
        }],
        measured: Measured {
            header: texts(["k", "ripples after / before"]),
            rows: rows.map(|(rate, growth)| vec![format!("{rate:?}"), number(*growth)]).collect(),
            remarks: vec![format!(
                "Greatest difference to the level at rest. The lake is {DEPTH} cells deep and has no limiter; \
                 ripples are {RIPPLES} cells high, so that a growth of 10,000 reaches its bottom."
            )],
        },
        claims: vec![Claim::new(
            "There is a greatest k beyond which the scheme is unstable; it is 1/2",
            Verdict::of(growth[..3].iter().all(|&growth| growth < 10.0) && growth[3] > 1000.0),
            format!("ripples grow {}-fold at 0.5 and {}-fold at 0.501", number(growth[2]), number(growth[3])),
        )],
        ..FigureOutput::default()
    })
}

fn number(growth: f64) -> String {
    if growth < 100.0 { format!("{growth:.1}") } else { format!("{growth:.0e}") }
}

/// The lake after a time without rain, sun and erosion. The recipe's own bound of k is not asked.
fn left_alone(side: usize, iterations: u32, rate: f64) -> Result<Landscape, Error> {
    let size = Size::square(side)?;
    let mut landscape = Landscape::new(Domain::new(size, 1.0));
    landscape.insert("height", "m", Field::filled(size, 0.0));
    let ripple = |x: usize, y: usize| DEPTH + RIPPLES * signed2(1, x as i64, y as i64) as f32;
    landscape.insert("lake", "m", Field::from_function(size, ripple));
    let [rain, evaporation] = [Length::Metres(0.0); 2];
    let erosion = Some(0.0);
    let keys = HanKeys { flow_rate: rate, rain, evaporation, erosion, limiter: false, ..HanKeys::default() };
    let hydraulic = Hydraulic {
        iterations,
        model: Model::Han(keys),
        initial_water: Some(LayerName::of("lake")),
        ..Hydraulic::default()
    };
    hydraulic.run(&mut landscape, &Job::unwatched(0))?;
    Ok(landscape)
}

fn amplification(lake: &Landscape) -> f64 {
    let depth = lake.field("water").expect("a run leaves water");
    let away = depth.values().iter().map(|depth| (depth - DEPTH).abs()).fold(0.0, f32::max);
    f64::from(away / RIPPLES)
}

/// Cells a side, from the corner, and pixels a cell of the drawing.
const DRAWN: usize = 12;
const PIXELS: usize = 26;

/// Levels up to this many ripples away have colours of their own.
const RANGE: f32 = 5.0;

/// The corner of the lake, a square a cell: what is smoothed would hide waves of two cells.
fn surface(lake: &Landscape) -> Image {
    let depth = lake.field("water").expect("a run leaves water");
    let ramp = Scale::Water.ramp();
    let side = DRAWN * PIXELS;
    let colour = |pixel: usize| {
        let (x, y) = (pixel % side / PIXELS, pixel / side / PIXELS);
        encode(ramp.at(0.5 + (depth.at(x, y) - DEPTH) / (2.0 * RANGE * RIPPLES)))
    };
    Image { width: side, height: side, rgb: (0..side * side).flat_map(colour).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ripples_three_times_as_high_as_at_first_have_grown_threefold() {
        let size = Size::square(2).expect("small");
        let mut lake = Landscape::new(Domain::new(size, 1.0));
        let depths = vec![DEPTH, DEPTH + RIPPLES, DEPTH - 3.0 * RIPPLES, DEPTH];
        lake.insert("water", "m", Field::from_values(size, depths));
        assert!((amplification(&lake) - 3.0).abs() < 0.01, "{}", amplification(&lake));
    }
}
