//! What is measured, beside what it is compared with, and how.

use std::time::Instant;

use rayon::prelude::*;

use weald_core::grid::Size;

/// Runs of which the best counts.
pub(super) const RUNS: usize = 3;

/// One line of the bench.
#[derive(Clone, Debug, PartialEq)]
pub struct Rate {
    /// What ran.
    pub name: String,
    /// Columns and rows.
    pub size: Size,
    /// Threads; none on a device.
    pub threads: Option<usize>,
    /// Million cells, or cell-steps, a second.
    pub millions: f64,
    /// What it is compared with.
    pub beside: Baseline,
}

/// What a rate is compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Baseline {
    /// The rate at which memory could feed one step after another, without blocking in time.
    Memory {
        /// Fewest bytes a cell-step: every state plane read and written, every constant plane read.
        bytes: usize,
        /// Additions, multiplications, divisions, roots and comparisons a cell-step.
        operations: usize,
        /// Bandwidth of reading and writing in place, in bytes per second, with as many threads.
        bandwidth: f64,
        /// Rate to aim for, in million cell-steps a second.
        aim: f64,
    },
    /// The rate at which a device could carry what its passes read and write.
    Copies {
        /// Bytes a cell-step, each buffer of a pass counted once.
        bytes: usize,
        /// Bandwidth of copying within the device's memory, in bytes per second.
        bandwidth: f64,
    },
    /// The rate at which memory could carry what the passes of a method read and write, and a naive version.
    Passes {
        /// Bytes per cell, each array of a pass counted once.
        bytes: usize,
        /// Bandwidth of reading and writing in place, in bytes per second, with as many threads.
        bandwidth: f64,
        /// The naive version, in million cells a second.
        naive: f64,
    },
    /// A naive version, in million cells a second.
    Naive(f64),
    /// Nothing.
    Alone,
}

impl std::fmt::Display for Rate {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, size, threads, millions, .. } = self;
        let size = format!("{} × {}", size.columns, size.rows);
        let threads = threads.map_or("gpu  ".to_owned(), |threads| format!("{threads} thr"));
        write!(out, "{name:<24} {size:>11}  {threads}  {millions:>7.0} M/s")?;
        match self.beside {
            Baseline::Memory { bytes, operations, bandwidth, aim } => {
                let bound = bandwidth / bytes as f64 / 1e6;
                write!(
                    out,
                    "  {bytes} B and {operations} operations a cell-step; {:.0} % of the {bound:.0} M/s that memory \
                     bounds at {:.0} GB/s; {:.2} of the aim of {aim:.0}",
                    100.0 * millions / bound,
                    bandwidth / 1e9,
                    millions / aim,
                )
            }
            Baseline::Copies { bytes, bandwidth } => {
                let bound = bandwidth / bytes as f64 / 1e6;
                let share = 100.0 * millions / bound;
                write!(
                    out,
                    "  {bytes} B a cell-step; {share:.0} % of the {bound:.0} M/s that copying at {:.0} GB/s bounds",
                    bandwidth / 1e9,
                )
            }
            Baseline::Passes { bytes, bandwidth, naive } => {
                let bound = bandwidth / bytes as f64 / 1e6;
                let milliseconds = self.size.cells() as f64 / millions / 1e3;
                write!(
                    out,
                    "  {milliseconds:.0} ms; {bytes} B a cell, {:.0} % of the {bound:.0} M/s that memory bounds at \
                     {:.0} GB/s; {:.0} times the naive {naive:.1} M/s",
                    100.0 * millions / bound,
                    bandwidth / 1e9,
                    millions / naive,
                )
            }
            Baseline::Naive(naive) => write!(out, "  {:.0} times the naive {naive:.1} M/s", millions / naive),
            Baseline::Alone => Ok(()),
        }
    }
}

/// How fast the processor is at this moment: numbers a second that the threads of this pool put through a fixed loop of
/// products, roots and divisions within their caches. Clocks and neighbours on a machine change it from minute to minute.
pub(super) fn pace() -> f64 {
    const VALUES: usize = 4096;
    const ROUNDS: usize = 400;
    const TRIES: usize = 9;
    let threads = rayon::current_num_threads();
    let once = || {
        let started = Instant::now();
        (0..threads).into_par_iter().with_max_len(1).for_each(|thread| {
            let mut values = vec![1.0 + thread as f32; VALUES];
            for _ in 0..ROUNDS {
                for value in &mut values {
                    *value = 0.5 * *value + (*value * *value + 1.0).sqrt() / (*value + 2.0);
                }
            }
            std::hint::black_box(&values);
        });
        started.elapsed().as_secs_f64()
    };
    let seconds = (0..TRIES).map(|_| once()).fold(f64::INFINITY, f64::min);
    (threads * VALUES * ROUNDS) as f64 / seconds
}

/// Bytes per second that the threads of this pool read and write in place, on arrays far beyond the caches.
pub fn bandwidth() -> f64 {
    const VALUES: usize = 32 << 20;
    let mut values = vec![1.0_f32; VALUES];
    let chunk = VALUES.div_ceil(rayon::current_num_threads());
    let seconds = best_seconds(|| {
        values
            .par_chunks_mut(chunk)
            .for_each(|part| part.iter_mut().for_each(|value| *value = *value * 0.5 + 1.0));
    });
    (VALUES * size_of::<f32>() * 2) as f64 / seconds
}

/// Seconds of the fastest of several runs.
pub(super) fn best_seconds(mut work: impl FnMut()) -> f64 {
    let run = |_| {
        let begun = Instant::now();
        work();
        begun.elapsed().as_secs_f64()
    };
    (0..=RUNS).map(run).fold(f64::INFINITY, f64::min)
}
