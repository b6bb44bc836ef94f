//! `weald-mpi bench`: what ranks do here, beside the model of it, and what the model says of larger grids.

use std::fmt::Write;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use weald::engine::Engine;
use weald::engine::ranks::{Counting, Ranks, Swap};
use weald::recipe::{Options, Overrides, Progress, Recipe, Run, StepReport, take_part};
use weald::{Error, Landscape};

use crate::arguments::BenchArguments;
use crate::scaling::{Machine, StepTime, Traffic, step_time};

/// How many rows off a cell of `han` and `mei` feels others in a step.
const REACH: f64 = 4.0;

/// Planes of state that change.
const HAN_PLANES: f64 = 5.0;
const MEI_PLANES: f64 = 7.0;

/// Steps between two exchanges where nothing was measured.
const BLOCK: f64 = 4.0;

/// Bytes of a short message and of a long one.
const SHORT: usize = 8;
const LONG: usize = 8 << 20;

/// Runs of each length, of which the fastest counts: others on the machine only make them slower.
const RUNS: usize = 3;

/// How often runs are made twice as long, until other work on the machine hides their difference no more.
const ROUNDS: u32 = 8;

/// What the longer of two runs, of twice the steps, takes at least, by the shorter. Steps alone would make it 2; less of
/// it than a quarter more is start and end, or other work on the machine.
const LONGER: f64 = 1.25;

/// Numbers of ranks for which the model is printed.
const RANKS: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];

/// Seconds of the last step of a run.
#[derive(Default)]
struct Watch(Mutex<f64>);

impl Progress for Watch {
    fn made(&self, _: &Landscape, steps: &[StepReport]) {
        if let (Some(step), Ok(mut seconds)) = (steps.last(), self.0.lock()) {
            *seconds = step.seconds;
        }
    }
}

/// Measures, and prints on the first rank. All ranks take part.
///
/// # Errors
/// Those of a run.
pub(crate) fn bench(arguments: &BenchArguments, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    let alone = if ranks.leads() { measure(arguments, &Engine::Cpu, None)?.seconds } else { 0.0 };
    let [latency, bandwidth] = messages(ranks.as_ref())?;
    let counting = Arc::new(Counting::new(Arc::clone(ranks)));
    let all: Arc<dyn Ranks> = Arc::<Counting>::clone(&counting);
    let together = if ranks.leads() {
        measure(arguments, &Engine::Ranks(Arc::clone(&all)), Some(&all))?
    } else {
        follow(arguments, &all)?;
        Measured::default()
    };
    if ranks.leads() {
        let cells = (arguments.size * arguments.size) as f64;
        let machine = Machine { rate: cells / alone, latency, bandwidth };
        let (traffic, sent) = traffic(arguments, &counting, together.steps);
        if ranks.count() > 1 {
            print!(
                "{}",
                beside(arguments, ranks.count(), (machine, traffic), (together.seconds, sent, &counting))
            );
        }
        print!("{}", larger(arguments, machine, traffic));
    }
    Ok(())
}

fn recipe(arguments: &BenchArguments, steps: u32) -> Result<Recipe, Error> {
    let BenchArguments { size, model, .. } = arguments;
    let text = format!(
        "[landscape]\nsize = {size}\ncell = 10.0\n[[step]]\ndo = \"diamond-square\"\nrelief = 300.0\n[[step]]\ndo = \
         \"hydraulic\"\nmodel = {model:?}\niterations = {steps}\n[[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n"
    );
    Recipe::parse("bench.toml", &text, &Overrides::default())
}

/// What a step takes, and how many steps were run to find it.
#[derive(Clone, Copy, Default)]
struct Measured {
    seconds: f64,
    steps: f64,
}

/// What a step takes: the difference of a run of so many and one of twice as many, so that start and end do not count. Runs
/// become longer until there is a difference, and the other ranks are told each time whether there is.
fn measure(
    arguments: &BenchArguments,
    engine: &Engine,
    others: Option<&Arc<dyn Ranks>>,
) -> Result<Measured, Error> {
    let mut run = 0.0;
    for steps in rounds(arguments) {
        let (short, long) = (fastest(arguments, steps, engine)?, fastest(arguments, 2 * steps, engine)?);
        run += f64::from(3 * steps) * RUNS as f64;
        let is_measured = long > LONGER * short;
        if let Some(ranks) = others {
            ranks.tell(vec![u8::from(is_measured)])?;
        }
        if is_measured {
            return Ok(Measured { seconds: (long - short) / f64::from(steps), steps: run });
        }
    }
    let steps = arguments.steps << ROUNDS;
    Err(Error::Run(format!(
        "{steps} steps took less than {LONGER} times as long as half as many on this busy machine; a larger `--steps` or \
         `--size` can be measured"
    )))
}

/// What the other ranks do while the first measures.
fn follow(arguments: &BenchArguments, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    for steps in rounds(arguments) {
        for steps in [steps, 2 * steps] {
            for _ in 0..RUNS {
                take_part(&recipe(arguments, steps)?, ranks)?;
            }
        }
        if ranks.tell(Vec::new())? == [u8::from(true)] {
            break;
        }
    }
    Ok(())
}

/// Steps of the shorter run of each round.
fn rounds(arguments: &BenchArguments) -> impl Iterator<Item = u32> {
    let steps = arguments.steps;
    (0..ROUNDS).map(move |round| steps << round)
}

