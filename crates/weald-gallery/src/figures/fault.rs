//! Fault formation: one long run, looked at after 1, 2, 3, 10, 100 and all faults.
//!
//! The fault step draws whole runs, and the size of a fault, `scale (1 - i/n)`, depends on the length n of
//! its run. A stage follows from two short runs over the same lines: with `A = Σ ±1` and `B = Σ ±i` over the
//! first k faults, the run of k is `scale (A - B/k)` and the run of k + 1 is `scale (A - B/(k+1))`, since the
//! last fault of a run has size 0. Both give A and B, and the stage of a run of n is `scale (A - B/n)`.

use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_picture::{Image, Picture, Relief, Tint};

pub(super) const FIGURE: Figure = Figure {
    id: "fault",
    title: "Fault formation",
    source: "Fault formation as taught for game terrain (OGLDEV); the shrinking steps are those of its code",
    shows: "Random lines cut the map; one side rises, the other sinks, by steps that shrink to 0. A single \
            fault is a cliff, a few make plateaus, many make hills.",
    seconds: 1,
    make: Make::Alone(make),
};

const SEED: u64 = 7;

/// Height of the first step, in cells.
const SCALE: f64 = 10.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (side, faults) = job.choose((256, 400), (32, 20));
    let mut images = Vec::new();
    let mut stages = Vec::new();
    for stage in [1, 2, 3, 10, faults / 4, faults] {
        let height = stage_of(side, stage, faults)?;
        stages.push(Stage::of(stage, &height));
        images.push(draw(height)?);
    }
    let caption = format!("One run of {faults} faults after 1, 2, 3, 10, {} and all of them", faults / 4);
    let image = Image::below(&[Image::beside(&images[..3], 8), Image::beside(&images[3..], 8)], 8);
    Ok(FigureOutput {
        plates: vec![Plate { name: "stages", caption, image }],
        measured: Measured {
            header: texts(["faults", "plateaus", "lines allow", "lowest", "highest"]),
            rows: stages.iter().map(Stage::row).collect(),
            remarks: texts([
                "Plateaus are distinct heights; n lines cut a plane into at most 1 + n + n(n-1)/2 parts.",
            ]),
        },
        claims: claims(&stages),
        ..FigureOutput::default()
    })
}

fn claims(stages: &[Stage]) -> Vec<Claim> {
    let [first, third, last] = [&stages[0], &stages[2], &stages[stages.len() - 1]];
    let allowed = stages.iter().all(|stage| stage.plateaus as u64 <= stage.most());
    vec![Claim::new(
        "A single fault is a cliff, a few make plateaus, many make hills",
        Verdict::of(
            allowed && first.plateaus == 2 && third.plateaus > 2 && last.plateaus > 50 * third.plateaus,
        ),
        format!(
            "{} heights after one fault, {} after three, {} after {}; never more than the lines allow",
            first.plateaus, third.plateaus, last.plateaus, last.faults
        ),
    )]
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

/// The ground after some of the faults.
struct Stage {
    faults: u32,
    plateaus: usize,
    low: f32,
    high: f32,
}

impl Stage {
    fn of(faults: u32, height: &Field) -> Self {
        let mut sorted = height.values().to_vec();
        sorted.sort_unstable_by(f32::total_cmp);
        let plateaus = 1 + sorted.windows(2).filter(|pair| pair[1] - pair[0] > SAME).count();
        let (low, high) = height.range(None).unwrap_or((0.0, 0.0));
        Self { faults, plateaus, low, high }
    }

    /// Parts into which the lines can cut a plane.
    fn most(&self) -> u64 {
        let lines = u64::from(self.faults);
        1 + lines + lines * (lines - 1) / 2
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.faults.to_string(),
            self.plateaus.to_string(),
            self.most().to_string(),
            format!("{:.1}", self.low),
            format!("{:.1}", self.high),
        ]
    }
}

fn draw(height: Field) -> Result<Image, Error> {
    let mut landscape = Landscape::new(Domain::new(height.size(), 1.0));
    landscape.insert("height", "m", height);
    Relief { width: Some(512), ramp: Tint::Alpine, contours: Some(0.0), ..Relief::default() }
        .render(&landscape)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_fault_has_no_step_so_that_the_stage_before_it_is_the_whole_run() {
        let [before, whole] = [4, 5].map(|stage| stage_of(16, stage, 5).expect("runs"));
        for (before, whole) in before.values().iter().zip(whole.values()) {
            assert!((before - whole).abs() < 1e-3, "{before} and {whole}");
        }
        let first = Stage::of(1, &stage_of(16, 1, 5).expect("runs"));
        assert_eq!((first.plateaus, first.most()), (2, 2));
    }
}
