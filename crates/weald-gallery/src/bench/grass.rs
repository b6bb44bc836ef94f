//! Sets of grass a second, from maps to the bytes that a device is given, beside a naive loop; and vertices of blades.

use std::fmt::{self, Display, Formatter};
use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;

use super::rate::RUNS;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::random::{hash2, unit};
use weald_plants::grass::{BLADES, Bend, Blade, Instance, LEVELS, Maps, Meadow, SPECIES, Set, blade};

/// Cells of the maps along a side, of a metre each.
const SIDE: usize = 256;

/// Sets on a square metre where grass is densest.
const DENSEST: f64 = 60.0;

/// Sets whose vertices are made in a run.
const GROWN: usize = 20_000;

/// Additions, multiplications and divisions of floats for a set: its place, three bilinear values, and their rounding.
const SET_FLOPS: usize = 70;

/// Bytes that a set moves: four cells of three maps read, mostly from the cache, and itself written.
const SET_BYTES: usize = 3 * 4 * 4 + 16;

/// The same for a vertex: seven interpolations of points for the stem, then its width, place and normal.
const VERTEX_FLOPS: usize = 85;

/// Bytes of a vertex.
const VERTEX_BYTES: usize = 36;

/// Million sets per second that are aimed for.
const TARGET_RATE: f64 = 10.0;

/// One line of the bench of grass.
#[derive(Clone, Debug, PartialEq)]
pub struct GrassRate {
    /// What was made.
    pub name: &'static str,
    /// Threads.
    pub threads: usize,
    /// Millions a second.
    pub millions: f64,
    /// Floating-point operations of each.
    pub flops: usize,
    /// Bytes that each moves.
    pub bytes: usize,
    /// What it is compared with, and that in millions a second.
    pub beside: Vec<(&'static str, f64)>,
}

impl Display for GrassRate {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, threads, millions, flops, bytes, beside } = self;
        let (gigaflops, gigabytes) = (millions * *flops as f64 / 1e3, millions * *bytes as f64 / 1e3);
        write!(
            out,
            "{name:<36}  {threads} thr  {millions:>7.1} M/s  {flops} flops and {bytes} B each: {gigaflops:.1} Gflop/s, \
             {gigabytes:.1} GB/s"
        )?;
        beside.iter().try_for_each(|(other, rate)| write!(out, "; {:.1} times {other}", millions / rate))
    }
}

/// Measures sets and vertices for each thread count; `report` is called with each line as it is known.
///
/// # Errors
/// [`Error::Run`] where threads cannot be started.
pub fn grass(threads: &[usize], report: &mut (dyn FnMut(&dyn Display) + Send)) -> Result<(), Error> {
    for &count in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {count} threads: {cause}")))?;
        for rate in pool.install(rates) {
            report(&rate);
        }
    }
    Ok(())
}

/// The rates on the threads of this pool.
fn rates() -> Vec<GrassRate> {
    let meadow = meadow();
    let threads = rayon::current_num_threads();
    let naive = rate(|| naive(&meadow).len());
    let sets = rate(|| meadow.sets(&meadow.area()).len());
    let grown: Vec<_> = meadow.sets(&meadow.area()).into_iter().take(GROWN).map(Instance::unpack).collect();
    let vertices = rate(|| grown.par_iter().map(|set| vertices(&meadow, set)).sum());
    let line = |name, millions, [flops, bytes]: [usize; 2], beside: &[(&'static str, f64)]| GrassRate {
        name,
        threads,
        millions,
        flops,
        bytes,
        beside: beside.to_vec(),
    };
    vec![
        line("naive, sets of grass", naive, [SET_FLOPS, SET_BYTES], &[]),
        line(
            "sets of grass, 16 B each",
            sets,
            [SET_FLOPS, SET_BYTES],
            &[("naive", naive), ("the aim of 10 M/s", TARGET_RATE)],
        ),
        line("vertices of blades at level 4", vertices, [VERTEX_FLOPS, VERTEX_BYTES], &[]),
    ]
}

/// Rolling ground with two species.
fn meadow() -> Meadow {
    let size = Size { columns: SIDE, rows: SIDE };
    let map = |seed: u64| {
        Field::from_function(size, |x, y| 0.3 + 0.7 * unit(hash2(seed, x as i64, y as i64)) as f32)
    };
    Meadow {
        species: vec![SPECIES[0].clone(), SPECIES[1].clone()],
        bend: Bend::Total,
        seed: 7,
        densest: DENSEST,
        level: LEVELS as f32,
        mown_height: 0.05,
        deepest: 0.0,
        tussocks: 0.6,
        maps: Maps {
            cell: 1.0,
            valid: None,
            density: Field::filled(size, 1.0),
            soil: map(1),
            light: map(2),
            shares: vec![map(3), Field::filled(size, 1.0)],
            water: None,
            mown: None,
            trodden: None,
        },
    }
}

/// Millions a second of work that says how much it did: the best of several runs.
fn rate(work: impl Fn() -> usize) -> f64 {
    let run = || {
        let begun = Instant::now();
        let done = black_box(work());
        done as f64 / begun.elapsed().as_secs_f64() / 1e6
    };
    (0..RUNS).map(|_| run()).fold(0.0, f64::max)
}

fn vertices(meadow: &Meadow, set: &Instance) -> usize {
    let species = &meadow.species[set.species as usize];
    let rows = blade::rows(set.tuft.level);
    let of_blade = |number| {
        let blade = Blade::of(species, &set.tuft, number, meadow.bend);
        blade.vertices(rows).map(black_box).count()
    };
    (0..BLADES).map(of_blade).sum()
}

/// As one would write it down: cell after cell, so many sets in each at random, each with the values of its place.
fn naive(meadow: &Meadow) -> Vec<Instance> {
    let (mut sets, maps) = (Vec::new(), &meadow.maps);
    for y in 0..SIDE {
        for x in 0..SIDE {
            for number in 0..(f64::from(maps.density.at(x, y)) * meadow.densest) as u64 {
                let random =
                    |purpose: u64| unit(hash2(meadow.seed ^ number << 8 ^ purpose, x as i64, y as i64));
                let place = [x as f64 + random(0), y as f64 + random(1)];
                let tuft = Set {
                    soil: between(&maps.soil, place),
                    light: between(&maps.light, place),
                    level: meadow.level,
                    cut: 1.0,
                    trodden: 0.0,
                    seed: (random(3) * 65536.0) as u32,
                };
                let species = u32::from(random(2) as f32 > between(&maps.shares[0], place));
                sets.push(Instance { place: place.map(|along| along as f32), species, tuft });
            }
        }
    }
    sets
}

/// The value between the centres of cells.
fn between(map: &Field, place: [f64; 2]) -> f32 {
    let [u, v] = place.map(|along| (along - 0.5).clamp(0.0, SIDE as f64 - 1.001));
    let (x, y) = (u as usize, v as usize);
    let at = |x: usize, y: usize| f64::from(map.at(x, y));
    let (right, down) = (u - x as f64, v - y as f64);
    let north = at(x, y) * (1.0 - right) + at(x + 1, y) * right;
    let south = at(x, y + 1) * (1.0 - right) + at(x + 1, y + 1) * right;
    (north * (1.0 - down) + south * down) as f32
}
