//! The catalogue keeps its word: every step is documented, refuses what is out of range, and writes the layers
//! that it declares and no others.

mod effects;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use proptest::prelude::*;
use weald::domain::Domain;
use weald::engine::Job;
use weald::grid::Mask;
use weald::io;
use weald::material::layer_names;
use weald::picture::PICTURES;
use weald::random::{hash2, unit};
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Diagnostics, Kind, Parameter, Variant};
use weald::recipe::source::{self, Node, Table, Value};
use weald::recipe::{Overrides, Recipe};
use weald::step::{Entry, Layered, Stage, Step};
use weald::{Field, Landscape, Size};

#[test]
fn names_are_unique_and_every_step_says_what_it_does_and_where_it_is_from() {
    let names: BTreeSet<_> = CATALOG.iter().map(|entry| entry.name).collect();
    assert_eq!(names.len(), CATALOG.len(), "each name stands for one step");
    for entry in CATALOG {
        let kebab = entry.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
        assert!(kebab, "{} is in lower case with hyphens", entry.name);
        assert!(entry.summary.len() > 10, "{} says what it does", entry.name);
        assert!(!entry.source.is_empty(), "{} says where it is from", entry.name);
    }
}

#[test]
fn every_parameter_has_a_text_a_unit_and_a_range() {
    for entry in CATALOG {
        check_documented(entry.name, &(entry.parameters)());
    }
    for picture in PICTURES {
        check_documented(picture.name, &(picture.parameters)());
    }
}

fn check_documented(owner: &str, parameters: &[Parameter]) {
    for parameter in parameters {
        let name = format!("{owner}.{}", parameter.name);
        assert!(parameter.doc.len() > 5, "{name} is explained");
        assert!(!parameter.unit.is_empty(), "{name} has a unit");
        match &parameter.kind {
            Kind::Number(low, high) | Kind::Integer(low, high) | Kind::Numbers(low, high) => {
                assert!(low < high, "{name} has a range");
            }
            Kind::Table(inner) | Kind::Tables(inner) => check_documented(&name, inner),
            Kind::Variants(variants) => {
                for variant in variants {
                    assert!(variant.doc.len() > 5, "{name} = {:?} is explained", variant.word);
                    check_documented(&name, &variant.parameters);
                }
            }
            _ => {}
        }
    }
}

/// The keys that a table cannot do without, each on a line of its own.
fn needed(parameters: &[Parameter]) -> String {
    let needed = parameters.iter().filter(|parameter| parameter.required);
    let lines = needed.map(|parameter| format!("{} = {}", parameter.name, some_value(parameter)));
    lines.chain([String::new()]).collect::<Vec<_>>().join("\n")
}

fn some_value(parameter: &Parameter) -> String {
    match &parameter.kind {
        Kind::Number(low, high) => format!("{:?}", between(*low, *high)),
        Kind::Integer(low, _) => format!("{}", low.max(1.0)),
        Kind::Flag => "true".to_owned(),
        Kind::Choice(words) => format!("{:?}", words[0]),
        Kind::Variants(variants) => format!("{:?}", variants[0].word),
        Kind::Choices(words) => format!("[{:?}]", words[0]),
        Kind::Rows => "[[0.5, 0.0, 0.0, 0.5, 0.0, 0.0]]".to_owned(),
        Kind::Flame => "\"one.flame\"".to_owned(),
        Kind::Numbers(low, high) => format!("[{:?}]", between(*low, *high)),
        Kind::Sides => "16".to_owned(),
        Kind::Places => "[1.0, 2.0]".to_owned(),
        Kind::Layer | Kind::Text => format!("\"{}_layer\"", parameter.name),
        Kind::Layers => format!("[\"{}_layer\"]", parameter.name),
        Kind::Script => "\"edits.jsonl\"".to_owned(),
        Kind::Colour => "\"#102030\"".to_owned(),
        Kind::Crs => "\"EPSG:32633\"".to_owned(),
        Kind::Raster => format!("{:?}", some_raster()),
        Kind::Table(inner) => format!("{{ {} }}", needed(inner).trim().replace('\n', ", ")),
        Kind::Tables(inner) => format!("[{{ {} }}]", needed(inner).trim().replace('\n', ", ")),
    }
}

/// The middle of a range, or a number within one that has no end.
fn between(low: f64, high: f64) -> f64 {
    let middle = (low + high) / 2.0;
    if middle.is_finite() { middle } else { 1.0_f64.clamp(low, high) }
}

/// A raster file of as many cells as the ground that steps are given here.
fn some_raster() -> String {
    static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("catalog.npy");
        let size = Size::square(16).expect("small");
        io::write(&path, &Field::filled(size, 3.5).into()).expect("a raster is written");
        path
    });
    FILE.display().to_string()
}

