//! Strokes of a brush on a simulation that a device holds.

use std::path::Path;
use std::sync::Arc;

use crate::common::{field, layered, metres, rough, run_on, stava, with, worst_difference};
use weald::edit::{Action, Brush, Canvas, Edit, Effect, Falloff, History, Script, Session};
use weald::engine::Engine;
use weald::erode::hydraulic::{Hydraulic, InteractiveSession};
use weald::recipe::parameter::ScriptFile;
use weald::{Error, Landscape};

/// Metres that a device may differ by from the CPU in its worst cell. Sixty steps carry a last place, 2e-6 m, further
/// than the few of the test of all engines; 3e-4 m were seen.
const WORST: f32 = 2e-3;

fn ground() -> Landscape {
    layered(rough(50, 40, 25.0, 3))
}

/// All processes of stava under short rains.
fn step() -> Hydraulic {
    let step = with!(stava(60), [Stava] { rain: metres(0.02), dry_period: 5 });
    Hydraulic { rain_period: 7, ..step }
}

/// Strokes of every kind that change a state, across most of the ground.
fn strokes() -> Vec<Brush> {
    let named = |name: &str| name.to_owned();
    let effects = [
        Effect::Add { material: named("sand"), thickness: 2.0 },
        Effect::Source { rate: 0.1 },
        Effect::Remove { material: named("bedrock"), thickness: 1.5 },
        Effect::AddWater { depth: 0.5 },
        Effect::Freeze,
        Effect::Smooth { times: 2 },
        Effect::Drain { rate: 0.1 },
        Effect::Thaw,
        Effect::Rain { factor: 0.2 },
    ];
    let brush = |(at, effect)| {
        // What froze thaws.
        let at = if effect == Effect::Thaw { at - 3 } else { at };
        let (x, y) = (5.0 + 4.0 * f64::from(at), 4.0 + f64::from(at * 11 % 30));
        let path = vec![[x, y], [x + 6.0, y + 4.0]];
        Brush { path, radius: 5.0, falloff: Falloff::Smooth, strength: 0.9, effect }
    };
    (0_u32..).zip(effects).map(brush).collect()
}

/// Some steps before each stroke and after the last.
fn actions() -> Vec<Action> {
    let mut actions: Vec<_> =
        strokes().into_iter().flat_map(|brush| [Action::Steps(5), Action::Stroke(brush)]).collect();
    actions.push(Action::Steps(15));
    actions
}

fn device() -> Option<Engine> {
    crate::programs::gpu().map(|gpu| Engine::Device(Arc::new(gpu)))
}

fn run_interactive<R>(engine: &Engine, hold: impl FnOnce(InteractiveSession<'_>) -> Result<R, Error>) -> R {
    step().run_interactive(&ground(), engine, hold).unwrap_or_else(|error| panic!("{error}"))
}

/// The whole of the landscape as it is now.
fn picture(session: &mut InteractiveSession<'_>) -> Result<Canvas, Error> {
    let whole = session.whole();
    session.canvas(whole)
}

#[test]
fn an_interactive_session_on_a_device_comes_near_the_same_on_the_cpu() {
    let Some(device) = device() else { return };
    let end = |engine: &Engine, with_strokes: bool| {
        run_interactive(engine, |mut session| {
            let counts = |action: &&Action| with_strokes || matches!(action, Action::Steps(_));
            actions().iter().filter(counts).try_for_each(|action| session.apply(action))?;
            assert_eq!(session.steps(), 60);
            picture(&mut session)
        })
    };
    let (expected, got, untouched) = (end(&Engine::Cpu, true), end(&device, true), end(&Engine::Cpu, false));
    for ((name, expected), ((_, got), (_, untouched))) in
        expected.fields().zip(got.fields().zip(untouched.fields()))
    {
        if name != "frozen" && name != "soil" {
            let changed = worst_difference(expected, untouched);
            assert!(changed > 5.0 * WORST, "strokes change `{name}` by {changed} alone");
        }
        let worst = worst_difference(expected, got);
        assert!(worst < WORST, "`{name}` differs by up to {worst} m");
    }
}

#[test]
fn an_interactive_session_on_a_device_undone_and_redone_has_the_same_bits() {
    let Some(device) = device() else { return };
    run_interactive(&device, |mut session| {
        let mut pictures = vec![picture(&mut session)?];
        let room = 3 * InteractiveSession::bytes(&session.snapshot()?);
        let mut history = History::new(session, room)?;
        for action in actions() {
            history.act(action)?;
            pictures.push(picture(history.session_mut())?);
        }
        assert!(pictures.windows(2).all(|pair| pair[0] != pair[1]), "every action does something");
        let last = pictures.len() - 1;
        for done in [last - 1, last, 4, 0, 9, last] {
            history.go_to(done)?;
            assert!(history.used() <= room, "snapshots of {} bytes in {room}", history.used());
            assert!(picture(history.session_mut())? == pictures[done], "after {done} of {last} actions");
        }
        Ok(())
    });
}

#[test]
fn a_run_with_a_script_of_edits_on_a_device_comes_near_the_cpu() {
    let Some(device) = device() else { return };
    let edits = (1_u64..).zip(strokes()).map(|(at, brush)| Edit { step: 5 * at, brush });
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("edits.jsonl");
    Script::new(edits.collect()).save(&file).expect("written");
    let edits = Some(ScriptFile(file.to_str().expect("a plain name").to_owned()));
    let end = |engine: &Engine, edits: Option<ScriptFile>| {
        let mut land = ground();
        let outcome = run_on(&with!(step(), [Stava] { edits: edits }), &mut land, engine.clone());
        (land, outcome.budget.expect("a simulation has a budget"))
    };
    let (expected, _) = end(&Engine::Cpu, edits.clone());
    let (got, budget) = end(&device, edits);
    let (untouched, _) = end(&Engine::Cpu, None);
    assert!(worst_difference(field(&expected, "height"), field(&untouched, "height")) > 1.0);
    for (name, layer) in expected.layers() {
        let worst = worst_difference(&layer.field, field(&got, name));
        assert!(worst < WORST, "`{name}` differs by up to {worst} m");
    }
    assert!(budget.water.error().abs() < 1e-5 && budget.solid.error().abs() < 1e-5, "{budget:?}");
}
