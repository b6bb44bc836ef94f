use std::collections::BTreeMap;

use proptest::prelude::*;
use weald_core::Error;
use weald_land::edit::{Action, Canvas, Change, Effect, History, Undoable};

use super::{any_brush, canvas, dab};

/// A simulation in small: water rises at sources, runs to the cell before if that is lower, and wears the bedrock.
#[derive(Clone)]
struct Toy(Canvas);

impl Toy {
    fn new() -> Self {
        Self(canvas(11, 9))
    }

    fn step(&mut self) {
        let canvas = &mut self.0;
        for cell in 1..canvas.size().cells() {
            let fall = (canvas.surface(cell) - canvas.surface(cell - 1)).max(0.0) as f32;
            let water = canvas.water.values()[cell] + canvas.source.values()[cell].max(0.0);
            let flow = 0.2 * water * (fall / (1.0 + fall));
            canvas.water.values_mut()[cell] = water - flow;
            canvas.water.values_mut()[cell - 1] += flow;
            canvas.bedrock.values_mut()[cell] -= 0.1 * flow.min(1.0);
        }
    }
}

/// A toy, the states that it keeps, and how often it returned to one.
struct HeldToy {
    now: Toy,
    kept: BTreeMap<u64, Canvas>,
    returned: usize,
}

impl HeldToy {
    fn new() -> Self {
        Self { now: Toy::new(), kept: BTreeMap::new(), returned: 0 }
    }
}

impl Undoable for HeldToy {
    type Patch = Canvas;

    fn apply(&mut self, action: &Action) -> Result<Option<Canvas>, Error> {
        let before = self.now.0.clone();
        match action {
            Action::Steps(steps) => (0..*steps).for_each(|_| self.now.step()),
            Action::Change(Change::Stroke(brush)) => {
                brush.paint(&mut self.now.0)?;
                return Ok(Some(before));
            }
            Action::Change(Change::Set(_)) => return Err(Error::Run("a toy has no keys".to_owned())),
        }
        Ok(None)
    }

    fn take_back(&mut self, before: &Canvas) -> Result<(), Error> {
        self.now.0.clone_from(before);
        Ok(())
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.kept.insert(number, self.now.0.clone());
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        self.now.0.clone_from(&self.kept[&number]);
        self.returned += 1;
        Ok(())
    }

    fn release(&mut self, number: u64) {
        self.kept.remove(&number).expect("was kept");
    }

    fn bytes_of_copy(&self) -> u64 {
        Self::bytes_of(&self.now.0)
    }

    fn bytes_of(canvas: &Canvas) -> u64 {
        canvas.fields().map(|(_, field)| 4 * field.values().len() as u64).sum()
    }
}

fn any_action() -> impl Strategy<Value = Action> {
    prop_oneof![(1_u64..30).prop_map(Action::Steps), any_brush().prop_map(Action::from)]
}

/// The state after each number of actions, from the start.
fn states(actions: &[Action]) -> Vec<Canvas> {
    let mut held = HeldToy::new();
    let after = actions.iter().map(|action| {
        held.apply(action).expect("the action is good");
        held.now.0.clone()
    });
    std::iter::once(Toy::new().0).chain(after).collect()
}

