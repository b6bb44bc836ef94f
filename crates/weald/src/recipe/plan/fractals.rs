//! The `[[fractal]]` tables: plants and sets that pictures and later steps name.

mod keys;
mod names;
mod written;

use self::keys::line_of;
pub use self::keys::{FractalKeys, FractalSource, PlannedFractal, PlantRole};

pub(in crate::recipe::plan) use self::names::check_names;
use self::written::Written;
use super::files::Files;
use super::words::tables;
use weald_core::parameter::{Diagnostics, Nested, Parameters};
use weald_core::source::{Table, Value};
use weald_plants::Fractal;
use weald_plants::ifs::Ifs;
use weald_plants::ifs::deform::DeformKeys;

pub(super) fn read(files: Files<'_>, recipe: &Table, diagnostics: &mut Diagnostics) -> Vec<PlannedFractal> {
    "fractal".clone_into(&mut diagnostics.subject);
    let mut fractals: Vec<PlannedFractal> = Vec::new();
    for table in tables(recipe, "fractal", diagnostics) {
        let before = diagnostics.found.len();
        let placed = files.placed(table, &FractalKeys::parameters(), diagnostics);
        let keys = FractalKeys::read(&placed, diagnostics);
        if let Some(twin) = fractals.iter().find(|earlier| earlier.name == keys.name.0) {
            let message =
                format!("`name` is {:?} a second time; line {} has it first", keys.name.0, twin.line);
            diagnostics.add(line_of(table, "name"), message);
        }
        if diagnostics.found.len() > before {
            continue;
        }
        match (Written { table, keys: &keys }).fractal_source() {
            Ok(fractal_source) => fractals.push(planned(table, keys, fractal_source, diagnostics)),
            Err((line, message)) => diagnostics.add(line, message),
        }
    }
    fractals
}

/// The fractal, once its deformations fit it.
fn planned(
    table: &Table,
    keys: FractalKeys,
    fractal_source: FractalSource,
    diagnostics: &mut Diagnostics,
) -> PlannedFractal {
    let deform: Vec<DeformKeys> = keys.deform.into_iter().map(|Nested(keys)| keys).collect();
    if let FractalSource::Known(ifs) = &fractal_source {
        for (line, fault) in deform_faults(table, ifs, &deform) {
            diagnostics.add(line, fault);
        }
    }
    PlannedFractal { line: table.line, name: keys.name.0, fractal_source, deform }
}

