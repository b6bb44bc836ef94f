//! Processes drawn at random end with the same bits however their ground is cut, and whoever looks on.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use weald_core::{Error, Landscape};
use weald_engine::step::{Outcome, Step};
use weald_engine::{Engine, Job, SavedSimulation, Unwatched, Watcher};

use super::draw::{Case, KINDS, case};
use crate::common::field;

/// Cases of each kind of process.
const OF_EACH_KIND: u64 = 3;

/// Looks at the drawn steps, takes a checkpoint whenever it can, and stops the run where it is told to.
pub(crate) struct Looker {
    looks: [u64; 2],
    stop: u64,
    done: AtomicU64,
    pub(crate) seen: Mutex<Vec<(u64, Landscape)>>,
    pub(crate) saved: Mutex<Option<SavedSimulation>>,
}

impl Looker {
    pub(crate) fn new(looks: [u64; 2], stop: u64) -> Self {
        let (done, seen, saved) = Default::default();
        Self { looks, stop, done, seen, saved }
    }
}

impl Watcher for Looker {
    fn progress(&self, done: u64, _: u64, _: usize) {
        self.done.store(done, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.stop
    }

    fn checkpoint_due(&self) -> bool {
        true
    }

    fn next_look(&self, done: u64) -> Option<u64> {
        self.looks.into_iter().find(|&look| look >= done)
    }

    fn look(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        self.seen.lock().expect("no look fails").push((done, landscape.clone()));
        Ok(())
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        *self.saved.lock().expect("no checkpoint fails") = Some(state.clone());
        Ok(())
    }
}

/// A run on that many threads.
fn run_on_threads(
    case: &Case,
    (engine, threads): (Engine, usize),
    watcher: &dyn Watcher,
    resume: Option<SavedSimulation>,
) -> (Landscape, Result<Outcome, Error>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let mut land = case.ground.clone();
    let job = Job { seed: 7, engine, watcher, resume };
    let outcome = pool.install(|| case.step.run(&mut land, &job));
    (land, outcome)
}

/// What differs first, in words.
pub(crate) fn difference(expected: &Landscape, got: &Landscape) -> Option<String> {
    expected.layers().zip(got.layers()).find_map(|((name, expected), (_, got))| {
        let pairs = expected.field.values().iter().zip(got.field.values());
        let other: Vec<_> = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).collect();
        let worst = other.iter().map(|(a, b)| (**a - **b).abs()).fold(0.0, f32::max);
        (!other.is_empty()).then(|| format!("{} cells of `{name}` differ by up to {worst}", other.len()))
    })
}

/// All ways to run one case against one thread that nobody looks at.
fn differences(case: &Case) -> Vec<String> {
    let (expected, outcome) = run_on_threads(case, (Engine::Cpu, 1), &Unwatched, None);
    let outcome = outcome.expect("it runs");
    let moved = field(&case.ground, case.changes) != field(&expected, case.changes);
    assert!(moved, "nothing moved, so agreement would mean nothing: {:?}", case.step);
    let mut found = Vec::new();
    for (name, engine, threads, same_sums) in [
        ("2 threads", Engine::Cpu, 2, true),
        ("3 threads", Engine::Cpu, 3, true),
        ("5 threads", Engine::Cpu, 5, true),
        ("bands", Engine::Bands(case.bands), 2, true),
        ("tiles", Engine::Tiles(case.tiles), 2, false),
    ] {
        let (got, sums) = run_on_threads(case, (engine, threads), &Unwatched, None);
        let sums = sums.expect("it runs");
        found.extend(difference(&expected, &got).map(|difference| format!("{name}: {difference}")));
        if same_sums && sums != outcome {
            found.push(format!("{name}: other sums"));
        }
    }
    found.extend(differences_of_looks(case, (&expected, &outcome)));
    found
}

/// A run that is looked at, and one that is stopped at the first look and goes on elsewhere.
fn differences_of_looks(case: &Case, (expected, outcome): (&Landscape, &Outcome)) -> Vec<String> {
    let looker = Looker::new(case.looks, u64::MAX);
    let (watched, sums) = run_on_threads(case, (Engine::Cpu, 1), &looker, None);
    assert_eq!(&sums.expect("it runs"), outcome, "a look changes sums: {:?}", case.step);
    let stopper = Looker::new(case.looks, case.looks[0]);
    let (_, stopped) = run_on_threads(case, (Engine::Bands(case.bands), 2), &stopper, None);
    assert!(matches!(stopped, Err(Error::Interrupted(_))), "{stopped:?}: {:?}", case.step);
    let saved = stopper.saved.into_inner().expect("no panic").expect("it was saved");
    let goer = Looker::new(case.looks, u64::MAX);
    let (resumed, sums) = run_on_threads(case, (Engine::Cpu, 3), &goer, Some(saved));
    assert_eq!(&sums.expect("it runs"), outcome, "a pause changes sums: {:?}", case.step);
    let [seen, seen_again] = [looker, goer].map(|looker| looker.seen.into_inner().expect("no panic"));
    let late = seen.len() - seen_again.len();
    let ends = [("looked at", expected, &watched), ("resumed", expected, &resumed)];
    let looks = seen[late..].iter().zip(&seen_again).map(|((_, a), (_, b))| ("a look", a, b));
    let pairs = ends.into_iter().chain(looks);
    pairs.filter_map(|(name, a, b)| Some(format!("{name}: {}", difference(a, b)?))).collect()
}

/// A case that is not the same everywhere, in words.
fn fault(number: u64) -> Option<String> {
    let case = case(number);
    let found = differences(&case);
    let (size, masked) = (case.ground.domain.size, case.ground.domain.valid.is_some());
    let step: &dyn Step = &*case.step;
    (!found.is_empty()).then(|| format!("case {number}, {size}, mask {masked}: {found:#?}: {step:?}"))
}

#[test]
fn whatever_is_drawn_ends_with_the_same_bits_however_it_is_cut_and_resumed() {
    let cases = 0..KINDS * OF_EACH_KIND;
    let faults: Vec<_> = cases.into_par_iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{} cases differ:\n{}", faults.len(), faults.join("\n"));
}