/// The step of a text of keys, and what is wrong with it.
fn read(entry: &Entry, text: &str) -> (Box<dyn Step>, Vec<String>) {
    read_table(entry, &text_table(text))
}

fn read_table(entry: &Entry, table: &Table) -> (Box<dyn Step>, Vec<String>) {
    let mut diagnostics = Diagnostics { subject: entry.name.to_owned(), ..Diagnostics::default() };
    let step = (entry.read)(table, &mut diagnostics);
    let shown = diagnostics.found.iter().map(|fault| format!("{}: {}", fault.line, fault.message)).collect();
    (step, shown)
}

#[test]
fn every_step_takes_its_defaults_unsaid_and_said() {
    for entry in CATALOG {
        for (word, parameters) in choices(&(entry.parameters)()) {
            let least = word + &needed(&parameters);
            assert_eq!(read(entry, &least).1, [""; 0], "{} with what is needed", entry.name);
            let (given, known): (_, Vec<_>) = (text_table(&least), parameters.iter().collect());
            let has_effect = |one: &&Parameter| one.needs.iter().all(|needs| needs.is_met(&given, &known));
            let said = parameters.iter().filter(has_effect).filter_map(|parameter| {
                let default = parameter.default.as_ref().filter(|_| given.get(parameter.name).is_none())?;
                Some(format!("{} = {default}\n", parameter.name))
            });
            let all = least.clone() + &said.collect::<String>();
            assert_eq!(read(entry, &all).1, [""; 0], "{} with all defaults", entry.name);
        }
    }
}

/// Steps that `docs/commands.md` names, in the order of the catalogue, without `flow`; `hydraulic` by two of its models.
const BY_ROWS: [&str; 17] = [
    "fbm",
    "ridged",
    "constant",
    "load",
    "add",
    "max",
    "min",
    "blend",
    "terrace",
    "smooth",
    "hydraulic",
    "hydraulic",
    "slope",
    "aspect",
    "curvature",
    "soil",
    "select",
];

#[test]
fn every_step_runs_on_landscapes_that_no_process_holds_or_is_refused_by_name_before_it_runs() {
    let (mut by_rows, mut refused_by_name) = (Vec::new(), 0);
    for entry in CATALOG {
        for (word, parameters) in choices(&(entry.parameters)()) {
            let keys = word + &needed(&parameters);
            let (step, _) = read(entry, &keys);
            if step.scratch_per_cell(&BTreeSet::new()).is_ok() {
                by_rows.push(entry.name);
                continue;
            }
            let written = step.writes().first().map_or("height".to_owned(), |(name, _)| name.clone());
            let ground = (written != "height").then(|| "height".to_owned());
            let names: BTreeSet<_> = step.reads().into_iter().chain(ground).collect();
            let made = names.iter().map(|name| format!("[[step]]\ndo = \"fbm\"\ninto = {name:?}\n"));
            let text = format!(
                "[landscape]\nsize = 8\n{}[[step]]\ndo = {:?}\n{keys}[[output]]\nlayer = {written:?}\nfile = \"o.tif\"\n",
                made.collect::<String>(),
                entry.name
            );
            // A recipe that is wrong for other reasons says nothing of this one.
            let Ok(recipe) = Recipe::parse("r.toml", &text, &Overrides::default()) else { continue };
            let refused = recipe.scratch().expect_err(entry.name).to_string();
            let expected = format!("a run out of core cannot make this: the step `{}`: ", entry.name);
            assert!(refused.contains(&expected), "{refused}");
            refused_by_name += 1;
        }
    }
    let flow = by_rows.pop();
    assert_eq!((by_rows.as_slice(), flow), (&BY_ROWS[..], Some("flow")));
    assert!(refused_by_name > 20, "{refused_by_name} were refused");
}

/// The parameters that a table can have at once, with the line that chooses them: once for each of its variants.
fn choices(parameters: &[Parameter]) -> Vec<(String, Vec<Parameter>)> {
    let variants = parameters.iter().find_map(|by| match &by.kind {
        Kind::Variants(variants) => Some((by.name, variants)),
        _ => None,
    });
    let Some((by, variants)) = variants else { return vec![(String::new(), parameters.to_vec())] };
    let of = |variant: &Variant| {
        let all = parameters.iter().chain(&variant.parameters).cloned().collect();
        (format!("{by} = {:?}\n", variant.word), all)
    };
    variants.iter().map(of).collect()
}

fn text_table(text: &str) -> Table {
    source::parse("r.toml", text).unwrap_or_else(|error| panic!("{text:?} is TOML: {error}"))
}