/// What stands against each deformation alone, with its line, or against all of them together.
fn deform_faults(table: &Table, ifs: &Ifs, deform: &[DeformKeys]) -> Vec<(usize, String)> {
    let node = table.get("deform");
    let lines: Vec<usize> = match node.map(|node| &node.value) {
        Some(Value::List(items)) => items.iter().map(|item| item.line).collect(),
        _ => Vec::new(),
    };
    let fractal = |deform: &[DeformKeys]| {
        let deform = deform.to_vec();
        Fractal { name: String::new(), ifs: ifs.clone(), deform }.deformation().err().unwrap_or_default()
    };
    let mut faults = Vec::new();
    for (one, &line) in deform.iter().zip(&lines) {
        let kind = one.by.map_or("deform", |by| by.word());
        faults.extend(
            fractal(std::slice::from_ref(one)).into_iter().map(|fault| (line, format!("{kind}: {fault}"))),
        );
    }
    if faults.is_empty() {
        let line = node.map_or(table.line, |node| node.line);
        faults.extend(fractal(deform).into_iter().map(|fault| (line, fault)));
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::testing::{parse, refusal};
    use weald_plants::ifs::Role;

    /// A recipe whose fractal begins on line 2, and its name stands on line 3.
    fn recipe(keys: &str) -> String {
        format!(
            "# fractals\n[[fractal]]\nname = \"mine\"\n{keys}[landscape]\nsize = 4\n[[step]]\ndo = \"rough\"\n\
             [[output]]\nlayer = \"height\"\nfile = \"a.bits\"\n"
        )
    }

    const HALVES: &str = "maps = [\n[0.5, 0, 0, 0.5, 0, 0],\n[0.5, 0, 0, 0.5, 0.5, 0],\n]\n";

    fn known(keys: &str) -> Ifs {
        let recipe = parse(&recipe(keys)).expect("good");
        match &recipe.fractals[0].fractal_source {
            FractalSource::Known(ifs) => (**ifs).clone(),
            FractalSource::Flame { .. } => panic!("no file"),
        }
    }

    #[test]
    fn maps_of_plane_and_space_become_a_fractal_with_roles_and_shares() {
        let ifs = known(&format!("{HALVES}roles = [\"trunk\", \"branch\"]\nprobabilities = [0.25, 0.75]\n"));
        assert_eq!(ifs.maps()[1].map.offset, [0.5, 0.0, 0.0]);
        assert_eq!((ifs.maps()[0].role, ifs.maps()[1].probability), (Role::Trunk, 0.75));
        let space = known("maps = [[0.5,0,0,0, 0,0.5,0,0, 0,0,0.5,1], [0.5,0,0,1, 0,0.5,0,0, 0,0,0.5,0]]\n");
        assert!(!space.is_planar());
        assert_eq!(space.maps()[0].map.offset, [0.0, 0.0, 1.0]);
        assert_eq!(known("of = \"fern\"\ncode_digits = 20\n").code_digits(), 20);
    }

    #[test]
    fn every_fault_of_a_fractal_is_told_with_its_line() {
        let assert_refused = |keys: &str, parts: &[&str]| {
            let message = refusal(&recipe(keys));
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        };
        assert_refused("maps = []\n", &["r.toml:4: fractal: a fractal needs at least 2 maps and has 0"]);
        assert_refused(
            &format!("maps = [{}]\n", "[0.5,0,0,0.5,0,0],".repeat(257)),
            &[":4: ", "257 maps is too large"],
        );
        assert_refused(
            "maps = [\n[0.5, 0, 0, 0.5, 0, 0],\n[1.5, 0, 0, 0.5, 0, 0],\n]\n",
            &[":6: fractal: map 1 does not contract: it lengthens by 1.500"],
        );
        assert_refused("maps = [\n[0.5, 0, 0],\n]\n", &[":5: fractal: map 0 has 3 numbers", "6", "12"]);
        assert_refused(
            &format!("{HALVES}probabilities = [0.5, 0.4]\n"),
            &[":8: fractal: the probabilities sum to 0.9"],
        );
        assert_refused(
            &format!("{HALVES}probabilities = [1.5, -0.5]\n"),
            &[":8: ", "probability of map 0 is 1.5"],
        );
        assert_refused(&format!("{HALVES}probabilities = [1.0]\n"), &[":8: ", "1 entries for 2 maps"]);
        assert_refused(
            &format!("{HALVES}roles = [\"leaf\", \"stem\"]\n"),
            &[":8: ", "\"leaf\"", "\"branch\""],
        );
        assert_refused(
            "of = \"fern\"\ncode_digits = 200\n",
            &[":5: fractal: codes of 200 digits do not fit", "128"],
        );
        assert_refused("of = \"fren\"\n", &[":4: ", "did you mean `fern`?"]);
        assert_refused("of = \"fern\"\nmaps = []\n", &[":5: ", "`of` and `maps` exclude each other"]);
        assert_refused("", &[":2: fractal: `of`, `maps` or `flame` is needed"]);
        assert_refused(
            "of = \"fern\"\nroles = [\"stem\"]\n",
            &[":5: ", "`roles` has no effect without `maps`"],
        );
        assert_refused(
            "of = \"fern\"\n[[fractal]]\nname = \"mine\"\nof = \"tree\"\n",
            &[":6: ", "a second time; line 2"],
        );
    }

    #[test]
    fn every_fault_of_a_deformation_is_told_with_its_line() {
        let assert_refused = |deform: &str, parts: &[&str]| {
            let message = refusal(&recipe(&format!("of = \"fern\"\ndeform = [\n{deform},\n]\n")));
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        };
        assert_refused(
            "{ by = \"swap\", from = 7, to = 5 }",
            &["r.toml:6: fractal: swap: `from` is 7 and `to` is 5"],
        );
        assert_refused(
            "{ by = \"swap\", from = 1, to = 99 }",
            &[":6: fractal: swap: `to` is 99", "64 digits"],
        );
        assert_refused("{ by = \"swap\", to = 99 }", &[":6: fractal: swap: `from` is needed"]);
        assert_refused(
            "{ by = \"swap\", from = 0, to = 9 }",
            &[":6: ", "`from` is 0, outside its range: 1 to 256"],
        );
        assert_refused(
            "{ from = 1, to = 2 }",
            &[":6: fractal.deform.1: `from` has no effect without `by`: it needs by = \"perm"],
        );
        assert_refused("{ }", &[":6: fractal: deform: `by` is needed"]);
        assert_refused("{ by = \"spin\" }", &[":6: ", "\"spin\"", "\"permutation\""]);
        assert_refused("{ by = \"part\", part = \"14\" }", &[":6: fractal: part: `part`: 4 is no digit"]);
        assert_refused(
            "{ by = \"field\" },\n{ by = \"displacement\", from = 1, to = 2, vectors = [1] }",
            &[":7: fractal: displacement: `vectors` has 1 numbers; 4 maps need 8"],
        );
    }
}
