//! Simulations that a person holds: taken back, done again, and replayed from what was written down.

use proptest::prelude::*;
use weald_core::parameter::{Diagnostics, LayerName, Length, Nested, Parameters};
use weald_core::source::{Node, Table, Value};
use weald_core::{Error, Field, Landscape, Size};
use weald_engine::{Engine, Job};
use weald_land::edit::{Action, Area, Brush, Canvas, Change, Effect, Falloff, History, Setting, Undoable};
use weald_land::erode::dissolution_step::{DissolutionStep, DissolutionWithin};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::hydraulic::{Boundary, HanKeys, Hydraulic, MeiKeys, StavaKeys};
use weald_land::erode::interactive::{Interactive, InteractiveSimulation};
use weald_land::erode::slippage_step::{SlippageStep, SlippageWithin};
use weald_land::erode::thermal_step::Thermal;
use weald_land::erode::transport_step::Carry;

use super::{any_brush, canvas, dab};

/// All processes of stava under short rains.
fn stava() -> Hydraulic {
    let keys = StavaKeys {
        rain: Length::Metres(0.02),
        dry_period: 5,
        dissolution: Some(Nested(DissolutionWithin::default())),
        slippage: Some(Nested(SlippageWithin::default())),
        ..StavaKeys::default()
    };
    Hydraulic { model: keys.into(), rain_period: 7, ..Hydraulic::default() }
}

fn han(boundary: Boundary) -> Hydraulic {
    let keys = HanKeys { rain: Length::Metres(0.02), dry_period: 5, ..HanKeys::default() };
    Hydraulic { model: keys.into(), rain_period: 7, boundary, ..Hydraulic::default() }
}

fn fluvial(boundary: Boundary) -> Fluvial {
    Fluvial {
        flow_time: 0.02,
        rain: 5_000.0,
        duration: 3.0,
        erodibility: 0.1,
        deepest: 0.5,
        gathering: 1.0,
        channel_width: 0.3,
        cover: 5.0,
        boundary,
        ..Fluvial::default()
    }
}

fn mei() -> Hydraulic {
    Hydraulic { model: MeiKeys::default().into(), rain_period: 7, ..Hydraulic::default() }
}

/// The rough ground of the canvas as a landscape, with a pond and a stream.
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
    let field = |value: fn(usize, usize) -> f32| Field::from_function(canvas.size(), value);
    land.insert("water", "m", field(|x, _| if x < 9 { 2.0 } else { 0.5 }));
    land.insert("flux_x", "m³/step", field(|x, _| if x < 23 { 1.0 } else { 0.0 }));
    land.insert("flux_y", "m³/step", field(|_, _| 0.0));
    land.insert("dye", "m", field(|x, y| ((x * 7 + y * 3) % 5) as f32));
    land
}

/// A step, its name, which of any brushes and settings it can follow.
struct Holdable {
    name: &'static str,
    step: Box<dyn Interactive>,
    /// Runs the step to its end with other values of these keys.
    run: Box<dyn Fn(&Table) -> Landscape + Send + Sync>,
    settings: &'static [(&'static str, f64)],
}

fn held<S: Interactive + Parameters + Clone + 'static>(
    name: &'static str,
    step: S,
    settings: &'static [(&'static str, f64)],
) -> Holdable {
    let again = step.clone();
    let run = move |keys: &Table| {
        let mut diagnostics = Diagnostics::default();
        let step = again.changed(keys, &mut diagnostics);
        assert!(diagnostics.found.is_empty(), "{:?}", diagnostics.found);
        let mut land = land();
        step.run(&mut land, &Job::unwatched(0)).unwrap_or_else(|error| panic!("{name}: {error}"));
        land
    };
    Holdable { name, step: Box::new(step), run: Box::new(run), settings }
}

