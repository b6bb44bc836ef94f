//! Rates, each beside what limits it: the memory bandwidth of the machine, or a naive version of the method.
//!
//! Figures are the best of several runs, since other work on a machine only ever makes a run slower.

mod device;
mod flow;
mod fractal;
mod grass;

pub use device::run_on;
pub use fractal::{PointRate, fractals};
pub use grass::{GrassRate, grass};

use std::time::Instant;

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::parameter::Nested;
use weald_engine::Engine;
use weald_engine::generator::Generator;
use weald_land::erode::hydraulic::{HanKeys, Hydraulic, MeiKeys, Transport};
use weald_land::erode::thermal_step::ThermalWithin;
use weald_land::generate::diamond_square::DiamondSquare;
use weald_land::generate::fault::Fault;
use weald_land::generate::fbm::Fbm;

/// Runs of which the best counts.
const RUNS: usize = 3;

/// Cell-steps of one run: long enough to be steady, short enough to be patient with.
const CELL_STEPS: usize = 250_000_000;

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
    pub beside: Beside,
}

/// What a rate is compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Beside {
    /// The rate at which memory could feed one step after another, without blocking in time.
    Memory {
        /// Fewest bytes a cell-step: every state plane read and written, every constant plane read.
        bytes: usize,
        /// Additions, multiplications, divisions, roots and comparisons a cell-step.
        operations: usize,
        /// Bandwidth of reading and writing in place, in bytes a second, with as many threads.
        bandwidth: f64,
        /// Rate to aim for, in million cell-steps a second.
        aim: f64,
    },
    /// The rate at which a device could carry what its passes read and write.
    Copies {
        /// Bytes a cell-step, each buffer of a pass counted once.
        bytes: usize,
        /// Bandwidth of copying within the device's memory, in bytes a second.
        bandwidth: f64,
    },
    /// The rate at which memory could carry what the passes of a method read and write, and a naive version.
    Passes {
        /// Bytes a cell, each array of a pass counted once.
        bytes: usize,
        /// Bandwidth of reading and writing in place, in bytes a second, with as many threads.
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
            Beside::Memory { bytes, operations, bandwidth, aim } => {
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
            Beside::Copies { bytes, bandwidth } => {
                let bound = bandwidth / bytes as f64 / 1e6;
                let share = 100.0 * millions / bound;
                write!(
                    out,
                    "  {bytes} B a cell-step; {share:.0} % of the {bound:.0} M/s that copying at {:.0} GB/s bounds",
                    bandwidth / 1e9,
                )
            }
            Beside::Passes { bytes, bandwidth, naive } => {
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
            Beside::Naive(naive) => write!(out, "  {:.0} times the naive {naive:.1} M/s", millions / naive),
            Beside::Alone => Ok(()),
        }
    }
}

/// Measures erosion at each size and thread count, then the generators and
/// flow over the ground at the greatest size; `report` hears
/// each rate as it is known.
///
/// # Errors
/// [`Error::Limit`] for sizes that no grid may have, [`Error::Run`] where threads cannot be started.
pub fn run(sides: &[usize], threads: &[usize], report: &mut (dyn FnMut(&Rate) + Send)) -> Result<(), Error> {
    for &count in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {count} threads: {cause}")))?;
        pool.install(|| {
            let bandwidth = bandwidth();
            for &side in sides {
                erosion(Size::square(side)?, bandwidth, report)?;
            }
            let greatest = sides.iter().copied().max().unwrap_or(1024);
            generators(Size::square(greatest)?, report)?;
            flow::flow(Size::square(greatest)?, bandwidth, report)
        })?;
    }
    Ok(())
}

/// Bytes a second that the threads of this pool read and write in place, on arrays far beyond the caches.
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

fn best_seconds(mut work: impl FnMut()) -> f64 {
    let run = |_| {
        let begun = Instant::now();
        work();
        begun.elapsed().as_secs_f64()
    };
    (0..=RUNS).map(run).fold(f64::INFINITY, f64::min)
}

