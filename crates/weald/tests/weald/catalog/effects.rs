//! Keys that another key or a choice leaves without effect are refused at their line, with what would give them one.

use weald::export::EXPORTS;
use weald::grow::ifs::deform::DeformKeys;
use weald::picture::PICTURES;
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Diagnostics, Kind, Needs, Parameter, Parameters, check_file};
use weald::recipe::source::Table;
use weald::recipe::{FilmKeys, FractalKeys, LandscapeKeys, MaterialKeys};

use super::{choices, some_value, text_table};

/// Reads a table.
type Reader = Box<dyn Fn(&Table, &mut Diagnostics)>;

/// Tables of a recipe: what they are called, their keys, and how they are read.
struct Kept {
    name: &'static str,
    parameters: Vec<Parameter>,
    read: Reader,
}

fn kept<T: Parameters + 'static>(name: &'static str) -> Kept {
    let read = |table: &Table, diagnostics: &mut Diagnostics| drop(T::read(table, diagnostics));
    Kept { name, parameters: T::parameters(), read: Box::new(read) }
}

/// All that a recipe can hold.
fn all_tables() -> Vec<Kept> {
    let steps = CATALOG.iter().map(|entry| {
        let read = |table: &Table, diagnostics: &mut Diagnostics| drop((entry.read)(table, diagnostics));
        Kept { name: entry.name, parameters: (entry.parameters)(), read: Box::new(read) }
    });
    let pictures = PICTURES.iter().map(|entry| {
        let read = |table: &Table, diagnostics: &mut Diagnostics| drop((entry.read)(table, diagnostics));
        Kept { name: entry.name, parameters: (entry.parameters)(), read: Box::new(read) }
    });
    let exports = EXPORTS.iter().map(|entry| {
        let read = |table: &Table, diagnostics: &mut Diagnostics| drop((entry.read)(table, diagnostics));
        Kept { name: entry.name, parameters: (entry.parameters)(), read: Box::new(read) }
    });
    let others = [
        kept::<LandscapeKeys>("landscape"),
        kept::<MaterialKeys>("material"),
        kept::<FractalKeys>("fractal"),
        kept::<DeformKeys>("deform"),
        kept::<FilmKeys>("film"),
    ];
    steps.chain(pictures).chain(exports).chain(others).collect()
}

impl Kept {
    /// What is said of a key that has no effect in a text whose first line has it.
    fn expected(&self, text: &str, key: &str) -> Option<String> {
        let mut diagnostics = Diagnostics::default();
        (self.read)(&text_table(text), &mut diagnostics);
        check_file(&text_table(text), &self.parameters, &mut diagnostics);
        let named = format!("`{key}` has no effect");
        let of_key = diagnostics.found.into_iter().find(|one| one.message.contains(&named))?;
        assert_eq!(of_key.line, 1, "{}: {text}: {}", self.name, of_key.message);
        Some(of_key.message)
    }

    /// The key of the first line has no effect, and the message names what would give it one.
    fn refuses(&self, place: &Place<'_>, lines: &[String], remedy: &str) {
        let (text, key) = (place.text(lines), key_of(&lines[0]));
        let expected = self.expected(&text, key).unwrap_or_else(|| panic!("{}: {text} is taken", self.name));
        assert!(expected.contains(remedy), "{}: {text}: {expected} names no {remedy}", self.name);
    }

    fn takes(&self, place: &Place<'_>, lines: &[String]) {
        let text = place.text(lines);
        assert_eq!(self.expected(&text, key_of(&lines[0])), None, "{}: {text}", self.name);
    }
}

fn key_of(line: &str) -> &str {
    line.split(' ').next().unwrap_or_default()
}

/// Where a table lies in others, and what stands beside the outermost of them.
#[derive(Clone, Default)]
struct Place<'a> {
    path: Vec<&'a Parameter>,
    beside: String,
}

impl Place<'_> {
    fn text(&self, lines: &[String]) -> String {
        if self.path.is_empty() {
            return lines.join("\n");
        }
        let given: Vec<_> = lines.iter().filter(|line| !line.is_empty()).map(String::as_str).collect();
        let inner = self.path.iter().rev().fold(given.join(", "), |inner, outer| match outer.kind {
            Kind::Tables(_) => format!("{} = [{{ {inner} }}]", outer.name),
            _ => format!("{} = {{ {inner} }}", outer.name),
        });
        format!("{inner}\n{}", self.beside)
    }
}

fn given(parameter: &Parameter) -> String {
    format!("{} = {}", parameter.name, some_value(parameter))
}

