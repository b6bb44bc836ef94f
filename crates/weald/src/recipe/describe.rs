//! The catalogue as text for people: `weald steps`.

use std::fmt::Write;

use super::catalog::CATALOG;
use super::parameter::{Diagnostics, Kind, Parameter, Parameters, Variant};
use super::plan::{FilmKeys, FractalKeys, LandscapeKeys, MaterialKeys, OutputKeys};
use super::source::Table;
use super::written_layers;
use weald_core::layer_words::{meaning, shown_unit};
use weald_engine::step::{Entry, Stage};
use weald_export::EXPORTS;
use weald_picture::PICTURES;
use weald_plants::ifs::deform::DeformKeys;

/// Columns that a line of text may take.
const WIDTH: usize = 100;

/// A table of a recipe that is neither step nor output.
struct LandscapeTable {
    name: &'static str,
    header: &'static str,
    summary: &'static str,
    parameters: fn() -> Vec<Parameter>,
}

const TABLES: &[LandscapeTable] = &[
    LandscapeTable {
        name: "landscape",
        header: "[landscape]",
        summary: "what the ground starts from",
        parameters: LandscapeKeys::parameters,
    },
    LandscapeTable {
        name: "material",
        header: "[[material]]",
        summary: "what the ground is made of: a table a material, bedrock first, 8 at most",
        parameters: MaterialKeys::parameters,
    },
    LandscapeTable {
        name: "fractal",
        header: "[[fractal]]",
        summary: "a fractal of your own, which pictures, points and plants name",
        parameters: || FractalKeys::parameters().into_iter().filter(|key| key.name != "deform").collect(),
    },
    LandscapeTable {
        name: "deform",
        header: "deform = [{ by = … }, …], in a [[fractal]]",
        summary: "the deformations of a fractal, one after the other",
        parameters: DeformKeys::parameters,
    },
    LandscapeTable {
        name: "output",
        header: "[[output]]",
        summary: "a file: a layer, a picture or an export, whose own keys `weald steps NAME` shows",
        parameters: output_keys,
    },
    LandscapeTable {
        name: "film",
        header: "[[output]] picture = …",
        summary: "keys that make a film of a picture: numbered .png, and a video where `file` is a .mp4 or .webm",
        parameters: FilmKeys::parameters,
    },
];

/// The keys of all outputs; those that a kind has for itself stand with the kind.
fn output_keys() -> Vec<Parameter> {
    let mut keys = OutputKeys::parameters();
    for file in keys.iter_mut().filter(|key| key.name == "file") {
        (file.required, file.default, file.default_in_words) = (true, None, None);
    }
    keys
}

/// All tables, steps, pictures and exports, a line each.
pub fn overview() -> String {
    let mut text = String::new();
    list(&mut text, "tables", TABLES.iter().map(|table| (table.name, table.summary)));
    for stage in Stage::ALL {
        let entries = CATALOG.iter().filter(|entry| entry.stage == stage);
        list(&mut text, stage.title(), entries.map(|entry| (entry.name, entry.summary)));
    }
    list(&mut text, "picture", PICTURES.iter().map(|entry| (entry.name, entry.summary)));
    list(&mut text, "export", EXPORTS.iter().map(|entry| (entry.name, entry.summary)));
    text.push_str("`weald steps NAME` shows the parameters of one.\n");
    text
}

fn list(text: &mut String, title: &str, items: impl Iterator<Item = (&'static str, &'static str)>) {
    let _ = writeln!(text, "{title}");
    for (name, summary) in items {
        let _ = writeln!(text, "  {name:<18} {summary}");
    }
    text.push('\n');
}

/// The steps, pictures, exports and tables of that name with all their parameters; an error names what was probably
/// meant.
pub fn step(name: &str) -> Result<String, String> {
    let steps = CATALOG.iter().filter(|entry| entry.name == name).map(of_entry);
    let pictures = PICTURES.iter().filter(|entry| entry.name == name);
    let pictures = pictures
        .map(|entry| of(&format!("picture = \"{name}\""), entry.summary, None, &(entry.parameters)()));
    let exports = EXPORTS.iter().filter(|entry| entry.name == name).map(|entry| {
        of(&format!("export = \"{name}\""), entry.summary, Some(entry.source), &(entry.parameters)())
    });
    let tables = TABLES.iter().filter(|table| table.name == name);
    let tables = tables.map(|table| of(table.header, table.summary, None, &(table.parameters)()));
    let found: Vec<_> = steps.chain(pictures).chain(exports).chain(tables).collect();
    if !found.is_empty() {
        return Ok(found.join("\n"));
    }
    let kinds = [
        ("tables", TABLES.iter().map(|table| table.name).collect::<Vec<_>>()),
        ("steps", CATALOG.iter().map(|entry| entry.name).collect()),
        ("pictures", PICTURES.iter().map(|entry| entry.name).collect()),
        ("exports", EXPORTS.iter().map(|entry| entry.name).collect()),
    ];
    if let Some((_, answer)) = ELSEWHERE.iter().find(|(other, _)| name.eq_ignore_ascii_case(other)) {
        return Err(format!("there is no step {name:?}: {answer}"));
    }
    let known: Vec<_> = kinds.iter().flat_map(|(_, names)| names.iter().copied()).collect();
    if let Some(near) = super::parameter::nearest(name, &known) {
        return Err(format!("there is no step {name:?}; did you mean `{near}`?"));
    }
    let lines = kinds.map(|(kind, mut names)| {
        names.sort_unstable();
        format!("{kind}: {}", names.join(", "))
    });
    Err(format!("there is no step, picture, export or table {name:?}; there are\n{}", lines.join("\n")))
}

