use proptest::prelude::*;
use weald_core::Error;
use weald_land::edit::{Action, Canvas, Effect, History, Session};

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

impl Session for Toy {
    type Snapshot = Canvas;

    fn snapshot(&mut self) -> Result<Canvas, Error> {
        Ok(self.0.clone())
    }

    fn restore(&mut self, snapshot: &Canvas) -> Result<(), Error> {
        self.0.clone_from(snapshot);
        Ok(())
    }

    fn apply(&mut self, action: &Action) -> Result<(), Error> {
        match action {
            Action::Steps(steps) => (0..*steps).for_each(|_| self.step()),
            Action::Stroke(brush) => {
                brush.paint(&mut self.0)?;
            }
        }
        Ok(())
    }

    fn bytes(snapshot: &Canvas) -> usize {
        snapshot.fields().map(|(_, field)| 4 * field.values().len()).sum()
    }
}

fn any_action() -> impl Strategy<Value = Action> {
    prop_oneof![(1_u64..30).prop_map(Action::Steps), any_brush().prop_map(Action::Stroke)]
}

/// The state after each number of actions, from the start.
fn states(actions: &[Action]) -> Vec<Canvas> {
    let mut toy = Toy::new();
    let after = actions.iter().map(|action| {
        toy.apply(action).expect("the action is good");
        toy.0.clone()
    });
    std::iter::once(Toy::new().0).chain(after).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    #[test]
    fn undo_and_redo_of_all_and_of_any_part_give_the_bits_of_a_fresh_replay(
        actions in prop::collection::vec(any_action(), 2..25),
        jumps in prop::collection::vec(any::<prop::sample::Index>(), 1..12),
        room in 1_usize..8,
    ) {
        let expected = states(&actions);
        prop_assume!(expected.first() != expected.last());
        let budget = room * Toy::bytes(&expected[0]);
        let mut history = History::new(Toy::new(), budget).expect("the start fits");
        for action in &actions {
            history.act(action.clone()).expect("the action is good");
            prop_assert!(history.used() <= budget);
        }
        prop_assert!(history.session().0 == expected[actions.len()], "after {} actions", history.done());
        while history.undo().expect("replays") {
            prop_assert!(history.session().0 == expected[history.done()], "after {} actions", history.done());
            prop_assert!(history.used() <= budget);
        }
        prop_assert_eq!(history.done(), 0);
        while history.redo().expect("replays") {
            prop_assert!(history.session().0 == expected[history.done()], "after {} actions", history.done());
        }
        for jump in jumps {
            let done = jump.index(actions.len() + 1);
            history.go_to(done).expect("replays");
            prop_assert!(history.session().0 == expected[done], "after {} actions", history.done());
            prop_assert!(history.used() <= budget);
        }
    }
}

#[test]
fn what_is_done_after_an_undo_replaces_what_was_undone() {
    let mut history = History::new(Toy::new(), 1 << 20).expect("fits");
    let steps = [Action::Steps(3), Action::Stroke(dab(Effect::AddWater { depth: 2.0 })), Action::Steps(5)];
    for action in &steps {
        history.act(action.clone()).expect("good");
    }
    assert!(history.undo().expect("replays") && history.undo().expect("replays"));
    let other = Action::Steps(9);
    history.act(other.clone()).expect("good");
    assert_eq!(history.actions(), [steps[0].clone(), other.clone()]);
    assert!(!history.redo().expect("nothing to do"));
    let expected = states(&[steps[0].clone(), other]);
    assert_eq!(history.session().0, expected[2]);
    history.go_to(0).expect("replays");
    history.go_to(2).expect("replays");
    assert_eq!(history.session().0, expected[2], "no snapshot of what was undone is left");
}

#[test]
fn a_stroke_that_fails_leaves_the_session_as_it_was() {
    let mut history = History::new(Toy::new(), 1 << 14).expect("fits");
    history.act(Action::Steps(4)).expect("good");
    let before = history.session().0.clone();
    let none = Effect::Add { material: "none".to_owned(), thickness: 1.0 };
    history.act(Action::Stroke(dab(none))).expect_err("no such material");
    assert_eq!((&history.session().0, history.done()), (&before, 1));
    assert_eq!(History::new(Toy::new(), 100).map(|_| ()).expect_err("too little").exit_code(), 5);
}
