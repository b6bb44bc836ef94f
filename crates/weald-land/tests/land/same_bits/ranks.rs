//! Every process over 1, 2, 3, 4 and 6 ranks ends with the bits of one processor: layers, budgets and notes.

use std::sync::Arc;

use rayon::prelude::*;
use weald_core::grid::Mask;
use weald_core::material::Material;
use weald_core::{Error, Landscape};
use weald_engine::program::Content;
use weald_engine::ranks::{Counting, Ranks, ranks_in_threads};
use weald_engine::step::{Outcome, Step};
use weald_engine::{Engine, Job, SavedSimulation, Unwatched, Watcher};
use weald_land::edit::{Brush, Change, Edit, Effect, Falloff, Script, Setting};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::hydraulic::{Boundary, Hydraulic};
use weald_land::erode::processes;

use super::draw::{Case, KINDS, case_of};
use super::drawn::{Looker, difference};
use crate::common::{field, hydraulic, landscape, layered, mei, rough, stava, with};

pub(super) const COUNTS: [usize; 5] = [1, 2, 3, 4, 6];

/// Steps that every process runs at least.
const STEPS: u64 = 500;

/// What a step leaves and reports.
pub(super) type End = (Landscape, Result<Outcome, Error>);

fn run_on(step: &dyn Step, ground: &Landscape, job: &Job<'_>) -> End {
    let mut land = ground.clone();
    let outcome = step.run(&mut land, job);
    (land, outcome)
}

pub(super) fn on_one(step: &dyn Step, ground: &Landscape) -> End {
    run_on(step, ground, &Job::unwatched(7))
}

/// What the first of so many ranks has in the end. The watcher and the saved state are its alone.
fn over(count: usize, what: (&dyn Step, &Landscape), with: (&dyn Watcher, Option<SavedSimulation>)) -> End {
    over_these(ranks_in_threads(count), what, with)
}

/// The same of these ranks.
pub(super) fn over_these(
    ranks: Vec<Arc<dyn Ranks>>,
    (step, ground): (&dyn Step, &Landscape),
    (watcher, resume): (&dyn Watcher, Option<SavedSimulation>),
) -> End {
    let rank = |ranks: Arc<dyn Ranks>, watcher: &dyn Watcher, resume: Option<SavedSimulation>| {
        // Ranks wait for each other, so that none may hold a thread that another needs.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
        let job = Job { seed: 7, engine: Engine::Ranks(ranks), watcher, resume };
        pool.install(|| run_on(step, ground, &job))
    };
    let mut ranks = ranks.into_iter();
    let first = ranks.next().expect("at least one");
    std::thread::scope(|scope| {
        let others: Vec<_> = ranks.map(|other| scope.spawn(|| rank(other, &Unwatched, None))).collect();
        let end = rank(first, watcher, resume);
        for other in others {
            let (land, outcome) = other.join().expect("no panic");
            assert!(difference(ground, &land).is_none(), "the result is with the first rank alone");
            outcome.unwrap_or_else(|error| panic!("{error}"));
        }
        end
    })
}

/// What over some number of ranks is other than on one processor, in words.
fn differences(step: &dyn Step, ground: &Landscape, changes: &str) -> Vec<String> {
    let (expected, outcome) = on_one(step, ground);
    let outcome = outcome.expect("it runs");
    let moved = field(ground, changes) != field(&expected, changes);
    assert!(moved, "nothing moved, so agreement would mean nothing: {step:?}");
    let compared = COUNTS.into_iter().flat_map(|count| {
        let (got, sums) = over(count, (step, ground), (&Unwatched, None));
        let other = sums.expect("it runs") != outcome;
        let sums = other.then(|| format!("{count} ranks: another report"));
        let layers = difference(&expected, &got).map(|difference| format!("{count} ranks: {difference}"));
        layers.into_iter().chain(sums)
    });
    compared.collect()
}

fn assert_same(step: &dyn Step, ground: &Landscape) {
    let found = differences(step, ground, "height");
    assert!(found.is_empty(), "{found:#?}: {step:?}");
}