/// Every step that is a simulation.
fn all() -> Vec<Holdable> {
    let dye = Carry { layer: LayerName::of("dye"), ..Carry::default() };
    vec![
        held("han", han(Boundary::Closed), &[("rain", 0.05), ("erosion", 0.02), ("thermal.talus", 0.3)]),
        held("han, open", han(Boundary::Open), &[("evaporation", 0.04), ("capacity", 20.0)]),
        held("mei", mei(), &[("rain", 0.05), ("deposition", 0.3), ("dry_period", 3.0)]),
        held(
            "stava",
            stava(),
            &[("rain", 0.03), ("erosion", 5.0), ("slippage.strength", 0.01), ("viscosity", 0.5)],
        ),
        held(
            "fluvial",
            fluvial(Boundary::Closed),
            &[("erodibility", 0.5), ("evaporation", 900.0), ("channel_width", 0.5)],
        ),
        held("fluvial, open", Fluvial { materials: true, ..fluvial(Boundary::Open) }, &[("rain", 9_000.0)]),
        held("thermal", Thermal { talus: 0.3, ..Thermal::default() }, &[("talus", 0.1), ("strength", 0.2)]),
        held("slippage", SlippageStep::default(), &[("strength", 0.05)]),
        held("dissolution", DissolutionStep::default(), &[("depth", 0.6), ("damping", 0.5)]),
        held("transport", dye, &[]),
    ]
}

/// Steps, strokes and settings; those that a step cannot follow are refused and change nothing.
#[derive(Clone, Debug)]
enum Wish {
    Steps(u64),
    Stroke(Brush),
    Setting(prop::sample::Index),
}

fn any_wish() -> impl Strategy<Value = Wish> {
    prop_oneof![
        3 => (1_u64..12).prop_map(Wish::Steps),
        4 => any_brush().prop_map(Wish::Stroke),
        1 => any::<prop::sample::Index>().prop_map(Wish::Setting),
    ]
}

impl Wish {
    fn action(&self, held: &Holdable) -> Option<Action> {
        match self {
            Self::Steps(steps) => Some(Action::Steps(*steps)),
            Self::Stroke(brush) => Some(brush.clone().into()),
            Self::Setting(index) => {
                let (key, value) = held.settings.get(index.index(held.settings.len().max(1)))?;
                let whole = value.fract() == 0.0 && *key == "dry_period";
                let value = if whole { Value::Integer(*value as i64) } else { Value::Number(*value) };
                Some(Setting { key: (*key).to_owned(), value }.into())
            }
        }
    }
}

fn begin(held: &Holdable, engine: &Engine) -> InteractiveSimulation {
    held.step.hold(&land(), engine).unwrap_or_else(|error| panic!("{}: {error}", held.name))
}

fn now(simulation: &mut InteractiveSimulation) -> Landscape {
    simulation.landscape().expect("can be read").0
}

/// Does what it can of the wishes; gives the actions that were done.
fn act(history: &mut History<InteractiveSimulation>, held: &Holdable, wishes: &[Wish]) -> Vec<Action> {
    let steps = std::iter::once(Action::Steps(3)).chain(wishes.iter().filter_map(|wish| wish.action(held)));
    let mut possible = |action: &Action| match history.act(action.clone()) {
        Ok(_) => true,
        Err(error) => {
            assert!(matches!(action, Action::Change(_)), "{}: {error}", held.name);
            false
        }
    };
    steps.filter(|action| possible(action)).collect()
}

/// The keys of a replay.
fn keys(held: &Holdable, steps: u64, script: &std::path::Path) -> Table {
    let mut table = Table::default();
    let mut set = |key: &str, value| table.set(key, Node { line: 0, value });
    held.step.replayed(steps).into_iter().for_each(|(key, value)| set(key, value));
    set("edits", Value::Text(script.display().to_string()));
    table
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn whatever_was_done_can_be_undone_redone_and_replayed_from_its_script_to_the_bit(
        wishes in prop::collection::vec(any_wish(), 2..13), room in 1_u64..5,
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let script = folder.path().join("edits.jsonl");
        for held in all() {
            let name = held.name;
            let mut simulation = begin(&held, &Engine::Cpu);
            let start = now(&mut simulation);
            let budget = room * simulation.bytes_of_copy() + 4096;
            let mut history = History::new(simulation, budget).expect("the start fits");
            let actions = act(&mut history, &held, &wishes);
            let end = now(history.simulation_mut());
            prop_assert!(start != end, "{name}: something happened");
            let (steps, edits) = history.script();
            edits.save(&script).expect("written");
            prop_assert!((held.run)(&keys(&held, steps, &script)) == end, "{name}: replayed by a run");
            while history.undo().expect("takes back") {
                prop_assert!(history.used() <= budget);
            }
            prop_assert!(now(history.simulation_mut()) == start, "{name}: undone");
            while history.redo().expect("does again") {}
            prop_assert!(now(history.simulation_mut()) == end, "{name}: redone");
            let mut fresh = begin(&held, &Engine::Bands(2));
            for action in &actions {
                fresh.apply(action).expect("as before");
            }
            prop_assert!(now(&mut fresh) == end, "{name}: a fresh replay in bands");
        }
    }
}

