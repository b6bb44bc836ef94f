//! Brushes change what they say and nothing else; scripts read as they were written; undo and redo give the
//! same bits.

use proptest::prelude::*;
use weald::edit::{
    Action, Area, Brush, Canvas, Edit, Effect, Falloff, History, Layout, Script, Session, Volumes,
};
use weald::grid::Mask;
use weald::material::Material;
use weald::random::{hash2, unit};
use weald::{Error, Field, Size};

const CELL: f64 = 4.0;
const MATERIALS: [&str; 3] = ["rock", "sand", "soil"];

/// Rough ground under sand and soil that is missing in places, with some water.
fn canvas(columns: usize, rows: usize) -> Canvas {
    let size = Size::new(columns, rows).expect("small");
    let materials = MATERIALS.map(|name| Material::built_in(name).expect("built in"));
    let random = |seed: u64, low: f64, high: f64| {
        let value = move |x, y| low + (high - low) * unit(hash2(seed, x as i64, y as i64));
        Field::from_function(size, |x, y| value(x, y).max(0.0) as f32)
    };
    Canvas {
        bedrock: random(1, 100.0, 140.0),
        thickness: vec![random(2, -2.0, 3.0), random(3, -1.0, 1.0)],
        water: random(4, -1.0, 1.0),
        land: Mask::new(size, (0..size.cells()).map(|cell| cell % 17 != 5).collect()),
        ..Canvas::level(Area { first: [0, 0], size }, CELL, &materials)
    }
}

fn dab(effect: Effect) -> Brush {
    Brush { path: vec![[60.0, 50.0]], radius: 30.0, falloff: Falloff::Smooth, strength: 1.0, effect }
}

fn painted(brush: &Brush, canvas: &Canvas) -> (Canvas, Volumes) {
    let mut after = canvas.clone();
    let volumes = brush.paint(&mut after).expect("the brush is good");
    (after, volumes)
}

/// Cubic metres by which a field, or the whole ground, grew from one canvas to another.
fn growth(before: &Canvas, after: &Canvas, value: impl Fn(&Canvas, usize) -> f64) -> f64 {
    let cells = 0..before.size().cells();
    cells.map(|cell| value(after, cell) - value(before, cell)).sum::<f64>() * CELL * CELL
}

fn any_effect() -> impl Strategy<Value = Effect> {
    let name = prop::sample::select(vec!["rock", "bedrock", "sand", "soil"]).prop_map(str::to_owned);
    let amount = || 0.0..20.0_f64;
    prop_oneof![
        (name.clone(), amount()).prop_map(|(material, thickness)| Effect::Add { material, thickness }),
        (name, amount()).prop_map(|(material, thickness)| Effect::Remove { material, thickness }),
        amount().prop_map(|depth| Effect::AddWater { depth }),
        amount().prop_map(|depth| Effect::RemoveWater { depth }),
        (1_u32..4).prop_map(|times| Effect::Smooth { times }),
        (60.0..180.0_f64).prop_map(|height| Effect::Flatten { height }),
        amount().prop_map(|rate| Effect::Source { rate }),
        amount().prop_map(|rate| Effect::Drain { rate }),
        amount().prop_map(|factor| Effect::Rain { factor }),
        Just(Effect::Freeze),
        Just(Effect::Thaw),
    ]
}