fn now(history: &History<HeldToy>) -> &Canvas {
    &history.simulation().now.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    #[test]
    fn undo_and_redo_of_all_and_of_any_part_give_the_bits_of_a_fresh_replay(
        actions in prop::collection::vec(any_action(), 2..25),
        jumps in prop::collection::vec(any::<prop::sample::Index>(), 1..12),
        room in 1_u64..8,
    ) {
        let expected = states(&actions);
        prop_assume!(expected.first() != expected.last());
        let budget = room * HeldToy::bytes_of(&expected[0]);
        let mut history = History::new(HeldToy::new(), budget).expect("the start fits");
        for action in &actions {
            history.act(action.clone()).expect("the action is good");
            prop_assert!(history.used() <= budget);
        }
        prop_assert!(now(&history) == &expected[actions.len()], "after {} actions", history.here());
        while history.undo().expect("replays") {
            prop_assert!(now(&history) == &expected[history.here()], "after {} actions", history.here());
            prop_assert!(history.used() <= budget);
        }
        prop_assert_eq!(history.here(), 0);
        while history.redo().expect("replays") {
            prop_assert!(now(&history) == &expected[history.here()], "after {} actions", history.here());
        }
        for jump in jumps {
            let moment = jump.index(actions.len() + 1);
            history.go_to(moment).expect("replays");
            prop_assert!(now(&history) == &expected[moment], "after {} actions", history.here());
            prop_assert!(history.used() <= budget);
        }
    }

    #[test]
    fn every_moment_of_every_branch_can_be_come_back_to(
        grown in prop::collection::vec((any::<prop::sample::Index>(), any_action()), 2..20),
        jumps in prop::collection::vec(any::<prop::sample::Index>(), 1..20),
        room in 1_u64..6,
    ) {
        let budget = room * HeldToy::bytes_of(&Toy::new().0);
        let mut history = History::new(HeldToy::new(), budget).expect("the start fits");
        let mut lines: Vec<Vec<Action>> = vec![Vec::new()];
        for (from, action) in grown {
            let from = from.index(lines.len());
            history.go_to(from).expect("replays");
            let moment = history.act(action.clone()).expect("the action is good");
            prop_assert_eq!(moment, lines.len());
            let line = lines[from].iter().cloned().chain([action]).collect();
            lines.push(line);
        }
        for jump in jumps {
            let moment = jump.index(lines.len());
            history.go_to(moment).expect("replays");
            let actions: Vec<_> = history.actions().into_iter().cloned().collect();
            prop_assert_eq!(&actions, &lines[moment]);
            prop_assert!(Some(now(&history)) == states(&lines[moment]).last(), "moment {}", moment);
            prop_assert!(history.used() <= budget);
        }
    }
}

#[test]
fn what_is_done_after_an_undo_begins_a_branch_and_the_other_stays() {
    let mut history = History::new(HeldToy::new(), 1 << 20).expect("fits");
    let water = Action::from(dab(Effect::AddWater { depth: 2.0 }));
    let steps = [Action::Steps(3), water, Action::Steps(5)];
    for action in &steps {
        history.act(action.clone()).expect("good");
    }
    history.name("wet");
    assert!(history.undo().expect("replays") && history.undo().expect("replays"));
    let other = Action::Steps(9);
    let moment = history.act(other.clone()).expect("good");
    assert_eq!(history.actions(), [&steps[0], &other]);
    assert!(!history.redo().expect("nothing to do"));
    let expected = states(&[steps[0].clone(), other]);
    assert_eq!(*now(&history), expected[2]);
    assert_eq!(history.ends(), [3, moment]);
    history.go_to(history.names()["wet"]).expect("replays");
    assert_eq!(Some(now(&history)), states(&steps).last());
    while history.undo().expect("replays") {}
    while history.redo().expect("replays") {}
    assert_eq!(Some(now(&history)), states(&steps).last(), "redo follows the branch that was visited last");
    assert!(history.go_to(99).is_err_and(|error| error.to_string().contains("no moment 99")));
}

#[test]
fn strokes_are_taken_back_without_a_copy_of_everything() {
    let mut history = History::new(HeldToy::new(), 1 << 20).expect("fits");
    for _ in 0..20 {
        history.act(Action::Steps(7)).expect("good");
    }
    let before = now(&history).clone();
    for depth in 1..9 {
        history.act(dab(Effect::AddWater { depth: f64::from(depth) })).expect("good");
    }
    let after = now(&history).clone();
    (0..8).for_each(|_| assert!(history.undo().expect("is taken back")));
    assert_eq!(*now(&history), before);
    (0..8).for_each(|_| assert!(history.redo().expect("is done again")));
    assert_eq!((now(&history), history.simulation().returned), (&after, 0), "it returned to copies");
}

#[test]
fn a_stroke_that_fails_leaves_the_session_as_it_was() {
    let mut history = History::new(HeldToy::new(), 1 << 14).expect("fits");
    history.act(Action::Steps(4)).expect("good");
    let before = now(&history).clone();
    let none = Effect::Add { material: "none".to_owned(), thickness: 1.0 };
    history.act(dab(none)).expect_err("no such material");
    assert_eq!((now(&history), history.here()), (&before, 1));
    assert_eq!(History::new(HeldToy::new(), 100).map(|_| ()).expect_err("too little").exit_code(), 5);
}