fn hold(step: &Hydraulic) -> InteractiveSimulation {
    step.hold(&land(), &Engine::Cpu).unwrap_or_else(|error| panic!("{error}"))
}

fn whole(simulation: &mut InteractiveSimulation) -> Canvas {
    simulation.canvas(simulation.whole()).expect("can be read")
}

#[test]
fn frozen_ground_stands_still_with_its_water_until_it_thaws() {
    let initial = |step: Hydraulic| Hydraulic { initial_water: Some(LayerName::of("water")), ..step };
    for step in [stava(), initial(han(Boundary::Closed)), initial(mei())] {
        let mut simulation = hold(&step);
        simulation.advance(9).expect("runs");
        let frost =
            Brush { path: vec![[48.0, 36.0]], radius: 16.0, falloff: Falloff::Hard, ..dab(Effect::Freeze) };
        simulation.stroke(&frost).expect("freezes");
        let before = whole(&mut simulation);
        let is_frozen = |at: &usize| before.frozen.values()[*at] > 0.0;
        let frozen: Vec<_> = (0..24 * 18).filter(is_frozen).collect();
        assert!(frozen.len() > 20 && frozen.len() < 24 * 9, "{} cells", frozen.len());
        assert!(frozen.iter().any(|&at| before.water.values()[at] > 0.0), "there is water to hold");
        simulation.advance(60).expect("runs");
        let after = whole(&mut simulation);
        for ((name, before), (_, after)) in before.fields().zip(after.fields()) {
            for &at in &frozen {
                assert_eq!(before.values()[at].to_bits(), after.values()[at].to_bits(), "{name} at {at}");
            }
        }
        assert!(before.bedrock != after.bedrock, "the rest goes on");
        simulation.stroke(&Brush { effect: Effect::Thaw, ..frost }).expect("thaws");
        simulation.advance(60).expect("runs");
        let thawed = whole(&mut simulation);
        let moved = |&at: &usize| thawed.water.values()[at] != after.water.values()[at];
        assert!(frozen.iter().any(moved), "it goes on");
        assert!(thawed.frozen.values().iter().all(|&frozen| frozen == 0.0));
    }
}

#[test]
fn what_a_step_cannot_follow_is_refused_with_its_reason_and_changes_nothing() {
    let refused = |step: &dyn Interactive, change: Change| {
        let mut simulation = step.hold(&land(), &Engine::Cpu).expect("begins");
        simulation.advance(4).expect("runs");
        let before = now(&mut simulation);
        let error = simulation.apply(&Action::Change(change)).expect_err("is refused").to_string();
        assert!(now(&mut simulation) == before, "{error}");
        error
    };
    let set =
        |key: &str, value: f64| Change::Set(Setting { key: key.to_owned(), value: Value::Number(value) });
    let stroke = |effect| Change::from(dab(effect));
    let soil = Effect::Add { material: "soil".to_owned(), thickness: 1.0 };
    let closed = han(Boundary::Closed);
    for (step, change, words) in [
        (&closed as &dyn Interactive, stroke(soil), "soil"),
        (&han(Boundary::Open), stroke(Effect::Freeze), "boundary"),
        (&closed, stroke(Effect::Rain { factor: 2.0 }), "`han` knows no painted rain"),
        (&Thermal::default(), stroke(Effect::AddWater { depth: 1.0 }), "`thermal` knows no water"),
        (&Carry { layer: LayerName::of("dye"), ..Carry::default() }, stroke(Effect::Thaw), "no ground"),
        (&closed, set("iterations", 5.0), "`iterations` cannot change while the simulation runs"),
        (&closed, set("rian", 0.1), "did you mean `rain`?"),
        (&closed, set("deposition", 0.1), "there is no key `deposition`"),
        (&closed, set("flow_rate", 0.9), "outside its range: 0.0001 to 0.5"),
        (&stava(), set("slippage.strength", 0.2), "must be at most 0.25 / 3"),
        (&stava(), set("sources", 1.0), "part of what it begins with"),
        (&mei(), set("thermal.tallus", 0.1), "did you mean `talus`?"),
        (&fluvial(Boundary::Open), set("duration", 4.0), "part of what it begins with"),
        (&fluvial(Boundary::Open), set("deepest", 50.0), "would make steps"),
    ] {
        let message = refused(step, change);
        assert!(message.contains(words), "{words}: {message}");
    }
}