/// Seconds of the fastest of some runs.
fn fastest(arguments: &BenchArguments, steps: u32, engine: &Engine) -> Result<f64, Error> {
    let mut fastest = f64::INFINITY;
    for _ in 0..RUNS {
        let (recipe, watch) = (recipe(arguments, steps)?, Watch::default());
        let folder = std::env::temp_dir().join(format!("weald-mpi-bench-{}", std::process::id()));
        let options = Options { engine: engine.clone(), ..Options::into_folder(&folder) };
        let done = Run { recipe: &recipe, options }.landscape(&watch);
        // The folder holds nothing but a lock that has gone; that it cannot be removed is no fault of the measurement.
        let _ = std::fs::remove_dir_all(&folder);
        done?;
        fastest = fastest.min(watch.0.into_inner().unwrap_or(f64::INFINITY));
    }
    Ok(fastest)
}

/// Seconds of a short message, and bytes per second of long ones, between the first two ranks; a rank alone has no messages.
fn messages(ranks: &dyn Ranks) -> Result<[f64; 2], Error> {
    let (rank, count) = (ranks.rank(), ranks.count());
    let once = |bytes: usize, times: u32| -> Result<f64, Error> {
        let give = vec![0.0_f32; bytes / size_of::<f32>()];
        let mut take = give.clone();
        let started = Instant::now();
        for _ in 0..times {
            let with = 1 - rank.min(1);
            let swap = Swap { with, give: &give, take: &mut take };
            if count > 1 && rank < 2 {
                ranks.swap(&mut [swap])?;
            }
        }
        Ok(started.elapsed().as_secs_f64() / f64::from(times))
    };
    if count == 1 {
        return Ok([0.0, f64::INFINITY]);
    }
    once(SHORT, 100)?;
    let latency = once(SHORT, 2000)?;
    Ok([latency, LONG as f64 / once(LONG, 30)?])
}

/// What the model asks of messages, and the bytes that were really sent a step and neighbour in all runs together. The
/// first rank has one neighbour.
fn traffic(arguments: &BenchArguments, counting: &Counting, steps: f64) -> (Traffic, f64) {
    let [exchanges, bytes] = [counting.exchanges(), counting.bytes()].map(|count| count as f64);
    let block = if exchanges > 0.0 { steps / exchanges } else { BLOCK };
    let planes = if arguments.model == "han" { HAN_PLANES } else { MEI_PLANES };
    let values = planes * (REACH * block + 1.0) / block;
    (Traffic { reach: REACH, block, bytes: size_of::<f32>() as f64 * values }, bytes / steps)
}

/// What was measured, and what the model says of it.
fn beside(
    arguments: &BenchArguments,
    count: usize,
    (machine, traffic): (Machine, Traffic),
    (together, sent, counting): (f64, f64, &Counting),
) -> String {
    let BenchArguments { size, model, .. } = arguments;
    let (alone, threads) = ((size * size) as f64 / machine.rate, rayon::current_num_threads());
    let predicted = step_time(machine, traffic, [*size as f64; 2], count).seconds();
    let mut text = format!("`{model}` on {size} × {size} cells, {count} ranks of {threads} threads\n");
    let million = machine.rate / 1e6;
    let _ = writeln!(text, "one rank alone      {alone:.6} s a step, {million:.0} million cells a second");
    let _ = writeln!(
        text,
        "messages            {:.1} µs, {:.2} GB/s; {:.1} kB a step and neighbour ({:.1} by the formula), exchanged every \
         {:.1} steps",
        machine.latency * 1e6,
        machine.bandwidth / 1e9,
        sent / 1e3,
        traffic.bytes * *size as f64 / 1e3,
        traffic.block
    );
    let faster = alone / together;
    let _ = writeln!(text, "all ranks, measured {together:.6} s a step, {faster:.2} times as fast as one");
    let (aside, all) = (counting.aside(), counting.exchanges());
    let _ = writeln!(text, "inside first        in {aside} of {all} exchanges of the first rank");
    let ratio = predicted / together;
    let _ = writeln!(text, "all ranks, model    {predicted:.6} s a step: {ratio:.2} of what was measured\n");
    text
}

/// What the model says of a larger grid.
fn larger(arguments: &BenchArguments, machine: Machine, traffic: Traffic) -> String {
    let BenchArguments { larger, latency, bandwidth, .. } = arguments;
    let machine = Machine {
        latency: latency.map_or(machine.latency, |microseconds| microseconds * 1e-6),
        bandwidth: bandwidth.map_or(machine.bandwidth, |gigabytes| gigabytes * 1e9),
        ..machine
    };
    let mut text = format!(
        "model of {larger} × {larger} cells, ranks as fast as the one here ({:.0} million cells a second), messages of \
         {:.1} µs and {:.2} GB/s\n{:>6} {:>12} {:>12} {:>12} {:>9}\n",
        machine.rate / 1e6,
        machine.latency * 1e6,
        machine.bandwidth / 1e9,
        "ranks",
        "s a step",
        "computing",
        "messages",
        "speed-up"
    );
    let time = |ranks: usize| step_time(machine, traffic, [*larger as f64; 2], ranks);
    for ranks in RANKS {
        let step = time(ranks);
        let (seconds, speed_up) = (step.seconds(), time(1).seconds() / step.seconds());
        let StepTime { computing, messages } = step;
        let _ =
            writeln!(text, "{ranks:>6} {seconds:>12.6} {computing:>12.6} {messages:>12.6} {speed_up:>9.2}");
    }
    text
}