/// Lines that take the effect of a key away, each with what the message must name.
fn against(needs: &Needs, all: &[Parameter]) -> Vec<(String, String)> {
    let named = |key: &str| all.iter().find(|one| one.name == key).expect("it is declared");
    match needs {
        Needs::Value(key, values) => {
            vec![(format!("{key} = {}", other_than(named(key), values)), values[0].to_owned())]
        }
        Needs::OtherValue(key, values) => {
            values.iter().map(|value| (format!("{key} = {value}"), (*value).to_owned())).collect()
        }
        Needs::Given(keys) => vec![(String::new(), keys[0].to_owned())],
        Needs::Absent(key) => vec![(given(named(key)), (*key).to_owned())],
        Needs::File(extensions) => vec![("file = \"a.other\"".to_owned(), format!(".{}", extensions[0]))],
    }
}

/// A line that does what a key needs.
fn meeting(needs: &Needs, all: &[Parameter]) -> String {
    let named = |key: &str| all.iter().find(|one| one.name == key).expect("it is declared");
    match needs {
        Needs::Value(key, values) => format!("{key} = {}", values[0]),
        Needs::OtherValue(key, values) => format!("{key} = {}", other_than(named(key), values)),
        Needs::Given(keys) => given(named(keys[0])),
        Needs::Absent(_) => String::new(),
        Needs::File(extensions) => format!("file = \"a.{}\"", extensions[0]),
    }
}

/// A value of a key, in TOML, that is none of these.
fn other_than(parameter: &Parameter, values: &[&str]) -> String {
    let all: Vec<String> = match &parameter.kind {
        Kind::Choice(words) => words.iter().map(|word| format!("{word:?}")).collect(),
        _ => vec!["true".to_owned(), "false".to_owned()],
    };
    all.into_iter().find(|value| !values.contains(&value.as_str())).expect("another value")
}

/// Tries every key that another key can leave without effect, with that and without; gives how many ways there are.
fn check_needs(table: &Kept, place: &Place<'_>, parameters: &[Parameter]) -> usize {
    let mut tried = 0;
    for (choice, all) in choices(parameters) {
        let choice = choice.trim().to_owned();
        // The word that chooses is in every text already.
        for parameter in all.iter().filter(|one| !matches!(one.kind, Kind::Variants(_))) {
            for (at, needs) in parameter.needs.iter().enumerate() {
                let others = parameter.needs.iter().enumerate().filter(|(other, _)| *other != at);
                let others: Vec<_> = others.map(|(_, needs)| meeting(needs, &all)).collect();
                for (line, remedy) in against(needs, &all) {
                    let lines = [vec![given(parameter), choice.clone(), line], others.clone()].concat();
                    table.refuses(place, &lines, &remedy);
                    tried += 1;
                }
            }
            let met = parameter.needs.iter().map(|needs| meeting(needs, &all)).collect();
            table.takes(place, &[vec![given(parameter), choice.clone()], met].concat());
            if let Kind::Table(inner) | Kind::Tables(inner) = &parameter.kind {
                let mut deeper = Place { path: place.path.clone(), beside: place.beside.clone() };
                deeper.path.push(parameter);
                if place.path.is_empty() {
                    deeper.beside.clone_from(&choice);
                }
                tried += check_needs(table, &deeper, inner);
            }
        }
    }
    tried
}

/// Tries every key of every variant beside each of the variants that have it not; gives how many.
fn check_variants(table: &Kept) -> usize {
    let mut tried = 0;
    for by in &table.parameters {
        let Kind::Variants(variants) = &by.kind else { continue };
        for (chosen, other) in variants.iter().flat_map(|one| variants.iter().map(move |other| (one, other)))
        {
            let has = |key: &str| chosen.parameters.iter().any(|own| own.name == key);
            for strange in other.parameters.iter().filter(|strange| !has(strange.name)) {
                let choice = format!("{} = {:?}", by.name, chosen.word);
                table.refuses(&Place::default(), &[given(strange), choice], &format!("{:?}", other.word));
                tried += 1;
            }
        }
    }
    tried
}

#[test]
fn a_key_that_a_choice_leaves_without_effect_is_refused_at_its_line() {
    let [mut by_variant, mut by_need] = [0, 0];
    for table in all_tables() {
        by_variant += check_variants(&table);
        by_need += check_needs(&table, &Place::default(), &table.parameters);
    }
    println!("{by_variant} keys of other variants and {by_need} keys without what they need were refused");
    assert!(by_variant >= 28 && by_need >= 100, "{by_variant}, {by_need}: the catalogue has such keys");
}