#[test]
fn a_stroke_falls_on_the_same_cells_within_open_borders_as_within_walls() {
    for step in [stava(), han(Boundary::Closed), mei()] {
        let painted = |boundary| {
            let mut simulation = hold(&Hydraulic { boundary, ..step.clone() });
            simulation.stroke(&dab(Effect::AddWater { depth: 5.0 })).expect("pours");
            whole(&mut simulation).water
        };
        let closed = painted(Boundary::Closed);
        assert!(closed.at(15, 12) > 4.0, "{} m in the middle of the stroke", closed.at(15, 12));
        assert!(painted(Boundary::Open) == closed, "the water lies elsewhere");
    }
}

#[test]
fn a_rectangle_is_seen_as_it_is_in_the_whole() {
    let mut simulation = hold(&stava());
    simulation.advance(20).expect("runs");
    let area = Area { first: [3, 5], size: Size { columns: 11, rows: 7 } };
    assert_eq!(simulation.canvas(area).ok(), whole(&mut simulation).part(area));
    let beyond = Area { first: [20, 5], ..area };
    let error = simulation.canvas(beyond).expect_err("is not there").to_string();
    assert!(error.contains("11 × 7 cells from column 20, row 5 on are not within 24 × 18"), "{error}");
}

#[test]
fn a_simulation_that_blew_up_goes_back_to_where_it_was_and_on_with_another_number() {
    let wild = HanKeys { capacity: Some(10_000.0), erosion: Some(1.0), limiter: false, ..HanKeys::default() };
    let step = Hydraulic { model: wild.into(), ..han(Boundary::Closed) };
    let simulation = step.hold(&land(), &Engine::Cpu).expect("begins");
    let mut history = History::new(simulation, 1 << 24).expect("fits");
    history.act(Action::Steps(2)).expect("is well yet");
    let before = now(history.simulation_mut());
    let Err(error) = history.act(Action::Steps(100_000)) else { return };
    assert!(matches!(error, Error::NotFinite(_)), "{error}");
    assert!(now(history.simulation_mut()) == before, "as it was");
    let gentle = Setting { key: "erosion".to_owned(), value: Value::Number(0.0) };
    history.act(gentle).expect("is set");
    history.act(Action::Steps(50)).expect("goes on");
}

#[test]
fn it_can_be_given_to_another_thread() {
    fn is_send<T: Send>() {}
    is_send::<History<InteractiveSimulation>>();
}

#[test]
fn a_mask_holds_for_the_strokes_after_it_and_is_undone_and_kept_like_them() {
    let simulation = hold(&stava());
    let budget = 8 * simulation.bytes_of_copy();
    let mut history = History::new(simulation, budget).expect("fits");
    let dab = |effect| Brush { falloff: Falloff::Hard, ..Brush::dab(effect, [60.0, 50.0], 20.0) };
    let mask = |history: &mut History<InteractiveSimulation>| whole(history.simulation_mut()).mask.sum();
    history.act(Change::Stroke(dab(Effect::Mask))).expect("masks");
    let masked = mask(&mut history);
    assert!(masked > 10.0, "{masked} cells");
    let before = whole(history.simulation_mut());
    history.act(Change::Stroke(dab(Effect::AddWater { depth: 5.0 }))).expect("pours");
    assert!(whole(history.simulation_mut()) == before, "all of it falls on what is masked");
    history.act(Action::Steps(40)).expect("runs on");
    assert_eq!(mask(&mut history), masked, "what runs there does not change it");
    history.act(Change::Stroke(dab(Effect::Unmask))).expect("unmasks");
    assert_eq!(mask(&mut history), 0.0);
    for (moment, expected) in [(3, masked), (0, 0.0), (1, masked), (4, 0.0), (2, masked)] {
        history.go_to(moment).expect("is there");
        assert_eq!(mask(&mut history), expected, "at moment {moment}");
    }
}