#[test]
fn whatever_is_drawn_ends_with_the_same_bits_over_ranks() {
    let faults = (0..KINDS).into_par_iter().filter_map(|number| {
        let Case { step, ground, changes, .. } = case_of(number, STEPS);
        let found = differences(&*step, &ground, changes);
        (!found.is_empty()).then(|| format!("case {number}, {}: {found:#?}", ground.domain.size))
    });
    let faults: Vec<_> = faults.collect();
    assert!(faults.is_empty(), "{} cases differ:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn every_variant_of_every_process_runs_over_ranks() {
    let ground = layered(rough(22, 70, 12.0, 11));
    for step in processes() {
        assert!(step.runs_over_ranks(), "computed by the first rank alone: {step:?}");
        let (expected, outcome) = on_one(&*step, &ground);
        let moved = ground.layers().any(|(name, layer)| field(&expected, name) != &layer.field);
        assert!(moved, "nothing moved, so agreement would mean nothing: {step:?}");
        let (got, sums) = over(3, (&*step, &ground), (&Unwatched, None));
        assert_eq!(difference(&expected, &got), None, "{step:?}");
        assert_eq!(sums.expect("it runs"), outcome.expect("it runs"), "{step:?}");
    }
}

#[test]
fn an_open_border_and_cells_without_data_lie_where_they_lay() {
    for model in [hydraulic(500), mei(500), stava(500)] {
        let step = Hydraulic { boundary: Boundary::Open, rain_period: 60, ..model };
        let step = with!(step, [Han Mei Stava] { dry_period: 40 });
        let mut ground = layered(rough(24, 61, 25.0, 5));
        let size = ground.domain.size;
        let lake = |at: usize| (at % 24).abs_diff(9) + (at / 24).abs_diff(30) > 7;
        ground.domain.valid = Mask::new(size, (0..size.cells()).map(lake).collect());
        assert_same(&step, &ground);
    }
}

#[test]
fn a_flood_on_several_grids_hands_down_the_same_over_ranks() {
    let deepest = 1.0;
    let step = Fluvial {
        levels: 3,
        coarsest: 4.0,
        deepest,
        flow_time: 500.0 * 8.0 * 0.5 / (9.81_f64 * deepest).sqrt() / 3600.0,
        duration: 20.0,
        rain: 2000.0,
        materials: true,
        ..Fluvial::default()
    };
    let mut ground = layered(rough(32, 72, 25.0, 3));
    ground.materials = ["rock", "soil"].iter().filter_map(|name| Material::built_in(name)).collect();
    assert_same(&step, &ground);
}

fn stroke(step: u64, effect: Effect, path: [f64; 2]) -> Edit {
    let path = vec![path, [path[1], path[0]]];
    Edit::stroke(step, Brush { path, radius: 6.0, falloff: Falloff::Smooth, strength: 1.0, effect })
}

/// Strokes over borders of ranks, and keys that change how far a cell feels others.
fn script() -> Script {
    let set = |step: u64, key: &str, value: &str| {
        let value = weald_core::source::Value::Text(value.to_owned());
        Edit { step, change: Change::Set(Setting { key: key.to_owned(), value }) }
    };
    Script::new(vec![
        stroke(0, Effect::AddWater { depth: 0.5 }, [4.0, 50.0]),
        stroke(90, Effect::Freeze, [12.0, 30.0]),
        set(130, "transport", "maccormack"),
        stroke(200, Effect::Source { rate: 0.05 }, [8.0, 33.0]),
        set(260, "transport", "upwind"),
        stroke(260, Effect::Add { material: "soil".to_owned(), thickness: 1.0 }, [20.0, 20.0]),
        stroke(410, Effect::Thaw, [12.0, 30.0]),
    ])
}

/// A simulation that a script edits, and the folder where that lies.
pub(super) fn edited() -> (Hydraulic, Landscape, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("s.jsonl");
    script().save(&file).expect("written");
    let edits = Some(weald_core::parameter::ScriptFile(file.display().to_string()));
    let step = with!(stava(500), [Stava] { rain: crate::common::metres(0.01) });
    (Hydraulic { edits, ..step }, layered(rough(24, 60, 20.0, 9)), folder)
}

#[test]
fn strokes_and_keys_of_a_script_reach_every_rank() {
    let (step, ground, _folder) = edited();
    assert_same(&step, &ground);
    let untouched = on_one(&Hydraulic { edits: None, ..step.clone() }, &ground).0;
    assert!(difference(&untouched, &on_one(&step, &ground).0).is_some(), "the script changes something");
}

#[test]
fn a_run_goes_on_over_another_number_of_ranks() {
    let (edited, ground, _folder) = edited();
    for (step, [before, after]) in [(edited.clone(), [4, 3]), (edited, [1, 6]), (mei(600), [6, 1])] {
        let (expected, outcome) = on_one(&step, &ground);
        let stopper = Looker::new([40, 300], 300);
        let (_, stopped) = over(before, (&step, &ground), (&stopper, None));
        assert!(matches!(stopped, Err(Error::Interrupted(_))), "{stopped:?}");
        let saved = stopper.saved.into_inner().expect("no panic").expect("it was saved");
        assert_eq!(saved.iteration, 300);
        let looker = Looker::new([310, 400], u64::MAX);
        let (got, again) = over(after, (&step, &ground), (&looker, Some(saved)));
        assert_eq!(outcome.expect("it runs"), again.expect("it goes on"), "{before} and {after} ranks");
        assert_eq!(difference(&expected, &got), None, "{before} and {after} ranks");
        let whole = Looker::new([310, 400], u64::MAX);
        run_on(&step, &ground, &Job { watcher: &whole, ..Job::unwatched(7) }).1.expect("it runs");
        let [ours, theirs] = [looker, whole].map(|looker| looker.seen.into_inner().expect("no panic"));
        assert_eq!(ours.len(), 2);
        for ((done, ours), (_, theirs)) in ours.iter().zip(&theirs) {
            assert_eq!(difference(theirs, ours), None, "a look after {done} steps");
        }
    }
}

#[test]
fn a_value_that_is_no_number_is_found_by_the_rank_that_has_it_and_said_by_the_first() {
    let step = with!(hydraulic(600), [Han] { limiter: false, flow_rate: 0.5 });
    let ground = landscape(rough(20, 48, 10.0, 1));
    let stopper = Looker::new([5, 6], 5);
    on_one_watched(&step, &ground, &stopper).expect_err("stopped");
    let mut saved = stopper.saved.into_inner().expect("no panic").expect("it was saved");
    let (_, water) = saved.planes.iter_mut().find(|(name, _)| name == "water").expect("there is water");
    water[41 * 20 + 7] = 3.0e38;
    let ends = [1, 4].map(|count| {
        let keeper = Looker::new([u64::MAX - 1; 2], u64::MAX);
        let (_, end) = over(count, (&step, &ground), (&keeper, Some(saved.clone())));
        let kept = keeper.saved.into_inner().expect("no panic").expect("the state before it is kept");
        (end.expect_err("it overflows").to_string(), kept)
    });
    assert!(ends[1].0.contains("is no longer a finite number"), "{}", ends[1].0);
    assert_eq!(ends[0], ends[1]);
}

fn on_one_watched(step: &dyn Step, ground: &Landscape, watcher: &dyn Watcher) -> Result<Outcome, Error> {
    run_on(step, ground, &Job { watcher, ..Job::unwatched(7) }).1
}

#[test]
fn a_rank_that_is_lost_ends_the_others_with_an_error() {
    let (step, ground) = (hydraulic(500), landscape(rough(20, 60, 20.0, 2)));
    let mut ranks = ranks_in_threads(3);
    drop(ranks.pop());
    let ends = std::thread::scope(|scope| {
        let run =
            |ranks| run_on(&step, &ground, &Job { engine: Engine::Ranks(ranks), ..Job::unwatched(7) }).1;
        let running: Vec<_> = ranks.into_iter().map(|ranks| scope.spawn(move || run(ranks))).collect();
        running.into_iter().map(|rank| rank.join().expect("no panic")).collect::<Vec<_>>()
    });
    let said: Vec<_> = ends.into_iter().map(|end| end.expect_err("one is missing").to_string()).collect();
    assert_eq!(said[0], "rank 2 has ended before the run did");
    assert!(said[1].contains("has ended before the run did"), "{}", said[1]);
}

#[test]
fn a_simulation_that_a_person_holds_is_refused() {
    use weald_land::erode::interactive::Interactive;
    let ranks = ranks_in_threads(1).remove(0);
    let held = hydraulic(10).hold(&landscape(rough(20, 20, 20.0, 2)), &Engine::Ranks(ranks));
    let message = held.expect_err("refused").to_string();
    assert!(message.contains("cannot run over ranks"), "{message}");
}

/// Bytes that the first of two ranks sends the other in so many steps.
fn bytes_sent(step: &Hydraulic, ground: &Landscape) -> u64 {
    let counted: Vec<_> =
        ranks_in_threads(2).into_iter().map(|ranks| Arc::new(Counting::new(ranks))).collect();
    std::thread::scope(|scope| {
        for ranks in &counted {
            let engine = Engine::Ranks(Arc::clone(ranks) as Arc<dyn Ranks>);
            scope.spawn(move || run_on(step, ground, &Job { engine, ..Job::unwatched(7) }).1.expect("runs"));
        }
    });
    counted[0].bytes()
}

#[test]
fn a_rank_sends_its_neighbours_what_the_formula_says() {
    const STEPS: u32 = 8;
    let columns = 16;
    for model in [hydraulic(STEPS), mei(STEPS), stava(STEPS)] {
        // All steps are recorded, so that they come in two whole passages of four.
        let step = Hydraulic { mean_over: Some(STEPS), ..model };
        let ground = layered(rough(columns, 400, 25.0, 4));
        let program = step.program(&ground).expect("a program");
        let lanes = program.buffers.iter().map(|buffer| match &buffer.content {
            Content::State(planes) => planes.len(),
            _ => 0,
        });
        let (planes, reach) = (lanes.sum::<usize>(), program.reach);
        let passage = 4 * columns * planes * (reach * 4 + 1);
        let a_step = passage as f64 / 4.0 / columns as f64 * 1024.0 / 1e3;
        println!(
            "{}: {planes} planes, reach {reach}, {a_step:.0} kB a step of 1024 columns",
            step.model.word()
        );
        assert_eq!(bytes_sent(&step, &ground), 2 * passage as u64, "{}", step.model.word());
    }
}