/// What other programs call, or what is asked for by the name of its reader.
const ELSEWHERE: &[(&str, &str)] = &[
    ("godot", "the export `terrain3d` is for Godot"),
    ("splatmap", "the key `masks` of the export `unreal` makes weight maps; any layer is one as a .png"),
    ("splat", "the key `masks` of the export `unreal` makes weight maps; any layer is one as a .png"),
    ("weightmap", "the key `masks` of the export `unreal` makes weight maps; any layer is one as a .png"),
    (
        "blender",
        "the export `mesh` writes a .glb that Blender imports, `preset = \"blender\"` heights as a .exr",
    ),
    ("obj", "the export `mesh` writes a mesh as binary glTF, .glb"),
    ("fbx", "the export `mesh` writes a mesh as binary glTF, .glb"),
    ("gltf", "the export `mesh` writes a mesh as binary glTF, .glb"),
    ("glb", "the export `mesh` writes the ground as a .glb, `plants` and `grass` what grows on it"),
    (
        "heightmap",
        "`layer = \"height\"` in an [[output]] is the heightmap: .tif, .png, .exr, .r16 and others",
    ),
    ("every", "it is a key of the table `film`"),
    ("frames", "it is a key of the table `film`"),
];

fn of_entry(entry: &Entry) -> String {
    of(&format!("do = \"{}\"", entry.name), entry.summary, Some(entry.source), &(entry.parameters)())
        + &results(entry)
}

fn of(key: &str, summary: &str, source: Option<&str>, parameters: &[Parameter]) -> String {
    let mut text = format!("{key}\n{}", wrapped(summary, 2));
    if let Some(source) = source {
        text.push_str(&wrapped(&format!("Source: {source}"), 2));
    }
    write_parameters(&mut text, parameters, 0);
    text
}

/// Layers that the step writes, and what it measures.
fn results(entry: &Entry) -> String {
    let mut text = String::new();
    let usual = written_layers::by_default(entry);
    let others = written_layers::by_key(entry);
    let materials = written_layers::materials(entry);
    if !usual.is_empty() || !others.is_empty() || materials.is_some() {
        text.push_str("\nWrites:\n");
    }
    for layer in &usual {
        text.push_str(&layer_line(layer, ""));
    }
    for (key, layers) in &others {
        for layer in layers.iter().filter(|(name, _)| name != key) {
            text.push_str(&layer_line(layer, &format!(" with `{key}`")));
        }
    }
    if let Some(with) = materials {
        text.push_str(&wrapped(&format!("`bedrock` and the thickness of each material (m){with}"), 2));
    }
    let measures = (entry.read)(&Table::default(), &mut Diagnostics::default()).measures();
    if !measures.is_empty() {
        text.push_str("\nMeasures, in report.json:\n");
    }
    for (name, meaning) in measures {
        text.push_str(&wrapped(&format!("`{name}`: {meaning}"), 2));
    }
    text
}

