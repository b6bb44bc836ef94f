//! Rates, each beside what limits it: the memory bandwidth of the machine, or a naive version of the method.
//!
//! Figures are the best of several runs, since other work on a machine only ever makes a run slower.

mod calibrate;
mod device;
mod flow;
mod fractal;
mod grass;
mod rate;
mod recipes;
mod record;
mod stream_power;

pub use calibrate::calibrate;
pub use device::run_on;
pub use fractal::{PointRate, fractals};
pub use grass::{GrassRate, grass};
pub use rate::{Baseline, Rate, bandwidth};
pub use recipes::{Measured, recipe};
pub use record::{Record, Records};

use std::time::Instant;

use self::rate::{RUNS, best_seconds};
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

/// Cell-steps of one run: long enough to be steady, short enough to be patient with.
const CELL_STEPS: usize = 250_000_000;

/// Measures erosion and ranges that rise at each size and thread count, then the generators and
/// flow over the ground at the greatest size; `report` is called with each
/// rate as it is known, on the threads that it was measured with.
///
/// # Errors
/// [`Error::Limit`] for sizes that no grid may have, [`Error::Run`] where threads cannot be started.
pub fn run(sides: &[usize], threads: &[usize], report: &mut (dyn FnMut(&Rate) + Send)) -> Result<(), Error> {
    for &count in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {count} threads: {cause}")))?;
        pool.install(|| {
            let bandwidth = bandwidth();
            let report = &mut *report;
            for &side in sides {
                erosion(Size::square(side)?, bandwidth, report)?;
                stream_power::stream_power(Size::square(side)?, bandwidth, report)?;
            }
            let greatest = sides.iter().copied().max().unwrap_or(1024);
            generators(Size::square(greatest)?, report)?;
            flow::flow(Size::square(greatest)?, bandwidth, report)
        })?;
    }
    Ok(())
}

/// A process of the bench with its counts, taken from the kernels by hand.
struct BenchCase {
    name: &'static str,
    step: Hydraulic,
    bytes: usize,
    operations: usize,
    /// Aim in million cell-steps a second and core.
    aim: f64,
}

fn contenders(iterations: u32) -> [BenchCase; 4] {
    let han = Hydraulic { iterations, ..Hydraulic::default() };
    let mei = Hydraulic { model: MeiKeys::default().into(), ..han.clone() };
    let thermal = Some(Nested(ThermalWithin::default()));
    let sliding = HanKeys { thermal, ..HanKeys::default() };
    let semi_lagrangian = MeiKeys { transport: Transport::SemiLagrangian, ..MeiKeys::default() };
    [
        BenchCase { name: "han", step: han.clone(), bytes: 44, operations: 105, aim: 300.0 },
        BenchCase {
            name: "han with thermal",
            step: Hydraulic { model: sliding.into(), ..han },
            bytes: 44,
            operations: 122,
            aim: 300.0,
        },
        BenchCase { name: "mei", step: mei.clone(), bytes: 60, operations: 90, aim: 400.0 },
        BenchCase {
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
        let BenchCase { name, bytes, operations, aim, .. } = contender;
        let beside = Baseline::Memory { bytes, operations, bandwidth, aim: aim * speed_up };
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
    let contenders: [(&str, &dyn Generator, Baseline); 3] = [
        ("fault, 1000 faults", &faults, Baseline::Naive(naive)),
        ("fbm, 5 octaves", &Fbm { octaves: 5, ..Fbm::default() }, Baseline::Alone),
        ("diamond-square", &DiamondSquare::default(), Baseline::Alone),
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