/// Values just outside a parameter's range, in TOML, by a share of its bounds.
fn outside(kind: &Kind, share: f64) -> Vec<String> {
    match kind {
        Kind::Number(low, high) => {
            let beyond = |bound: f64| share * bound.abs().max(1.0);
            vec![format!("{:?}", low - beyond(*low)), format!("{:?}", high + beyond(*high))]
        }
        Kind::Integer(low, high) if *high < 9.0e18 => {
            vec![format!("{}", low - 1.0), format!("{}", high + 1.0)]
        }
        Kind::Integer(low, _) => vec![format!("{}", low - 1.0)],
        _ => Vec::new(),
    }
}

/// A table in which one key, perhaps deep inside, has this value, on line 1; `choice` stands below.
fn with_value(path: &[&Parameter], value: &str, choice: &str) -> String {
    let (last, outer) = path.split_last().expect("a path has a key");
    let inner = format!("{} = {value}", last.name);
    let line = outer.iter().rev().fold(inner, |inner, Parameter { name, kind, .. }| match kind {
        Kind::Tables(_) => format!("{name} = [{{ {inner} }}]"),
        _ => format!("{name} = {{ {inner} }}"),
    });
    format!("{line}\n{choice}")
}

fn check_refusals<'a>(
    (entry, choice): (&Entry, &str),
    path: &mut Vec<&'a Parameter>,
    parameters: &'a [Parameter],
    share: f64,
) {
    for parameter in parameters {
        path.push(parameter);
        if let Kind::Table(inner) | Kind::Tables(inner) = &parameter.kind {
            check_refusals((entry, choice), path, inner, share);
        }
        for value in outside(&parameter.kind, share) {
            let (_, faults) = read(entry, &with_value(path, &value, choice));
            let range = parameter.kind.in_words();
            let (_, bounds) = range.split_once(", ").expect("a number's kind names its bounds");
            let shown = value.strip_suffix(".0").unwrap_or(&value);
            let expected = faults.iter().any(|fault| {
                fault.starts_with("1: ")
                    && fault.contains(&format!("`{}`", parameter.name))
                    && fault.contains(bounds)
                    && (fault.contains(shown) || fault.contains(&as_displayed(&value)))
            });
            assert!(
                expected,
                "{}.{} = {value} must be refused with {bounds}: {faults:?}",
                entry.name, parameter.name
            );
        }
        path.pop();
    }
}

fn as_displayed(value: &str) -> String {
    value.parse::<f64>().map_or_else(|_| value.to_owned(), |number| number.to_string())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn a_value_outside_its_range_is_refused_with_line_key_value_and_range(exponent in -9.0_f64..6.0) {
        for entry in CATALOG {
            for (choice, parameters) in choices(&(entry.parameters)()) {
                check_refusals((entry, &choice), &mut Vec::new(), &parameters, 10_f64.powf(exponent));
            }
        }
    }

    #[test]
    fn a_value_of_any_type_is_taken_or_refused_but_never_a_panic(which in 0_usize..6, number in any::<i64>()) {
        let value = [
            Value::Flag(true),
            Value::Integer(number),
            Value::Number(f64::from_bits(number as u64)),
            Value::Text(number.to_string()),
            Value::List(vec![Node { line: 1, value: Value::Integer(number) }]),
            Value::Table(Table::default()),
        ];
        for entry in CATALOG {
            for parameter in (entry.parameters)() {
                let node = Node { line: 1, value: value[which].clone() };
                let table = Table { line: 1, entries: vec![(parameter.name.to_owned(), node)] };
                let (step, faults) = read_table(entry, &table);
                if faults.is_empty() {
                    let _ = (step.faults(), step.reads(), step.writes(), step.resized());
                }
            }
        }
    }
}

#[test]
fn a_key_of_another_model_by_default_is_refused_too() {
    let entry = CATALOG.iter().find(|entry| entry.name == "hydraulic").expect("it is there");
    let (_, faults) = read(entry, "iterations = 3\ndeposition = 0.5\n");
    let expected = "2: hydraulic: `deposition` has no effect with model = \"han\": it is a key of model = \"mei\" or \
                \"stava\"; set that, or remove it";
    assert_eq!(faults, [expected]);
}

/// The complaint of a recipe that begins with ground of rock and soil.
fn refusal(step: &str) -> String {
    let text = format!(
        "[landscape]\nsize = 8\n[[step]]\ndo = \"plane\"\n[[step]]\n{step}\n[[output]]\nlayer = \"height\"\n\
         file = \"a.tif\"\n"
    );
    Recipe::parse("r.toml", &text, &Overrides::default()).expect_err(step).to_string()
}

