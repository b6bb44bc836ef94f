//! One country on grids of several sizes: how far it is the same landscape.

use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts, views};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::analyse::flow_step::FlowStep;
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::flow::DirectionRule;
use weald_land::generate::diamond_square::DiamondSquare;

pub(super) const FIGURE: Figure = Figure {
    id: "sizes",
    title: "One landscape at every size",
    source: "of no publication: the country of recipes/highland.toml on several grids",
    shows: "Metres and time say what happens, and the grid only how finely it is computed: on more cells the same \
            valleys stand, with the same erosion.",
    seconds: 60,
    make: Make::Alone(make),
};

const EXTENT: f64 = 10_240.0;
const SEED: u64 = 11;

/// Parts of the country that a river drains at least to count as a channel.
const CHANNEL: f64 = 1.0 / 200.0;

/// Depth in metres from which on water is deep.
const DEEP: f32 = 1.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let sides = job.choose([256, 512, 1024], [16, 32, 64]);
    let runs = sides.map(|side| country(side, &sides, job)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let finest = runs.last().expect("there are sizes");
    let measures = runs.iter().map(|run| Measures::of(run, finest)).collect::<Result<Vec<_>, _>>()?;
    let width = job.choose(480, 32);
    let images = runs
        .iter()
        .map(|run| Ok(views::relief(run, width)?.titled(&format!("{} cells", run.domain.size.columns))));
    let images = images.collect::<Result<Vec<_>, Error>>()?;
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "relief",
            caption: format!("The same country on {}, {} and {} cells a side", sides[0], sides[1], sides[2]),
            image: views::laid_out(&images, sides.len()),
        }],
        measured: Measured {
            header: texts([
                "cells a side",
                "erosion, m",
                "deposition, m",
                "hypsometric integral",
                "deep water, %",
                "channels, km/km²",
                "heights off, % of the relief",
                "channels within two coarse cells, %",
            ]),
            rows: measures.iter().map(Measures::row).collect(),
            remarks: texts([
                "Deep: 1 m and more. Channels drain a two-hundredth of the country, 0.5 km², and are as long as their \
                 cells. Off, and within: from the finest, whose heights are averaged over the coarser cells; two coarse \
                 cells are 80 m.",
            ]),
        },
        claims: claims(&measures),
        ..FigureOutput::default()
    })
}

/// The country on so many cells a side, carved.
fn country(side: usize, sides: &[usize], job: GalleryJob) -> Result<Landscape, Error> {
    let finest = sides.last().map(|&side| Size::square(side)).transpose()?;
    let domain = Domain { finest, ..Domain::new(Size::square(side)?, EXTENT / side as f64) };
    let mut land = Landscape::new(domain);
    let flood = Fluvial {
        duration: job.choose(20_000.0, 200.0),
        flow_time: job.choose(3.0, 0.05),
        levels: 8,
        coarsest: EXTENT / sides[0] as f64,
        ..Fluvial::default()
    };
    let steps: [&dyn Step; 3] = [
        &DiamondSquare { relief: 1600.0, roughness: 0.95, ..DiamondSquare::default() },
        &flood,
        // Channels are counted as in the figures of CORRECTNESS.
        &FlowStep { directions: DirectionRule::Steepest, ..FlowStep::default() },
    ];
    for step in steps {
        step.run(&mut land, &Job::unwatched(SEED))?;
    }
    Ok(land)
}

/// What a country is like, and how far from the finest.
struct Measures {
    side: usize,
    erosion: f64,
    deposition: f64,
    hypsometric_integral: f64,
    deep: f64,
    /// Channels in km/km².
    density: f64,
    /// Root mean square of the differences of heights, as a share of the relief.
    off: f64,
    /// Share of the channels of each that have one of the other within two coarse cells; the smaller of both.
    near: f64,
}