/// A process of the bench with its counts, taken from the kernels by hand.
struct Contender {
    name: &'static str,
    step: Hydraulic,
    bytes: usize,
    operations: usize,
    /// Aim in million cell-steps a second and core.
    aim: f64,
}

fn contenders(iterations: u32) -> [Contender; 4] {
    let han = Hydraulic { iterations, ..Hydraulic::default() };
    let mei = Hydraulic { model: MeiKeys::default().into(), ..han.clone() };
    let thermal = Some(Nested(ThermalWithin::default()));
    let sliding = HanKeys { thermal, ..HanKeys::default() };
    let semi_lagrangian = MeiKeys { transport: Transport::SemiLagrangian, ..MeiKeys::default() };
    [
        Contender { name: "han", step: han.clone(), bytes: 44, operations: 105, aim: 300.0 },
        Contender {
            name: "han with thermal",
            step: Hydraulic { model: sliding.into(), ..han },
            bytes: 44,
            operations: 122,
            aim: 300.0,
        },
        Contender { name: "mei", step: mei.clone(), bytes: 60, operations: 90, aim: 400.0 },
        Contender {
            name: "mei, semi-lagrangian",
            step: Hydraulic { model: semi_lagrangian.into(), ..mei },
            bytes: 60,
            operations: 110,
            aim: 400.0,
        },
    ]
}

fn erosion(size: Size, bandwidth: f64, report: &mut (dyn FnMut(&Rate) + Send)) -> Result<(), Error> {
    let iterations = (CELL_STEPS / size.cells()).clamp(16, 2000) as u32;
    let mut landscape = Landscape::new(Domain::new(size, 1.0));
    let ground = DiamondSquare { relief: size.columns as f64 / 5.0, ..DiamondSquare::default() };
    landscape.insert("height", "m", ground.fill(&landscape.domain, 7)?);
    let threads = rayon::current_num_threads();
    // Two threads share the bandwidth of one machine: they are asked for 1.8 times the rate of one.
    let speed_up = 1.0 + 0.8 * (threads as f64 - 1.0);
    for contender in contenders(iterations) {
        let mut seconds = f64::INFINITY;
        for _ in 0..RUNS {
            seconds = seconds.min(contender.step.seconds(&landscape, &Engine::Cpu)?);
        }
        let millions = size.cells() as f64 * f64::from(iterations) / seconds / 1e6;
        let Contender { name, bytes, operations, aim, .. } = contender;
        let beside = Beside::Memory { bytes, operations, bandwidth, aim: aim * speed_up };
        report(&Rate { name: name.to_owned(), size, threads: Some(threads), millions, beside });
    }
    Ok(())
}

fn generators(size: Size, report: &mut (dyn FnMut(&Rate) + Send)) -> Result<(), Error> {
    let domain = Domain::new(size, 1.0);
    let faults = Fault { iterations: 1000, ..Fault::default() };
    let naive = {
        let small = Fault { iterations: 50, ..Fault::default() };
        let begun = Instant::now();
        small.naive(size, 7);
        size.cells() as f64 / (begun.elapsed().as_secs_f64() * 20.0) / 1e6
    };
    let contenders: [(&str, &dyn Generator, Beside); 3] = [
        ("fault, 1000 faults", &faults, Beside::Naive(naive)),
        ("fbm, 5 octaves", &Fbm { octaves: 5, ..Fbm::default() }, Beside::Alone),
        ("diamond-square", &DiamondSquare::default(), Beside::Alone),
    ];
    for (name, generator, beside) in contenders {
        let mut failed = None;
        let seconds = best_seconds(|| failed = generator.fill(&domain, 7).err());
        if let Some(error) = failed {
            return Err(error);
        }
        let (threads, millions) = (Some(rayon::current_num_threads()), size.cells() as f64 / seconds / 1e6);
        report(&Rate { name: name.to_owned(), size, threads, millions, beside });
    }
    Ok(())
}