#[test]
fn a_fault_of_several_keys_is_told_at_the_line_of_one_of_them() {
    let expected = |step: &str, words: &str| {
        let message = refusal(step);
        assert!(message.starts_with(&format!("r.toml:{words}")), "{message}");
    };
    expected(
        "do = \"hydraulic\"\nregion = \"height\"\nboundary = \"open\"",
        "8: hydraulic: `boundary` must be",
    );
    expected(
        "do = \"select\"\nwhere = [\n{ layer = \"height\", above = 1 },\n\
         { layer = \"height\", above = 3, below = 1 },\n]",
        "9: select: the condition",
    );
    expected("do = \"hydraulic\"\nmodel = \"stava\"\ndeposit = \"sand\"", "8: hydraulic: `deposit` is");
    expected(
        "do = \"hydraulic\"\nmodel = \"stava\"\n\nslippage = { strength = 0.2 }",
        "9: hydraulic: `strength` is 0.2",
    );
    expected(
        "do = \"hydraulic\"\niterations = 3\nlaw = \"dissolution\"\nmodel = \"mei\"",
        "8: hydraulic: `law` has no effect",
    );
}

/// Unit of the layers that a step is given here.
const INPUT_UNIT: &str = "m";

/// Ground for a step: the layers it reads, and one that is none of its business.
fn ground_for(step: &dyn Step, land: Option<Mask>) -> Landscape {
    let size = Size::square(16).expect("small");
    let domain = Domain { valid: land, ..Domain::new(size, 10.0) };
    // A step that works at a coast has one.
    let sea_level = step.check_on(&domain).is_err().then_some(0.3);
    let mut landscape = Landscape::new(Domain { sea_level, ..domain });
    let names = step.reads().into_iter().chain(["bystander".to_owned()]);
    for (seed, name) in names.enumerate() {
        let random = |x, y| unit(hash2(seed as u64, x as i64, y as i64)) as f32;
        // Not all numbers are directions; 0 is.
        let value = |x, y| if name == "flow_direction" { 0.0 } else { random(x, y) };
        landscape.insert(&name, INPUT_UNIT, Field::from_function(size, value));
    }
    landscape
}

fn check_writes(entry: &Entry, land: Option<Mask>) {
    let name = entry.name;
    let (step, faults) = read(entry, &needed(&(entry.parameters)()));
    assert_eq!(faults, [""; 0]);
    let before = ground_for(step.as_ref(), land);
    let mut after = before.clone();
    step.run(&mut after, &Job::unwatched(7)).unwrap_or_else(|error| panic!("{name} runs: {error}"));
    let mut writes = step.writes();
    if step.layered() == Layered::Changes {
        writes.extend(layer_names(&before.materials).map(|layer| (layer.to_owned(), "m")));
    }
    for (layer, unit) in &writes {
        let written = after.layer(layer).unwrap_or_else(|error| panic!("{name} writes {layer}: {error}"));
        let declared = if unit.starts_with("unit of ") { INPUT_UNIT } else { *unit };
        assert_eq!(written.unit, declared, "{name}: the unit of {layer}");
        assert_eq!(written.field.first_not_finite(after.domain.valid.as_ref()), None, "{name}: {layer}");
        check_range(entry, step.as_ref(), layer, &after);
    }
    let declared: BTreeSet<_> = writes.into_iter().map(|(layer, _)| layer).collect();
    let known = |layer: &str| declared.contains(layer) || before.layer(layer).is_ok();
    assert!(after.layers().all(|(layer, _)| known(layer)), "{name} writes only what it declares");
    if step.resized().is_some() {
        return;
    }
    assert_eq!(before.domain, after.domain, "{name} leaves the domain alone");
    for (layer, old) in before.layers().filter(|(layer, _)| !declared.contains(*layer)) {
        assert_eq!(after.layer(layer).ok(), Some(old), "{name} leaves {layer} alone");
    }
}

/// A layer holds nothing outside the range that its step declares; layers of analyses all have one.
fn check_range(entry: &Entry, step: &dyn Step, layer: &str, after: &Landscape) {
    let range = step.range(layer);
    assert!(range.is_some() || entry.stage != Stage::Analyse, "{}: {layer} has a range", entry.name);
    let Some((low, high)) = range else { return };
    assert!(low < high, "{}: {layer} from {low} to {high}", entry.name);
    let held = after.field(layer).expect("written").range(after.domain.valid.as_ref());
    let (least, most) = held.expect("there are cells with data");
    let within = f64::from(least) >= low && f64::from(most) <= high;
    assert!(within, "{}: {layer} holds {least} to {most}, outside {low} to {high}", entry.name);
}

#[test]
fn declared_layers_are_written_and_nothing_else() {
    for entry in CATALOG {
        check_writes(entry, None);
    }
}

#[test]
fn declared_layers_are_written_where_cells_have_no_data() {
    let size = Size::square(16).expect("small");
    let flags: Vec<_> = (0..size.cells()).map(|index| index % 16 > 2 && index % 7 != 0).collect();
    for entry in CATALOG {
        check_writes(entry, Mask::new(size, flags.clone()));
    }
}
