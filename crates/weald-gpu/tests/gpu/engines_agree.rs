//! One body runs every process on every engine. Threads, bands and tiles of the CPU give the same bits; a device
//! comes near them, and its tiles give the bits of its whole.

use std::sync::Arc;

use crate::common::{run_on, worst_difference};
use crate::processes::{masked, processes, whole, whole_models, wide};
use crate::rounding::{self, Bounds};
use weald::engine::device::{Device, Loaded};
use weald::engine::program::Program;
use weald::engine::{Engine, Job, Unwatched};
use weald::error::{DeviceError, DeviceErrorKind};
use weald::step::{Outcome, Step};
use weald::{Error, Field, Landscape, Size};
use weald_gpu::Gpu;

/// Metres that software may differ by from the CPU in its worst cell, and on average. What rests on rounding is
/// rounded on both alike, but a device's quotients and roots may be some units off in the last place, and its
/// compiler may fuse a product with a sum. A last place is 2e-6 m on ground 25 m high; three of them in the worst
/// cell, and a sixth of one on average, were seen. Where such a digit decides whether water flows, a cell differs
/// by more: a tenth of a millimetre leaves room for it.
const LEAST: Bounds = Bounds { worst: 1e-4, mean: 2e-6 };

/// The same of the terms of a budget, as shares of them.
const BUDGET: Bounds = Bounds { worst: 1e-4, mean: 1e-4 };

/// An engine on so many threads.
type Named = (String, Engine, usize);

/// Engines that give the bits of one thread, and whether their sums do too.
fn exact_engines() -> impl Iterator<Item = (Named, bool)> {
    let threads = [3].map(|count| ((format!("{count} threads"), Engine::Cpu, count), true));
    let bands = [2, 7].map(|count| ((format!("{count} bands"), Engine::Bands(count), 2), true));
    let tiles = [(37, 41), (1000, 17)].map(|(columns, rows)| {
        let size = Size::new(columns, rows).expect("small");
        ((format!("tiles of {columns} x {rows}"), Engine::Tiles(size), 2), false)
    });
    threads.into_iter().chain(bands).chain(tiles)
}

/// Whether a ground is run in the tiles of a device too.
#[derive(Clone, Copy, PartialEq)]
enum DeviceTiles {
    Yes,
    No,
}

/// The body: processes on every engine.
fn agree_on(ground: &Landscape, processes: Vec<Box<dyn Step>>, tiles: DeviceTiles) {
    for step in processes {
        let (expected, outcome) = run(&*step, ground, &Engine::Cpu, 1);
        let moved =
            worst_difference(ground.field("height").expect("h"), expected.field("height").expect("h"));
        assert!(moved > 1e-3, "nothing moved, so agreement would mean nothing: {moved} m, {step:?}");
        for ((name, engine, threads), same_sums) in exact_engines() {
            let (got, sums) = run(&*step, ground, &engine, threads);
            assert_same_bits(&*step, &expected, &got, &name);
            if same_sums {
                assert_eq!(outcome, sums, "{name}: {step:?}");
            }
            assert_near_budget(&outcome, &sums, 1e-6);
        }
        if let Some(gpu) = crate::programs::gpu() {
            let (got, sums) = run(&*step, ground, &Engine::Device(Arc::new(gpu.clone())), 1);
            assert_near(&*step, ground, [(&expected, &outcome), (&got, &sums)], &gpu);
            if tiles == DeviceTiles::Yes {
                let (tiles, sums_of_tiles) = run_in_tiles(&*step, ground, &gpu);
                assert_same_bits(&*step, &got, &tiles, "tiles of a device");
                assert_near_budget(&sums, &sums_of_tiles, 1e-4);
            }
        }
    }
}

#[test]
fn engines_agree_on_a_grid_that_is_all_land() {
    agree_on(&whole(), processes(), DeviceTiles::No);
}

#[test]
fn engines_agree_around_cells_without_data() {
    agree_on(&masked(), processes(), DeviceTiles::Yes);
}

#[test]
fn engines_agree_on_wide_ground() {
    agree_on(&wide(), whole_models(), DeviceTiles::No);
}

/// A landscape and what its step says of it, made on so many threads.
fn run(step: &dyn Step, ground: &Landscape, engine: &Engine, threads: usize) -> (Landscape, Outcome) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let mut land = ground.clone();
    let outcome = pool.install(|| run_on(step, &mut land, engine.clone()));
    (land, outcome)
}

