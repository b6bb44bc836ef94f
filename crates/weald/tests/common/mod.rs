//! Ground and runs that several tests share.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its own part")]

use weald::engine::{Engine, Job, Unwatched};
use weald::erode::hydraulic::Hydraulic;
use weald::random::signed2;
use weald::step::{Outcome, Step};
use weald::{Domain, Field, Landscape, Size};

/// Rough ground with valleys and pits: five octaves of smoothed random values, `relief` high.
pub fn rough(columns: usize, rows: usize, relief: f32, seed: u64) -> Field {
    let size = Size::new(columns, rows).expect("a small size");
    let octave = |x: usize, y: usize, spacing: usize| {
        let (cx, cy) = (x / spacing, y / spacing);
        let (fx, fy) = ((x % spacing) as f64 / spacing as f64, (y % spacing) as f64 / spacing as f64);
        let corner = |dx, dy| signed2(seed + spacing as u64, (cx + dx) as i64, (cy + dy) as i64);
        let (top, bottom) =
            (corner(0, 0) * (1.0 - fx) + corner(1, 0) * fx, corner(0, 1) * (1.0 - fx) + corner(1, 1) * fx);
        (top * (1.0 - fy) + bottom * fy) * spacing as f64
    };
    let height = |x, y| [32, 16, 8, 4, 1].iter().map(|&spacing| octave(x, y, spacing)).sum::<f64>();
    let raw = Field::from_function(size, |x, y| height(x, y) as f32);
    let (low, high) = raw.range(None).expect("cells");
    Field::from_function(size, |x, y| (raw.at(x, y) - low) / (high - low) * relief)
}

/// A landscape with cells of one metre.
pub fn landscape(height: Field) -> Landscape {
    let mut landscape = Landscape::new(Domain::new(height.size(), 1.0));
    landscape.insert("height", "m", height);
    landscape
}

/// Runs a step on an engine.
pub fn run_on(step: &dyn Step, landscape: &mut Landscape, engine: Engine) -> Outcome {
    let job = Job { seed: 7, engine, watcher: &Unwatched, resume: None };
    step.run(landscape, &job).expect("the step runs")
}

/// Runs a step on the CPU.
pub fn run(step: &dyn Step, landscape: &mut Landscape) -> Outcome {
    run_on(step, landscape, Engine::Cpu)
}

/// `hydraulic` with defaults but for its length.
pub fn hydraulic(iterations: u32) -> Hydraulic {
    Hydraulic { iterations, ..Hydraulic::default() }
}

/// Greatest difference of two fields.
pub fn worst_difference(a: &Field, b: &Field) -> f32 {
    a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}
