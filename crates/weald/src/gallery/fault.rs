//! Fault formation: one long run, looked at after 1, 2, 3, 10, 100 and all faults.
//!
//! The fault step draws whole runs, and the size of a fault, `scale (1 - i/n)`, depends on the length n of
//! its run. A stage follows from two short runs over the same lines: with `A = Σ ±1` and `B = Σ ±i` over the
//! first k faults, the run of k is `scale (A - B/k)` and the run of k + 1 is `scale (A - B/(k+1))`, since the
//! last fault of a run has size 0. Both give A and B, and the stage of a run of n is `scale (A - B/n)`.

use super::{Figure, FigureOutput, GalleryJob, Measured, Plate, run_steps};
use crate::domain::Domain;
use crate::error::Error;
use crate::grid::{Field, Size};
use crate::landscape::Landscape;
use crate::picture::{Image, Picture, Relief, Tint};

pub(super) const FIGURE: Figure = Figure {
    id: "fault",
    title: "Fault formation",
    source: "Fault formation as taught for game terrain (OGLDEV); the shrinking steps are those of its code",
    shows: "Random lines cut the map; one side rises, the other sinks, by steps that shrink to 0. A single \
            fault is a cliff, a few make plateaus, many make hills.",
    make,
};

const SEED: u64 = 7;

/// Height of the first step, in cells.
const SCALE: f64 = 10.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (side, faults) = job.choose((256, 400), (32, 20));
    let mut images = Vec::new();
    let mut rows = Vec::new();
    for stage in [1, 2, 3, 10, faults / 4, faults] {
        let height = stage_of(side, stage, faults)?;
        rows.push(row(stage, &height));
        images.push(draw(height)?);
    }
    let caption = format!("One run of {faults} faults after 1, 2, 3, 10, {} and all of them", faults / 4);
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "stages",
            caption,
            image: Image::below(&[Image::beside(&images[..3], 8), Image::beside(&images[3..], 8)], 8),
        }],
        measured: Measured {
            header: ["faults", "plateaus", "lines allow", "lowest", "highest"].map(str::to_owned).to_vec(),
            rows,
            remarks: vec![
                "Plateaus are distinct heights; n lines cut a plane into at most 1 + n + n(n-1)/2 parts."
                    .to_owned(),
            ],
        },
    })
}

fn run(side: usize, faults: u32) -> Result<Field, Error> {
    let mut landscape = Landscape::new(Domain::new(Size::square(side)?, 1.0));
    run_steps(&mut landscape, SEED, &[("fault", &format!("iterations = {faults}\nscale = {SCALE:?}"))])?;
    landscape.field("height").cloned()
}

/// Heights after `stage` faults of a run of `faults`.
fn stage_of(side: usize, stage: u32, faults: u32) -> Result<Field, Error> {
    if stage == faults {
        return run(side, faults);
    }
    let (shorter, longer) = (run(side, stage)?, run(side, stage + 1)?);
    let k = f64::from(stage);
    let combined = |(&shorter, &longer): (&f32, &f32)| {
        let (shorter, longer) = (f64::from(shorter), f64::from(longer));
        let b = (longer - shorter) * k * (k + 1.0);
        let a = shorter + b / k;
        (a - b / f64::from(faults)) as f32
    };
    let heights = shorter.values().iter().zip(longer.values()).map(combined).collect();
    Ok(Field::from_values(shorter.size(), heights))
}

/// Heights closer than this are one plateau, in cells: stages are computed in single precision.
const SAME: f32 = 1e-3;

fn row(stage: u32, height: &Field) -> Vec<String> {
    let mut sorted = height.values().to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let plateaus = 1 + sorted.windows(2).filter(|pair| pair[1] - pair[0] > SAME).count();
    let most = 1 + u64::from(stage) + u64::from(stage) * u64::from(stage - 1) / 2;
    let (low, high) = height.range(None).unwrap_or((0.0, 0.0));
    vec![stage.to_string(), plateaus.to_string(), most.to_string(), format!("{low:.1}"), format!("{high:.1}")]
}

fn draw(height: Field) -> Result<Image, Error> {
    let mut landscape = Landscape::new(Domain::new(height.size(), 1.0));
    landscape.insert("height", "m", height);
    Relief { width: Some(512), ramp: Tint::Alpine, contours: Some(0.0), ..Relief::default() }
        .render(&landscape)
}
