use proptest::prelude::*;
use weald_core::parameter::{Length, Nested};
use weald_core::{Error, Field, Landscape};
use weald_engine::Engine;
use weald_land::edit::{Action, Brush, Effect, Falloff, History, Session};
use weald_land::erode::dissolution_step::DissolutionWithin;
use weald_land::erode::hydraulic::{Boundary, HanKeys, Hydraulic, InteractiveSession, StavaKeys};
use weald_land::erode::slippage_step::SlippageWithin;

use super::{any_brush, canvas, dab};

/// All processes of stava under short rains.
fn step() -> Hydraulic {
    let keys = StavaKeys {
        rain: Length::Metres(0.02),
        dry_period: 5,
        dissolution: Some(Nested(DissolutionWithin::default())),
        slippage: Some(Nested(SlippageWithin::default())),
        ..StavaKeys::default()
    };
    Hydraulic { model: keys.into(), rain_period: 7, ..Hydraulic::default() }
}

/// The rough ground of the canvas as a landscape.
fn land() -> Landscape {
    let canvas = canvas(24, 18);
    let mut land = Landscape::new(weald_core::Domain::new(canvas.size(), canvas.cell));
    land.materials = canvas
        .materials
        .iter()
        .map(|name| weald_core::material::Material::built_in(name).expect("built in"))
        .collect();
    let surface =
        Field::from_values(canvas.size(), (0..24 * 18).map(|at| canvas.surface(at) as f32).collect());
    land.insert("height", "m", surface);
    for (name, thickness) in canvas.materials.iter().skip(1).zip(&canvas.thickness) {
        land.insert(name, "m", thickness.clone());
    }
    land
}

fn any_action() -> impl Strategy<Value = Action> {
    prop_oneof![(1_u64..12).prop_map(Action::Steps), any_brush().prop_map(Action::Stroke)]
}

/// Steps under rain, so that something happens wherever the strokes fall, and then any actions.
fn any_script() -> impl Strategy<Value = Vec<Action>> {
    prop::collection::vec(any_action(), 2..13)
        .prop_map(|actions| std::iter::once(Action::Steps(3)).chain(actions).collect())
}

fn run_interactive<R>(engine: &Engine, hold: impl FnOnce(InteractiveSession<'_>) -> Result<R, Error>) -> R {
    step().run_interactive(&land(), engine, hold).unwrap_or_else(|error| panic!("{error}"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_real_simulation_undone_and_redone_has_the_same_bits(
        actions in any_script(), room in 1_usize..5,
    ) {
        run_interactive(&Engine::Cpu, |mut session| {
            let start = session.snapshot()?;
            let budget = room * InteractiveSession::bytes(&start);
            let mut history = History::new(session, budget)?;
            for action in &actions {
                history.act(action.clone())?;
            }
            let end = history.session_mut().snapshot()?;
            assert!(start != end, "something happened");
            while history.undo()? {
                assert!(history.used() <= budget);
            }
            assert!(history.session_mut().snapshot()? == start, "undone");
            while history.redo()? {}
            assert!(history.session_mut().snapshot()? == end, "redone");
            let again = run_interactive(&Engine::Bands(2), |mut fresh| {
                actions.iter().try_for_each(|action| fresh.apply(action))?;
                fresh.snapshot()
            });
            assert!(again == end, "a fresh replay in bands");
            Ok(())
        });
    }
}

#[test]
fn frozen_ground_stands_still_with_its_water_until_it_thaws() {
    run_interactive(&Engine::Cpu, |mut session| {
        let whole = session.whole();
        session.apply(&Action::Steps(9))?;
        let frost =
            Brush { path: vec![[48.0, 36.0]], radius: 16.0, falloff: Falloff::Hard, ..dab(Effect::Freeze) };
        session.apply(&Action::Stroke(frost.clone()))?;
        let before = session.canvas(whole)?;
        let is_frozen = |at: usize| before.frozen.values()[at] > 0.0;
        let frozen: Vec<_> = (0..whole.size.cells()).filter(|&at| is_frozen(at)).collect();
        assert!(frozen.len() > 20 && frozen.len() < whole.size.cells() / 2, "{} cells", frozen.len());
        assert!(frozen.iter().any(|&at| before.water.values()[at] > 0.0), "there is water to hold");
        session.apply(&Action::Steps(60))?;
        let after = session.canvas(whole)?;
        for ((name, before), (_, after)) in before.fields().zip(after.fields()) {
            for &at in &frozen {
                assert_eq!(before.values()[at].to_bits(), after.values()[at].to_bits(), "{name} at {at}");
            }
        }
        assert!(before.bedrock != after.bedrock, "the rest goes on");
        let warmth = Brush { effect: Effect::Thaw, ..frost };
        session.apply(&Action::Stroke(warmth))?;
        session.apply(&Action::Steps(60))?;
        let thawed = session.canvas(whole)?;
        assert!(frozen.iter().any(|&at| thawed.water.values()[at] != after.water.values()[at]), "it goes on");
        assert!(thawed.frozen.values().iter().all(|&frozen| frozen == 0.0));
        Ok(())
    });
}

#[test]
fn what_cannot_be_held_in_hand_is_refused() {
    let han = Hydraulic { model: HanKeys::default().into(), ..Hydraulic::default() };
    let error = han.run_interactive(&land(), &Engine::Cpu, |_| Ok(())).expect_err("no layers");
    assert!(error.to_string().contains("stava"), "{error}");
    let open = Hydraulic { boundary: Boundary::Open, ..step() };
    let frost = Action::Stroke(dab(Effect::Freeze));
    let error =
        open.run_interactive(&land(), &Engine::Cpu, |mut session| session.apply(&frost)).expect_err("open");
    assert!(error.to_string().contains("boundary"), "{error}");
}

#[test]
fn states_after_as_many_steps_differ_where_their_ground_does() {
    run_interactive(&Engine::Cpu, |mut session| {
        let before = session.snapshot()?;
        session.apply(&Action::Stroke(dab(Effect::AddWater { depth: 5.0 })))?;
        assert!(before != session.snapshot()?, "there is more water");
        Ok(())
    });
}

#[test]
fn a_stroke_falls_on_the_same_cells_within_open_borders_as_within_walls() {
    let painted = |boundary| {
        let step = Hydraulic { boundary, ..step() };
        let stroke = Action::Stroke(dab(Effect::AddWater { depth: 5.0 }));
        let hold = |mut session: InteractiveSession<'_>| {
            session.apply(&stroke)?;
            session.canvas(session.whole())
        };
        step.run_interactive(&land(), &Engine::Cpu, hold).unwrap_or_else(|error| panic!("{error}")).water
    };
    let closed = painted(Boundary::Closed);
    assert!(closed.at(15, 12) > 4.0, "{} m in the middle of the stroke", closed.at(15, 12));
    assert!(painted(Boundary::Open) == closed, "the water lies elsewhere");
}