fn layer_line((name, unit): &(String, &'static str), with: &str) -> String {
    let unit = match shown_unit(unit) {
        none if none.is_empty() => none,
        unit => format!(" ({unit})"),
    };
    let meaning = meaning(name).map_or(String::new(), |meaning| format!(": {meaning}"));
    wrapped(&format!("`{name}`{unit}{with}{meaning}"), 2)
}

fn write_parameters(text: &mut String, parameters: &[Parameter], indent: usize) {
    for parameter in parameters {
        let default = match (&parameter.default_in_words, parameter.required) {
            (Some(default), _) => format!(", default {default}"),
            (None, true) => ", needed".to_owned(),
            (None, false) => String::new(),
        };
        let unit = if parameter.unit == "1" { String::new() } else { format!(", in {}", parameter.unit) };
        let needs: Vec<_> = parameter.needs.iter().map(|needs| format!("; {}", needs.in_words())).collect();
        let needs = needs.concat();
        let kind = parameter.kind.in_words();
        let _ = writeln!(text, "\n{:indent$}{} ({kind}{unit}{default}{needs})", "", parameter.name);
        text.push_str(&wrapped(parameter.doc, indent + 2));
        if let Kind::Table(inner) | Kind::Tables(inner) = &parameter.kind {
            write_parameters(text, inner, indent + 4);
        }
    }
    for parameter in parameters {
        if let Kind::Variants(variants) = &parameter.kind {
            for variant in variants {
                write_variant(text, parameter.name, variant, indent);
            }
        }
    }
}

/// The keys that a word brings with it.
fn write_variant(text: &mut String, key: &str, variant: &Variant, indent: usize) {
    let _ = writeln!(text, "\n{:indent$}with {key} = {:?}", "", variant.word);
    text.push_str(&wrapped(variant.doc, indent + 2));
    write_parameters(text, &variant.parameters, indent + 4);
}

/// Text in lines of at most [`WIDTH`] columns.
fn wrapped(text: &str, indent: usize) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(lines, "{:indent$}{line}", "");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    let _ = writeln!(lines, "{:indent$}{line}", "");
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_wrapped_between_words() {
        let text = wrapped(&"word ".repeat(50), 4);
        assert!(text.lines().count() > 1);
        assert!(text.lines().all(|line| line.starts_with("    word") && line.len() <= WIDTH), "{text}");
    }

    #[test]
    fn a_step_and_an_export_of_one_name_are_both_shown() {
        let text = step("rivers").expect("both are there");
        assert!(text.starts_with("do = \"rivers\"") && text.contains("\n\nexport = \"rivers\""), "{text}");
    }

    #[test]
    fn names_of_other_programs_lead_to_what_is_meant_and_unknown_ones_to_lists() {
        let unknown = |name| step(name).expect_err("there is none");
        assert!(unknown("Godot").contains("`terrain3d`") && unknown("obj").contains("`mesh`"));
        let all = unknown("xyzzy");
        let lines: Vec<_> = all.lines().skip(1).collect();
        let exports =
            "exports: grass, lakes, layers, mesh, plants, points, report, rivers, terrain3d, unity, unreal";
        assert!(lines.len() == 4 && lines[3] == exports, "{all}");
    }

    #[test]
    fn outputs_and_fractals_are_described_with_all_presets_and_deformations() {
        let output = step("output").expect("a table");
        for preset in weald_io::FORMATS.iter().flat_map(|format| format.presets) {
            assert!(output.contains(&format!("`{}`", preset.name)), "{}: {output}", preset.name);
        }
        assert!(output.contains("file (text, needed)"), "{output}");
        let deform = step("deform").expect("a table");
        assert!(
            step("fractal").expect("a table").contains("[[fractal]]") && deform.contains("`insertion` puts")
        );
    }

    #[test]
    fn a_parameter_is_shown_with_kind_unit_and_default() {
        let text = of("do = \"x\"", "Does x.", Some("Weald"), &LandscapeKeys::parameters());
        assert!(text.contains("cell (number, 0.001 to 100000, in m)"), "{text}");
        assert!(text.contains("seed (whole number, 0 to 9007199254740991, default 0)"), "{text}");
    }

    #[test]
    fn a_step_is_shown_with_its_layers_and_measures() {
        let flow = step("flow").expect("it is there");
        assert!(flow.contains("\nWrites:\n  `flow_direction`: neighbour"), "{flow}");
        assert!(flow.contains("  `accumulation` (m²): upslope"), "{flow}");
        assert!(flow.contains("  `discharge` (m³/s) with `weight`: mean"), "{flow}");
        let network = step("network").expect("it is there");
        assert!(network.contains("\nMeasures, in report.json:\n  `chan`: share"), "{network}");
    }

    #[test]
    fn each_model_is_shown_with_its_own_unit_range_and_default() {
        let text = step("hydraulic").expect("it is there");
        let (_, models) = text.split_once("\nwith model = \"han\"\n").expect("a heading");
        let (han, others) = models.split_once("\nwith model = \"mei\"\n").expect("a heading");
        let (mei, stava) = others.split_once("\nwith model = \"stava\"\n").expect("a heading");
        assert!(
            han.contains("evaporation (number, 0 to 100, in m/iteration, default 0.03 × cell size)"),
            "{han}"
        );
        assert!(mei.contains("evaporation (number, 0 to 1, default 0.015)"), "{mei}");
        assert!(han.contains("law (\"velocity\"") && !mei.contains("law (") && !stava.contains("law ("));
        assert!(stava.contains("default true; only with transport = \"maccormack\")"), "{stava}");
    }
}
