use proptest::prelude::*;
use weald_core::Error;
use weald_land::edit::{Edit, Effect, Layout, Script};

use super::{MATERIALS, any_brush, dab};

fn any_script() -> impl Strategy<Value = Script> {
    let edit = (0_u64..600, any_brush()).prop_map(|(step, brush)| Edit::stroke(step, brush));
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
    let depths: Vec<_> =
        script.before(7).iter().map(|edit| edit.brush().expect("a stroke").effect.clone()).collect();
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
                {\"do\": \"flatten\", \"path\": [[1, 2], [3, 4]]}\n\
                {\"do\": \"thaw\", \"path\": [1, 2], \"radius\": 5, \"radius\": 6}\n";
    let message = parse(text).expect_err("faulty").to_string();
    for expected in [
        "s.jsonl:1: edit: `do` is \"ad\"; did you mean `add`?",
        "s.jsonl:3: add: `material` is \"snad\", of which there is none; did you mean `sand`?",
        "s.jsonl:4: smooth: unknown key `radiu`; did you mean `radius`?",
        "s.jsonl:4: smooth: `height` does not go with `smooth`",
        "s.jsonl:5: add-water: `depth` is -3, outside its range: 0 to 100000 m",
        "s.jsonl:5: add-water: `path` has 1 numbers, but a place has two, `[x, y]`",
        "s.jsonl:6: is no JSON",
        "s.jsonl:7: is a list, but must be { … }",
        "s.jsonl:8: flatten: `height` is needed",
        "s.jsonl:9: column 56: duplicate key: `radius`",
    ] {
        assert!(message.contains(expected), "{expected}\nis not in\n{message}");
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
    let script = Script::new(vec![Edit::stroke(3, dab(Effect::Source { rate: 0.1 }))]);
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