fn any_brush() -> impl Strategy<Value = Brush> {
    let falloffs = vec![Falloff::Hard, Falloff::Linear, Falloff::Smooth, Falloff::Gaussian];
    let path = prop::collection::vec([-40.0..180.0_f64, -40.0..140.0_f64], 1..5);
    (path, 0.5..60.0_f64, prop::sample::select(falloffs), 0.0..=1.0_f64, any_effect()).prop_map(
        |(path, radius, falloff, strength, effect)| Brush { path, radius, falloff, strength, effect },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn a_stroke_on_its_own_rectangle_gives_the_bits_of_the_whole(brush in any_brush()) {
        let whole = canvas(37, 29);
        let (expected, all) = painted(&brush, &whole);
        let mut patched = whole.clone();
        match brush.area(whole.size(), CELL) {
            Some(area) => {
                let mut part = whole.part(area).expect("the area lies on the canvas");
                let volumes = brush.paint(&mut part).expect("the brush is good");
                patched.put(&part);
                prop_assert!((volumes.solid_added - all.solid_added).abs() <= 1e-9 * all.solid_added);
            }
            None => prop_assert_eq!(all, Volumes::default()),
        }
        prop_assert!(patched == expected, "{:?}", brush);
    }

    #[test]
    fn a_stroke_gives_account_of_all_that_it_moved_and_leaves_no_thickness_below_nothing(brush in any_brush()) {
        let before = canvas(37, 29);
        let (after, volumes) = painted(&brush, &before);
        let solid = growth(&before, &after, Canvas::surface);
        let water = growth(&before, &after, |canvas, cell| f64::from(canvas.water.values()[cell]));
        let scale = 1.0 + volumes.solid_added + volumes.solid_removed + volumes.water_added;
        prop_assert!((volumes.solid_added - volumes.solid_removed - solid).abs() < 1e-9 * scale);
        prop_assert!((volumes.water_added - volumes.water_removed - water).abs() < 1e-9 * scale);
        for field in after.thickness.iter().chain([&after.water]) {
            prop_assert!(field.values().iter().all(|&value| value >= 0.0));
        }
        for cell in (0..before.size().cells()).filter(|&cell| !before.is_open(cell)) {
            prop_assert_eq!(before.surface(cell), after.surface(cell), "a closed cell was changed");
        }
    }
}

#[test]
fn adding_and_removing_touch_the_chosen_layer_alone_and_no_more_than_is_there() {
    let before = canvas(30, 25);
    let sand = |thickness| Effect::Remove { material: "sand".to_owned(), thickness };
    let (after, volumes) = painted(&dab(sand(1000.0)), &before);
    let middle = before.size().index(15, 12);
    assert!(before.is_open(middle) && before.thickness[0].values()[middle] > 0.0);
    assert_eq!(after.thickness[0].values()[middle], 0.0);
    assert!(volumes.solid_removed > 100.0 && volumes.solid_added == 0.0, "{volumes:?}");
    assert_eq!((&after.bedrock, &after.thickness[1]), (&before.bedrock, &before.thickness[1]));
    let deep = Effect::Remove { material: "bedrock".to_owned(), thickness: 1000.0 };
    let (pit, _) = painted(&dab(deep), &before);
    assert!(pit.bedrock.values()[middle] < -800.0, "there is always more bedrock");
    let mut same = before.clone();
    let message = dab(Effect::Add { material: "snad".to_owned(), thickness: 1.0 }).paint(&mut same);
    assert!(message.expect_err("no such material").to_string().contains("rock, sand, soil"));
    assert_eq!(same, before);
}

#[test]
fn flattening_takes_from_the_top_downward_and_gives_to_the_topmost_material() {
    let before = canvas(30, 25);
    let flat = |height| Brush { falloff: Falloff::Hard, ..dab(Effect::Flatten { height }) };
    let inside: Vec<_> = {
        let (after, _) = painted(&flat(90.0), &before);
        (0..before.size().cells()).filter(|&cell| after.surface(cell) != before.surface(cell)).collect()
    };
    assert!(inside.len() > 100, "the brush is 15 cells wide");
    let (cut, _) = painted(&flat(90.0), &before);
    let (filled, _) = painted(&flat(200.0), &before);
    for &cell in &inside {
        assert!((cut.surface(cell) - 90.0).abs() < 1e-4 && (filled.surface(cell) - 200.0).abs() < 1e-4);
        assert!(cut.thickness.iter().all(|layer| layer.values()[cell] == 0.0), "bedrock is above 90 m");
        let top = (0..2).rev().find(|&layer| before.thickness[layer].values()[cell] > 0.0);
        let below = top.unwrap_or(0);
        let unchanged =
            |layer: usize| filled.thickness[layer].values()[cell] == before.thickness[layer].values()[cell];
        assert!((0..below).all(unchanged), "layers under the topmost one are as they were");
        assert_eq!(top.is_none(), filled.bedrock.values()[cell] != before.bedrock.values()[cell]);
    }
}

#[test]
fn smoothing_lessens_the_roughness_and_keeps_a_plane() {
    let before = canvas(30, 25);
    let rough = |canvas: &Canvas| {
        let height = |x, y| canvas.surface(canvas.size().index(x, y));
        let bends = (10..20).map(|x| (height(x - 1, 12) - 2.0 * height(x, 12) + height(x + 1, 12)).abs());
        bends.sum::<f64>()
    };
    let (after, _) = painted(&dab(Effect::Smooth { times: 3 }), &before);
    assert!(rough(&after) < 0.5 * rough(&before), "{} is not half of {}", rough(&after), rough(&before));
    let mut plane = Canvas { land: None, ..canvas(30, 25) };
    plane.thickness.iter_mut().for_each(|layer| layer.values_mut().fill(0.0));
    plane.bedrock = Field::from_function(plane.size(), |x, y| 8.0 * x as f32 - 4.0 * y as f32);
    assert_eq!(painted(&dab(Effect::Smooth { times: 3 }), &plane).0, plane);
}

#[test]
fn sources_drains_rain_and_frost_are_painted_and_wiped_off_again() {
    let before = canvas(30, 25);
    let middle = before.size().index(15, 12);
    let at = |effect: Effect, canvas: &Canvas| painted(&dab(effect), canvas).0;
    let spring = at(Effect::Source { rate: 0.25 }, &before);
    assert!((spring.source.values()[middle] - 0.25).abs() < 0.01 && spring.source.values()[0] == 0.0);
    assert!(at(Effect::Drain { rate: 0.25 }, &before).source.values()[middle] < -0.2);
    let dry = at(Effect::Rain { factor: 0.0 }, &before);
    assert!(dry.rain.values()[middle] < 0.05 && dry.rain.values()[0] == 1.0);
    let frozen = at(Effect::Freeze, &before);
    assert!(frozen.frozen.values().iter().all(|&value| value == 0.0 || value == 1.0));
    assert_eq!(frozen.frozen.values()[middle], 1.0);
    assert_eq!(at(Effect::Thaw, &frozen), before);
}

#[test]
fn a_brush_that_is_none_is_refused_and_changes_nothing() {
    let before = canvas(8, 8);
    let good = dab(Effect::AddWater { depth: 1.0 });
    let faulty = [
        Brush { path: Vec::new(), ..good.clone() },
        Brush { path: vec![[f64::NAN, 0.0]], ..good.clone() },
        Brush { path: vec![[0.0, 0.0]; 10_001], ..good.clone() },
        Brush { radius: 0.0, ..good.clone() },
        Brush { strength: 1.5, ..good.clone() },
        Brush { effect: Effect::AddWater { depth: -1.0 }, ..good.clone() },
        Brush { effect: Effect::Flatten { height: f64::INFINITY }, ..good },
    ];
    for brush in faulty {
        let mut canvas = before.clone();
        let error = brush.paint(&mut canvas).expect_err("no stroke");
        assert!(error.to_string().starts_with("a brush cannot paint: "), "{error}");
        assert_eq!(canvas, before);
    }
}

fn any_script() -> impl Strategy<Value = Script> {
    let edit = (0_u64..600, any_brush()).prop_map(|(step, brush)| Edit { step, brush });
    prop::collection::vec(edit, 0..12).prop_map(Script::new)
}

proptest! {
    #[test]
    fn a_script_reads_as_it_was_written(script in any_script()) {
        for layout in [Layout::JsonLines, Layout::Toml] {
            let text = script.text(layout);
            let read = Script::parse("s", &text, layout, &MATERIALS).expect("what was written is good");
            prop_assert_eq!(&read, &script);
            prop_assert_eq!(read.text(layout), text);
        }
    }

    #[test]
    fn no_text_makes_the_parser_of_scripts_panic(text in any::<String>(), key in "[a-z]{1,9}") {
        for layout in [Layout::JsonLines, Layout::Toml] {
            let _ = Script::parse("s", &text, layout, &MATERIALS);
            let _ = Script::parse("s", &format!("{{\"{key}\": {text:?}}}"), layout, &MATERIALS);
        }
    }
}

fn parse(text: &str) -> Result<Script, Error> {
    Script::parse("s.jsonl", text, Layout::JsonLines, &MATERIALS)
}

#[test]
fn edits_happen_in_the_order_of_their_steps_and_of_the_file() {
    let line = |step: u64, depth: u64| {
        format!("{{\"step\": {step}, \"do\": \"add-water\", \"depth\": {depth}, \"path\": [1, 2]}}\n")
    };
    let script = parse(&[line(7, 1), line(0, 2), line(7, 3), line(2, 4)].concat()).expect("good");
    assert_eq!(script.edits().iter().map(|edit| edit.step).collect::<Vec<_>>(), [0, 2, 7, 7]);
    let depths: Vec<_> = script.before(7).iter().map(|edit| edit.brush.effect.clone()).collect();
    assert_eq!(depths, [1.0, 3.0].map(|depth| Effect::AddWater { depth }));
    assert_eq!([0, 1, 3, 8].map(|step| script.next_from(step)), [Some(0), Some(2), Some(7), None]);
}

#[test]
fn faults_of_a_script_come_with_their_lines_and_what_was_probably_meant() {
    let text = "{\"do\": \"ad\", \"path\": [1, 2]}\n\n\
                {\"do\": \"add\", \"material\": \"snad\", \"thickness\": 1, \"path\": [1, 2]}\n\
                {\"do\": \"smooth\", \"height\": 3, \"path\": [1, 2], \"radiu\": 5}\n\
                {\"do\": \"add-water\", \"depth\": -3, \"path\": [1]}\n\
                {\"do\": \"flatten\"\n\
                [3]\n\
                {\"do\": \"flatten\", \"path\": [[1, 2], [3, 4]]}\n";
    let message = parse(text).expect_err("faulty").to_string();
    for told in [
        "s.jsonl:1: edit: `do` is \"ad\"; did you mean `add`?",
        "s.jsonl:3: add: `material` is \"snad\", of which there is none; did you mean `sand`?",
        "s.jsonl:4: smooth: unknown key `radiu`; did you mean `radius`?",
        "s.jsonl:4: smooth: `height` does not go with `smooth`",
        "s.jsonl:5: add-water: `depth` is -3, outside its range: 0 to 100000",
        "s.jsonl:5: add-water: `path` is a list, but must be a place `[x, y]`",
        "s.jsonl:6: is no JSON",
        "s.jsonl:7: is a list, but must be { … }",
        "s.jsonl:8: flatten: `height` is needed",
    ] {
        assert!(message.contains(told), "{told}\nis not in\n{message}");
    }
    let toml = "[[edit]]\ndo = \"thaw\"\npath = [[1, 2], [3, \"4\"]]\n";
    let message = Script::parse("s.toml", toml, Layout::Toml, &MATERIALS).expect_err("faulty").to_string();
    assert!(message.contains("s.toml:3: thaw: `path` is a list"), "{message}");
}

#[test]
fn a_script_over_its_limits_is_refused_before_it_is_kept() {
    let thaw = "{\"do\": \"thaw\", \"path\": [1, 2]}\n";
    assert_eq!(parse(&thaw.repeat(1000)).expect("within").edits().len(), 1000);
    for (text, layout) in [
        (thaw.repeat(100_001), Layout::JsonLines),
        (" ".repeat((16 << 20) + 1), Layout::JsonLines),
        (" ".repeat((1 << 20) + 1), Layout::Toml),
    ] {
        let error = Script::parse("s", &text, layout, &MATERIALS).expect_err("too much");
        assert_eq!(error.exit_code(), 5, "{error}");
    }
    let long = format!("{{\"do\": \"thaw\", \"path\": [{}[1, 2]]}}", "[1, 2], ".repeat(10_000));
    let message = parse(&long).expect_err("too long a line").to_string();
    assert!(message.contains("`path` has 10001 places"), "{message}");
}

#[test]
fn a_script_goes_through_a_file_of_either_kind() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = Script::new(vec![Edit { step: 3, brush: dab(Effect::Source { rate: 0.1 }) }]);
    for name in ["s.jsonl", "s.toml"] {
        let path = folder.path().join(name);
        script.save(&path).expect("written");
        assert_eq!(Script::load(&path, &MATERIALS).expect("read"), script);
    }
    assert_eq!(
        Script::load(&folder.path().join("none.toml"), &MATERIALS).expect_err("missing").exit_code(),
        4
    );
    assert!(script.save(&folder.path().join("s.txt")).is_err());
}

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

    fn snapshot(&self) -> Canvas {
        self.0.clone()
    }

    fn restore(&mut self, snapshot: &Canvas) {
        self.0.clone_from(snapshot);
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
        toy.snapshot()
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
    steps.iter().for_each(|action| history.act(action.clone()).expect("good"));
    assert!(history.undo().expect("replays") && history.undo().expect("replays"));
    let other = Action::Steps(9);
    history.act(other.clone()).expect("good");
    assert_eq!(history.actions(), [steps[0].clone(), other.clone()]);
    assert!(!history.redo().expect("nothing to do"));
    assert_eq!(&history.session().0, &states(&[steps[0].clone(), other])[2]);
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