impl Measures {
    fn of(land: &Landscape, finest: &Landscape) -> Result<Self, Error> {
        let mean = |name: &str| Ok::<f64, Error>(mean(land.field(name)?));
        let height = land.field("height")?;
        let (low, high) = height.range(None).unwrap_or_default();
        let water = land.field("water")?;
        let deep = water.values().iter().filter(|&&depth| depth > DEEP).count();
        let [own, others] = [channels(land)?, channels(finest)?];
        let length = own.len() as f64 * land.domain.cell;
        Ok(Self {
            side: land.domain.size.columns,
            erosion: mean("erosion")?,
            deposition: mean("deposition")?,
            hypsometric_integral: (mean("height")? - f64::from(low)) / f64::from(high - low),
            deep: deep as f64 / water.size().cells() as f64,
            density: length / (EXTENT * EXTENT) * 1000.0,
            off: off(height, finest.field("height")?),
            near: near(&own, &others).min(near(&others, &own)),
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.side.to_string(),
            format!("{:.1}", self.erosion),
            format!("{:.2}", self.deposition),
            format!("{:.3}", self.hypsometric_integral),
            format!("{:.3}", 100.0 * self.deep),
            format!("{:.2}", self.density),
            format!("{:.2}", 100.0 * self.off),
            format!("{:.0}", 100.0 * self.near),
        ]
    }
}

fn mean(field: &Field) -> f64 {
    field.sum() / field.size().cells() as f64
}

fn off(height: &Field, finest: &Field) -> f64 {
    let every = finest.size().columns / height.size().columns;
    let relief = finest.range(None).map_or(1.0, |(low, high)| f64::from(high - low));
    let squares = height.values().iter().enumerate().map(|(at, &own)| {
        let (x, y) = (at % height.size().columns * every, at / height.size().columns * every);
        let cells = (0..every * every).map(|cell| finest.at(x + cell % every, y + cell / every));
        let mean = cells.map(f64::from).sum::<f64>() / (every * every) as f64;
        (mean - f64::from(own)).powi(2)
    });
    (squares.sum::<f64>() / height.size().cells() as f64).sqrt() / relief
}

/// Middles of the channels' cells in metres.
fn channels(land: &Landscape) -> Result<Vec<[f64; 2]>, Error> {
    let area = land.field("accumulation")?;
    let least = (CHANNEL * EXTENT * EXTENT) as f32;
    let columns = area.size().columns;
    let middle = |at: usize| [at % columns, at / columns].map(|cell| (cell as f64 + 0.5) * land.domain.cell);
    let cells = area.values().iter().enumerate().filter(|&(_, &area)| area >= least);
    Ok(cells.map(|(at, _)| middle(at)).collect())
}

/// Share of the points within two coarse cells, 80 m, of one of the others.
fn near(points: &[[f64; 2]], others: &[[f64; 2]]) -> f64 {
    const FAR: f64 = EXTENT / 128.0;
    let close = |point: &&[f64; 2]| {
        others
            .iter()
            .any(|other| (0..2).map(|axis| (point[axis] - other[axis]).powi(2)).sum::<f64>() <= FAR * FAR)
    };
    points.iter().filter(close).count() as f64 / points.len().max(1) as f64
}

fn claims(measures: &[Measures]) -> Vec<Claim> {
    let finest = measures.last().expect("there are sizes");
    let shown = |number: fn(&Measures) -> f64, decimals: usize| {
        let numbers: Vec<String> = measures.iter().map(|one| format!("{:.decimals$}", number(one))).collect();
        numbers.join(", ")
    };
    let within = |number: fn(&Measures) -> f64, share: f64| {
        measures.iter().all(|one| (number(one) / number(finest) - 1.0).abs() <= share)
    };
    let even = within(|one| one.erosion, 0.05) && within(|one| one.deposition, 0.05);
    let form =
        measures.iter().all(|one| (one.hypsometric_integral - finest.hypsometric_integral).abs() <= 0.01);
    let same = measures.iter().all(|one| one.off <= 0.005 && one.near >= 0.95);
    vec![
        Claim::new(
            "On more cells as much is carved and laid down, within a twentieth",
            Verdict::of(even),
            format!(
                "erosion {} m, deposition {} m",
                shown(|one| one.erosion, 1),
                shown(|one| one.deposition, 2)
            ),
        ),
        Claim::new(
            "The hypsometric integral is the same within a hundredth",
            Verdict::of(form),
            shown(|one| one.hypsometric_integral, 3),
        ),
        Claim::new(
            "Heights differ by half a hundredth of the relief at most, and channels lie within two coarse cells",
            Verdict::of(same),
            format!(
                "{} % of the relief, {} % of the channels",
                shown(|one| 100.0 * one.off, 2),
                shown(|one| 100.0 * one.near, 0)
            ),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_field_of_the_same_means_is_not_off_and_a_raised_one_is() {
        let fine = Field::from_values(Size::square(2).expect("small"), vec![0.0, 4.0, 8.0, 12.0]);
        let coarse = |value| Field::from_values(Size::square(1).expect("small"), vec![value]);
        assert_eq!(off(&coarse(6.0), &fine), 0.0);
        assert_eq!(off(&coarse(9.0), &fine), 0.25);
    }

    #[test]
    fn channels_are_near_up_to_two_coarse_cells() {
        let [here, near_by, far] = [[0.0, 0.0], [0.0, 80.0], [80.0, 80.0]];
        assert_eq!(near(&[here], &[near_by]), 1.0);
        assert_eq!(near(&[here, near_by], &[far]), 0.5);
    }
}
