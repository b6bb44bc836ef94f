//! A simulation that leaves the finite numbers stops, says where, and keeps the last good state.

use std::sync::Mutex;

use crate::common::{hydraulic, landscape, mei, rough, with};
use weald_core::Error;
use weald_core::error::NotFinite;
use weald_engine::step::Step;
use weald_engine::{Engine, Job, SavedSimulation, Watcher};
use weald_land::erode::hydraulic::Hydraulic;

const COLUMNS: usize = 20;

/// Keeps every checkpoint; stops the run at its first look where asked to.
#[derive(Default)]
struct Keeper {
    stop: bool,
    saved: Mutex<Vec<SavedSimulation>>,
}

impl Watcher for Keeper {
    fn cancelled(&self) -> bool {
        self.stop
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        self.saved.lock().expect("one thread").push(state.clone());
        Ok(())
    }
}

fn run(step: &Hydraulic, watcher: &Keeper, resume: Option<SavedSimulation>) -> Result<(), Error> {
    let mut land = landscape(rough(COLUMNS, 16, 10.0, 1));
    step.run(&mut land, &Job { seed: 1, engine: Engine::Cpu, watcher, resume }).map(|_| ())
}

/// The state after the first look at a run, with this depth of water in one cell.
fn poisoned(step: &Hydraulic, value: f32) -> SavedSimulation {
    let keeper = Keeper { stop: true, ..Keeper::default() };
    run(step, &keeper, None).expect_err("stopped");
    let mut saved = keeper.saved.lock().expect("one thread").pop().expect("a state");
    for (name, plane) in &mut saved.planes {
        if name == "water" {
            plane[5 * COLUMNS + 7] = value;
        }
    }
    saved
}

#[test]
fn an_overflow_names_its_step_and_cell_and_keeps_the_state_before() {
    for step in [hydraulic(600), mei(600)] {
        let step = with!(step, [Han Mei] { limiter: false, flow_rate: 0.5 });
        let resume = poisoned(&step, 3.0e38);
        let start = resume.iteration;
        let keeper = Keeper::default();
        let error = run(&step, &keeper, Some(resume)).expect_err("it overflows");
        assert_eq!(error.exit_code(), 1);
        let message = error.to_string();
        println!("{message}");
        assert!(message.contains("column") && message.contains("row"), "{message}");
        assert!(message.contains("the last good state was kept"), "{message}");
        let Error::NotFinite(NotFinite { iteration, layer, cell: [x, y], .. }) = error else {
            panic!("{message}");
        };
        let place =
            format!("iteration {}: `{layer}` at column {x}, row {y} ", iteration.expect("a simulation"));
        assert!(message.starts_with(&place), "{message}");
        let saved = keeper.saved.lock().expect("one thread").pop().expect("a state was kept");
        let named: u64 =
            message.split(&[' ', ':'][..]).nth(1).and_then(|word| word.parse().ok()).expect("step N:");
        assert_eq!(saved.iteration + 1, named, "the state before the step that failed: {message}");
        assert!(saved.iteration >= start);
        assert!(saved.planes.iter().all(|(_, plane)| plane.iter().all(|value| value.is_finite())));
    }
}

#[test]
fn a_start_that_is_no_number_is_refused_before_the_first_step() {
    let step = hydraulic(600);
    let resume = poisoned(&step, f32::NAN);
    let error = run(&step, &Keeper::default(), Some(resume)).expect_err("NaN");
    assert!(error.to_string().contains("`water` at column 7, row 5"), "{error}");
    let Error::NotFinite(NotFinite { layer, cell, .. }) = error else { panic!("{error}") };
    assert_eq!((layer.as_str(), cell), ("water", [7, 5]));
}
