//! The same simulation in other circumstances ends with the same bits. That all engines do is tested in
//! `weald-gpu/tests/gpu/engines_agree.rs`.

mod draw;
mod drawn;
mod inside_first;
mod ranks;

use std::sync::Mutex;

use crate::common::{hydraulic, landscape, layered, mei, rough, run_on, stava, with, worst_difference};
use weald_core::{Error, Field, Landscape, Size};
use weald_engine::step::Step;
use weald_engine::{Engine, Job, SavedSimulation, Watcher};
use weald_land::erode::hydraulic::Hydraulic;

fn assert_same_bits(step: &dyn Step, expected: &Landscape, got: &Landscape, engine: &str) {
    for ((name, expected), (_, got)) in expected.layers().zip(got.layers()) {
        let same =
            expected.field.values().iter().zip(got.field.values()).all(|(a, b)| a.to_bits() == b.to_bits());
        let worst = worst_difference(&expected.field, &got.field);
        assert!(same, "{engine}: `{name}` differs by up to {worst}: {step:?}");
    }
}

/// Stops the simulation at its first look, and keeps what it saved.
#[derive(Default)]
struct Stopper {
    saved: Mutex<Option<SavedSimulation>>,
}

impl Watcher for Stopper {
    fn cancelled(&self) -> bool {
        true
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        *self.saved.lock().expect("one thread") = Some(state.clone());
        Ok(())
    }
}

#[test]
fn a_stopped_and_resumed_run_ends_with_the_same_bits() {
    for model in [hydraulic(600), mei(600), stava(600)] {
        // Longer than the 256 steps between two looks, and stopped within the steps that means are taken of.
        let step = with!(model, [Han Mei Stava] { dry_period: 100 });
        let step = Hydraulic { rain_period: 400, ..step };
        let start = layered(rough(48, 40, 20.0, 8));
        let mut whole = start.clone();
        let outcome = run_on(&step, &mut whole, Engine::Cpu);
        let stopper = Stopper::default();
        let job = Job { seed: 7, engine: Engine::Cpu, watcher: &stopper, resume: None };
        let stopped = step.run(&mut start.clone(), &job).expect_err("it was stopped");
        assert!(matches!(stopped, Error::Interrupted(_)), "{stopped}");
        let saved = stopper.saved.lock().expect("one thread").take().expect("a state was saved");
        assert!((1..600).contains(&saved.iteration), "stopped on the way: {}", saved.iteration);
        let mut resumed = start.clone();
        let job =
            Job { seed: 7, engine: Engine::Bands(3), watcher: &weald_engine::Unwatched, resume: Some(saved) };
        let again = step.run(&mut resumed, &job).expect("it goes on");
        assert_same_bits(&step, &whole, &resumed, "resumed");
        assert_eq!(outcome, again);
    }
}

#[test]
fn a_wide_landscape_gives_the_bits_of_a_tall_one_turned() {
    for step in [hydraulic(60), mei(60), stava(60)] {
        let model = step.model.word();
        let ground = rough(1300, 40, 30.0, 6);
        let turned = |field: &Field| {
            let Size { columns, rows } = field.size();
            Field::from_function(Size { columns: rows, rows: columns }, |x, y| field.at(y, x))
        };
        let (mut wide, mut tall) = (landscape(ground.clone()), landscape(turned(&ground)));
        run_on(&step, &mut wide, Engine::Cpu);
        run_on(&step, &mut tall, Engine::Cpu);
        let height = wide.field("height").expect("h");
        assert!(worst_difference(&ground, height) > 0.01, "something moved");
        assert_eq!(height, &turned(tall.field("height").expect("h")), "{model}");
    }
}
