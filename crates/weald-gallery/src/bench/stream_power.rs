//! The rate of ranges that rise: steps of time of `stream-power`, from low hills full of pits.

use super::rate::{Baseline, RUNS, Rate};
use std::time::Instant;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::generator::Generator;
use weald_engine::step::Step;
use weald_land::erode::stream_power_step::StreamPower;
use weald_land::generate::fbm::Fbm;

/// Steps of time in a run, of which the first has the most lakes.
const STEPS: u32 = 10;

/// Bytes per cell that the passes of a step read and write: receivers 32, basins 12, saddles 12, levels 12, order and areas
/// 35, power 16, uplift 21, incision 48, settling 64, sums 16, creep 17. Rows that stay in the cache count once.
const BYTES: usize = 285;

/// Comparisons, additions, multiplications and divisions a cell, of which the slopes to eight neighbours are half.
const OPERATIONS: usize = 110;

/// Million cells a second that a step of time is asked for on one thread.
const TARGET_RATE: f64 = 8.0;

pub(super) fn stream_power(
    size: Size,
    bandwidth: f64,
    report: &mut (dyn FnMut(&Rate) + Send),
) -> Result<(), Error> {
    let mut start = Landscape::new(Domain::new(size, 100.0));
    let ground = Fbm { relief: 50.0, ..Fbm::default() };
    start.insert("height", "m", ground.fill(&start.domain, 7)?);
    let years = 50_000.0;
    let duration = years * f64::from(STEPS);
    let step = StreamPower { duration, time_step: Some(years), ..StreamPower::default() };
    let mut seconds = f64::INFINITY;
    for _ in 0..RUNS {
        let mut landscape = start.clone();
        let begun = Instant::now();
        step.run(&mut landscape, &Job::unwatched(7))?;
        seconds = seconds.min(begun.elapsed().as_secs_f64());
    }
    let millions = size.cells() as f64 * f64::from(STEPS) / seconds / 1e6;
    let beside = Baseline::Memory { bytes: BYTES, operations: OPERATIONS, bandwidth, aim: TARGET_RATE };
    let threads = Some(rayon::current_num_threads());
    report(&Rate { name: "stream-power".to_owned(), size, threads, millions, beside });
    Ok(())
}
