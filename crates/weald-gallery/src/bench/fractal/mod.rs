//! Points of the fern a second: alone, with their codes, counted into the cells of a picture; beside a naive loop, and
//! beside flam3 where it is installed.

mod flam3;
mod naive;

use std::fmt::{self, Display, Formatter};
use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;

use self::flam3::Flam3;
use super::rate::RUNS;
use weald_core::error::Error;
use weald_plants::ifs::flame::Frame;
use weald_plants::ifs::game::CHUNK;
use weald_plants::ifs::{Code, Game, Histogram, Ifs, Packer, Window, shapes};

/// Columns and rows of the picture.
const SIDE: u32 = 1024;

/// Seconds that a run should take at least.
const SECONDS: f64 = 0.25;

/// Additions and multiplications of floats for a point of the plane.
const FLOPS: usize = 8;

/// Bytes that a point moves: x, y and the map that was taken.
const BYTES: usize = 9;

/// Bytes more for a point that is counted: the number of its cell, written and read, and the cell, read and written.
const CELL_BYTES: usize = 10;

/// One line of the bench of fractals.
#[derive(Clone, Debug, PartialEq)]
pub struct PointRate {
    /// What ran.
    pub name: String,
    /// Threads.
    pub threads: usize,
    /// Million points per second.
    pub millions: f64,
    /// Bytes that a point moves between registers and cache, where they are known.
    pub bytes: Option<usize>,
    /// What it is compared with, and the rates of those in million points per second.
    pub beside: Vec<(&'static str, f64)>,
}

impl Display for PointRate {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, threads, millions, bytes, beside } = self;
        write!(out, "{name:<36}  {threads} thr  {millions:>7.1} M/s")?;
        if let Some(bytes) = bytes {
            let (gigaflops, gigabytes) = (millions * FLOPS as f64 / 1e3, millions * *bytes as f64 / 1e3);
            write!(
                out,
                "  {FLOPS} flops and {bytes} B a point: {gigaflops:.1} Gflop/s, {gigabytes:.1} GB/s"
            )?;
        }
        beside.iter().try_for_each(|(other, rate)| write!(out, "; {:.1} times {other}", millions / rate))
    }
}

/// Measures points of the fern for each thread count, and flam3 on the same fern; `report` is called with each line as
/// it is known.
///
/// # Errors
/// [`Error::Run`] where threads or flam3 cannot be started, or flam3 fails.
pub fn fractals(threads: &[usize], report: &mut (dyn FnMut(&dyn Display) + Send)) -> Result<(), Error> {
    let ifs = shapes::find("fern").expect("built in").ifs();
    let flam3 = Flam3::installed()?;
    let other = flam3
        .as_ref()
        .map_or_else(|| "flam3 is not installed (Debian: flam3-utils)".to_owned(), Flam3::version);
    report(&format!("the fern, Weald {} beside {other}", env!("CARGO_PKG_VERSION")));
    for &count in threads {
        let theirs = flam3.as_ref().map(|flam3| flam3.rate(&ifs, SIDE, count)).transpose()?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {count} threads: {cause}")))?;
        for rate in pool.install(|| ours(&ifs, theirs)) {
            report(&rate);
        }
        if let Some(millions) = theirs {
            let name = "flam3, into 1024², with colours".to_owned();
            report(&PointRate { name, threads: count, millions, bytes: None, beside: Vec::new() });
        }
    }
    Ok(())
}

/// The rates on the threads of this pool.
fn ours(ifs: &Ifs, theirs: Option<f64>) -> Vec<PointRate> {
    let game = Game::new(ifs, 7);
    let threads = rayon::current_num_threads();
    let window = window(ifs);
    let naive = rate(|chunks| each_thread(chunks, |mine| black_box(naive::points(ifs, mine as u64 * CHUNK))));
    let naive_counts =
        rate(|chunks| each_thread(chunks, |mine| black_box(naive::counts(ifs, window, mine as u64 * CHUNK))));
    let alone = rate(|chunks| each_chunk(&game, chunks));
    let coded = rate(|chunks| each_coded_chunk(&game, ifs, chunks));
    let counted = rate(|chunks| drop(black_box(counted(&game, window, chunks))));
    let line = |name: &str, millions, bytes, beside: &[(&'static str, f64)]| PointRate {
        name: name.to_owned(),
        threads,
        millions,
        bytes,
        beside: beside.to_vec(),
    };
    let others: Vec<_> =
        std::iter::once(("naive", naive_counts)).chain(theirs.map(|rate| ("flam3", rate))).collect();
    vec![
        line("naive, points", naive, None, &[]),
        line("naive, into 1024²", naive_counts, None, &[]),
        line("points", alone, Some(BYTES), &[("naive", naive)]),
        line("points with packed codes", coded, Some(BYTES + size_of::<Code>()), &[("naive points", naive)]),
        line("points into 1024²", counted, Some(BYTES + CELL_BYTES), &others),
    ]
}

/// The picture that flam3 draws of it.
fn window(ifs: &Ifs) -> Window {
    let (low, scale) = Frame { size: [SIDE; 2], ..Frame::default() }.window(ifs);
    Window { low: low.map(|x| x as f32), scale: [scale as f32; 2], size: [SIDE; 2] }
}

/// Million points per second of work on so many chunks: as many as take long enough, the best of several runs.
fn rate(work: impl Fn(usize)) -> f64 {
    let seconds = |chunks| {
        let begun = Instant::now();
        work(chunks);
        begun.elapsed().as_secs_f64()
    };
    let mut chunks = rayon::current_num_threads();
    while seconds(chunks) < SECONDS {
        chunks *= 2;
    }
    let best = (0..RUNS).map(|_| seconds(chunks)).fold(f64::INFINITY, f64::min);
    chunks as f64 * CHUNK as f64 / best / 1e6
}

/// Hands each thread as many chunks as the others, or one more.
fn each_thread<R: Send>(chunks: usize, work: impl Fn(usize) -> R + Sync) {
    let threads = rayon::current_num_threads();
    (0..threads).into_par_iter().for_each(|thread| drop(work((chunks + thread) / threads)));
}

fn each_chunk(game: &Game<'_>, chunks: usize) {
    (0..chunks as u64).into_par_iter().for_each(|chunk| {
        game.chunk(chunk, CHUNK, |block| {
            black_box(block.rows());
        });
    });
}

fn each_coded_chunk(game: &Game<'_>, ifs: &Ifs, chunks: usize) {
    (0..chunks as u64).into_par_iter().for_each_init(
        || Packer::of(ifs),
        |packer, chunk| {
            game.chunk(chunk, CHUNK, |block| {
                black_box((block.rows(), packer.pack(block)));
            });
        },
    );
}

/// A histogram for each thread, added at the end.
fn counted(game: &Game<'_>, window: Window, chunks: usize) -> Histogram {
    let threads = rayon::current_num_threads();
    let part = |thread: usize| {
        let mut histogram = Histogram::new(window);
        for chunk in chunks * thread / threads..chunks * (thread + 1) / threads {
            game.chunk(chunk as u64, CHUNK, |block| histogram.count(block));
        }
        histogram
    };
    let parts: Vec<Histogram> = (0..threads).into_par_iter().map(part).collect();
    let mut sum = Histogram::new(window);
    for part in &parts {
        sum.add(part);
    }
    sum
}