/// A device that says it has less memory than it has.
#[derive(Debug)]
struct LimitedDevice {
    gpu: Gpu,
    memory: u64,
    /// Whether it loads programs, or refuses all.
    loads: bool,
}

impl Device for LimitedDevice {
    fn adapter(&self) -> String {
        self.gpu.adapter()
    }

    fn memory(&self) -> u64 {
        self.memory
    }

    fn largest_buffer(&self) -> u64 {
        self.gpu.largest_buffer()
    }

    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error> {
        let refused = || DeviceError::new(DeviceErrorKind::Failed, "not now").into();
        if self.loads { self.gpu.load(program, size) } else { Err(refused()) }
    }
}

/// In tiles of a memory sixteen times as large as the least that has room for a halo: a few tiles, most of which
/// have neighbours on several sides.
fn run_in_tiles(step: &dyn Step, ground: &Landscape, gpu: &Gpu) -> (Landscape, Outcome) {
    let run_with = |memory, loads| {
        let engine = Engine::Device(Arc::new(LimitedDevice { gpu: gpu.clone(), memory, loads }));
        let mut land = ground.clone();
        let job = Job { seed: 7, engine, watcher: &Unwatched, resume: None };
        step.run(&mut land, &job).map(|outcome| (land, outcome))
    };
    let too_small = |memory: &u64| matches!(run_with(*memory, false), Err(Error::Limit(_)));
    let least =
        (12..40).map(|power| 1 << power).find(|memory| !too_small(memory)).expect("some memory is enough");
    run_with(16 * least, true).expect("more than the least is enough")
}

fn assert_same_bits(step: &dyn Step, expected: &Landscape, got: &Landscape, engine: &str) {
    for ((name, expected), (_, got)) in expected.layers().zip(got.layers()) {
        let mut pairs = expected.field.values().iter().zip(got.field.values());
        let same = pairs.all(|(a, b)| a.to_bits() == b.to_bits());
        let worst = worst_difference(&expected.field, &got.field);
        assert!(same, "{engine}: `{name}` differs by up to {worst}: {step:?}");
    }
}

/// All layers and the budget of what a device makes.
fn assert_near(step: &dyn Step, ground: &Landscape, [expected, got]: [(&Landscape, &Outcome); 2], gpu: &Gpu) {
    let of = budget(expected.1);
    let fields = |(land, outcome): (&Landscape, &Outcome)| {
        let layers = land.layers().map(|(_, layer)| layer.field.clone());
        layers.chain([shares(budget(outcome), of)]).collect::<Vec<_>>()
    };
    let (names, expected, got) = (expected.0.layers().map(|(name, _)| name), fields(expected), fields(got));
    let bounds = rounding::bounds(
        gpu,
        |at| if at + 1 < expected.len() { LEAST } else { BUDGET },
        (ground, &expected),
        &|ground| {
            let (land, outcome) = run(step, ground, &Engine::Cpu, 1);
            fields((&land, &outcome))
        },
    );
    for (name, ((expected, got), bound)) in names.chain(["budget"]).zip(expected.iter().zip(&got).zip(bounds))
    {
        let seen = Bounds::between(expected, got);
        assert!(seen.within(bound), "the device's `{name}` has {seen:?} with a bound of {bound:?}: {step:?}");
    }
}

/// Numbers as shares of others, or of one where those are less.
fn shares(numbers: [f64; 5], of: [f64; 5]) -> Field {
    let share = |x: usize, _| (numbers[x] / of[x].abs().max(1.0)) as f32;
    Field::from_function(Size { columns: numbers.len(), rows: 1 }, share)
}

/// Water that came, went and is there; solid that went and is ground.
fn budget(outcome: &Outcome) -> [f64; 5] {
    let budget = outcome.budget.expect("a simulation has a budget");
    let (water, solid) = (budget.water, budget.solid);
    [water.incoming, water.outgoing, water.stored, solid.outgoing, solid.ground]
}

/// Tiles add the same numbers in another order, in 64 bits; devices theirs in pairs of 32 bits.
fn assert_near_budget(expected: &Outcome, got: &Outcome, share: f64) {
    for (a, b) in budget(expected).into_iter().zip(budget(got)) {
        assert!((a - b).abs() <= share * a.abs().max(1.0), "{expected:?} {got:?}");
    }
}
