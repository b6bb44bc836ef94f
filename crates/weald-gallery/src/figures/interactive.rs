//! How fast layered ground is simulated: the rate at which it can be edited.

use std::time::Instant;

use super::layered::{SOURCE, ground, material};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts, views};
use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::generate::fbm::Fbm;

pub(super) const FIGURE: Figure = Figure {
    id: "interactive",
    title: "How fast layered ground is simulated",
    source: SOURCE,
    shows: "Steps of the whole model a second, with rain, on four materials. The source draws each step and reaches 20 \
            a second on its graphics card.",
    seconds: 30,
    make: Make::Alone(make),
};

/// Steps a second in the source.
const SOURCE_RATE: f64 = 20.0;

/// Materials on the rock, each a metre thick.
const COVER: [&str; 3] = ["clay", "gravel", "soil"];

/// What the whole model does in each step.
const KEYS: &str = "model = \"stava\"\nboundary = \"open\"\nrain = 0.001\nevaporation = 0.0005\nslippage = {}\n\
    dissolution = {}\n";

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let size = job.choose(Size::new(2048, 1024)?, Size::new(32, 16)?);
    let start = layers(size)?;
    // The first run finds its memory.
    after(&start, 1)?;
    let few = after(&start, 1)?;
    let many = after(&start, 1 + STEPS)?;
    let rate = f64::from(STEPS) / (many.1 - few.1).max(1e-9);
    let threads = rayon::current_num_threads();
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "ground",
            caption: "The ground of four materials".to_owned(),
            image: views::bare(&many.0, job.choose(480, 32))?,
        }],
        measured: Measured {
            header: texts(["cells", "materials", "steps/s here", "in the source"]),
            rows: vec![vec![
                format!("{} × {}", size.columns, size.rows),
                (COVER.len() + 1).to_string(),
                format!("{rate:.2}"),
                format!("{SOURCE_RATE:.0}"),
            ]],
            remarks: vec![format!(
                "On the CPU with {threads} threads, without drawing, by the time of {STEPS} steps more; rates differ from \
                 run to run."
            )],
        },
        claims: vec![Claim::new(
            "2048 × 1024 cells of four materials run at 20 steps a second",
            Verdict::of(rate >= SOURCE_RATE),
            format!("{rate:.2} steps a second on the CPU with {threads} threads"),
        )],
        ..FigureOutput::default()
    })
}

/// Steps that are timed.
const STEPS: u32 = 40;

/// Hills of rock under three layers.
fn layers(size: Size) -> Result<Landscape, Error> {
    let mut hills = Landscape::new(Domain::new(size, 2.0));
    Fbm { relief: 300.0, wavelength: 900.0, ..Fbm::default() }.run(&mut hills, &Job::unwatched(1))?;
    let materials = ["rock"].into_iter().chain(COVER).map(|name| material(name, name)).collect();
    let mut start = ground(hills.field("height")?.clone(), 2.0, materials);
    for name in COVER {
        start.insert(name, "m", Field::filled(size, 1.0));
    }
    Ok(start)
}

/// The ground after so many steps, and the seconds that they took with all that goes before and after them.
fn after(start: &Landscape, iterations: u32) -> Result<(Landscape, f64), Error> {
    let mut landscape = start.clone();
    let begun = Instant::now();
    run_steps(&mut landscape, 0, &[("hydraulic", &format!("{KEYS}iterations = {iterations}\n"))])?;
    Ok((landscape, begun.elapsed().as_secs_f64()))
}
