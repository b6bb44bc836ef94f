//! Changes to a recipe from the command line, made before it is checked, so that they are checked alike.

use super::parameter::{Diagnostics, ParameterValue, Sides, nearest};
use super::source::{self, Node, Table, Value};
use weald_core::grid::Size;

/// Line of a value that stands in no file.
const COMMAND_LINE: usize = 0;

/// Fewest cells along the longer side that a preview is made coarser to.
pub(super) const LEAST_PREVIEW: u64 = 256;

/// How many times coarser a preview is.
const PREVIEW_FACTOR: u64 = 4;

/// What a user changes in a recipe without editing it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Cells along the longer side. The other side and the cell follow, so that the landscape keeps its shape
    /// and its extent in metres.
    pub size: Option<u64>,
    /// Whether the landscape is made on a quarter of the cells a side, at least 256 of them: the same
    /// landscape in a fraction of the time.
    pub preview: bool,
    /// Whether the landscape may have more cells than one in memory, for a run [out of core](super::Options::out_of_core).
    pub larger_than_memory: bool,
    /// Seed of the landscape.
    pub seed: Option<u64>,
    /// Paths and values: `landscape.cell`, `material.2.thickness`, `step.2.iterations`, `output.1.file`, or
    /// `thermal.talus` for all steps of that name. A value is TOML; what is no TOML is text.
    pub set: Vec<(String, String)>,
}

impl Overrides {
    /// Changes the recipe; paths that lead nowhere become complaints.
    pub(super) fn apply(&self, recipe: &mut Table, diagnostics: &mut Diagnostics) {
        for (path, value) in &self.set {
            if let Err(problem) = set(recipe, path, &value_of(value)) {
                diagnostics.add(COMMAND_LINE, format!("--set {path}: {problem}"));
            }
        }
        if let Some(seed) = self.seed {
            let seed = i64::try_from(seed).unwrap_or(i64::MAX);
            landscape_of(recipe).set("seed", given(Value::Integer(seed)));
        }
        if let Some(side) = self.size
            && let Err(problem) = resize(landscape_of(recipe), side)
        {
            diagnostics.add(COMMAND_LINE, format!("--size {side}: {problem}"));
        }
        if self.preview
            && let Some(side) = preview_side(landscape_of(recipe))
            && let Err(problem) = resize(landscape_of(recipe), side)
        {
            diagnostics.add(COMMAND_LINE, format!("--preview: {problem}"));
        }
    }
}

/// A value that stands in no file.
pub(super) fn given(value: Value) -> Node {
    Node { line: COMMAND_LINE, value }
}

/// Reads a value as TOML; bare words, which TOML does not know, are text.
pub(super) fn value_of(text: &str) -> Value {
    let parsed = source::parse("", &format!("value = {text}"));
    match parsed.map(|table| table.entries) {
        Ok(entries) if entries.len() == 1 => at_command_line(entries[0].1.value.clone()),
        _ => Value::Text(text.to_owned()),
    }
}

/// The value with no line anywhere inside it.
fn at_command_line(value: Value) -> Value {
    match value {
        Value::List(items) => {
            Value::List(items.into_iter().map(|item| given(at_command_line(item.value))).collect())
        }
        Value::Table(table) => Value::Table(Table {
            line: COMMAND_LINE,
            entries: table
                .entries
                .into_iter()
                .map(|(key, node)| (key, given(at_command_line(node.value))))
                .collect(),
        }),
        plain => plain,
    }
}

/// The `[landscape]` table, which is made where it is missing.
fn landscape_of(recipe: &mut Table) -> &mut Table {
    let exists = matches!(recipe.get("landscape").map(|node| &node.value), Some(Value::Table(_)));
    if !exists {
        recipe.set("landscape", given(Value::Table(Table::default())));
    }
    match recipe.get_mut("landscape").map(|node| &mut node.value) {
        Some(Value::Table(table)) => table,
        _ => unreachable!("the table was set above where it was missing"),
    }
}

fn set(recipe: &mut Table, path: &str, value: &Value) -> Result<(), String> {
    let parts: Vec<&str> = path.split('.').collect();
    let (tables, keys) = match parts.as_slice() {
        ["landscape", keys @ ..] => (vec![landscape_of(recipe)], keys),
        [section @ ("material" | "fractal" | "step" | "output"), number, keys @ ..] => {
            (vec![numbered(recipe, section, number)?], keys)
        }
        [name, keys @ ..] => (steps_named(recipe, name)?, keys),
        [] => return Err("a path is needed, as in `landscape.cell`".to_owned()),
    };
    for table in tables {
        set_in(table, keys, value)?;
    }
    Ok(())
}

fn set_in(table: &mut Table, keys: &[&str], value: &Value) -> Result<(), String> {
    let [key, deeper @ ..] = keys else {
        return Err("the path ends before it names a key, as in `landscape.cell`".to_owned());
    };
    if deeper.is_empty() {
        table.set(key, given(value.clone()));
        return Ok(());
    }
    if table.get(key).is_none() {
        table.set(key, given(Value::Table(Table::default())));
    }
    match table.get_mut(key).map(|node| &mut node.value) {
        Some(Value::Table(inner)) => set_in(inner, deeper, value),
        _ => Err(format!("`{key}` is not a table, so it has no key `{}`", deeper[0])),
    }
}

fn tables_of<'a>(recipe: &'a mut Table, section: &str) -> Vec<&'a mut Table> {
    let Some(Node { value: Value::List(items), .. }) = recipe.get_mut(section) else { return Vec::new() };
    let tables = items.iter_mut().filter_map(|item| match &mut item.value {
        Value::Table(table) => Some(table),
        _ => None,
    });
    tables.collect()
}

/// The table at a place counted from 1.
fn numbered<'a>(recipe: &'a mut Table, section: &str, number: &str) -> Result<&'a mut Table, String> {
    let mut tables = tables_of(recipe, section);
    let count = tables.len();
    let wanted = number.parse::<usize>().ok().filter(|place| (1..=count).contains(place));
    let Some(place) = wanted else {
        return Err(format!("`{number}` is no {section}; this recipe has {section}s 1 to {count}"));
    };
    Ok(tables.swap_remove(place - 1))
}

fn steps_named<'a>(recipe: &'a mut Table, name: &str) -> Result<Vec<&'a mut Table>, String> {
    let done_by = |table: &Table| match table.get("do").map(|node| &node.value) {
        Some(Value::Text(name)) => Some(name.clone()),
        _ => None,
    };
    let known: Vec<_> = tables_of(recipe, "step").iter().filter_map(|table| done_by(table)).collect();
    if !known.iter().any(|step| step == name) {
        return Err(no_such_step(recipe, name, &known));
    }
    let tables = tables_of(recipe, "step").into_iter();
    Ok(tables.filter(|table| done_by(table).as_deref() == Some(name)).collect())
}

/// Sections of a recipe with which a path can begin.
const SECTIONS: [&str; 5] = ["landscape", "material", "fractal", "step", "output"];

/// What to do about the first word of a path that is no section and no step. `steps` are those of the recipe.
fn no_such_step(recipe: &mut Table, name: &str, steps: &[String]) -> String {
    if let Some((number, kind)) = output_called(recipe, name) {
        return format!(
            "`{name}` is no step, but the {kind} of output {number}: outputs are counted, so that it is output.{number}.KEY"
        );
    }
    let known: Vec<_> = steps.iter().map(String::as_str).chain(SECTIONS).collect();
    if let Some(near) = nearest(name, &known) {
        return format!("this recipe has no step `{name}`; did you mean `{near}`?");
    }
    let steps =
        if steps.is_empty() { String::new() } else { format!(", STEP.KEY for one of: {}", steps.join(", ")) };
    format!(
        "this recipe has no step and no section `{name}`; a path is landscape.KEY, material.N.KEY, fractal.N.KEY, \
         step.N.KEY, output.N.KEY for pictures, layers and exports, where N counts from 1{steps}"
    )
}

/// The number of the first output whose picture, export, layer or file is called so, and which of them it is.
fn output_called(recipe: &mut Table, name: &str) -> Option<(usize, &'static str)> {
    let is = |table: &Table, key: &str| matches!(table.get(key).map(|node| &node.value), Some(Value::Text(text)) if text == name);
    let outputs = tables_of(recipe, "output");
    let mut found = outputs.iter().enumerate().filter_map(|(at, table)| {
        let kind = ["picture", "export", "layer", "file"].into_iter().find(|key| is(table, key))?;
        Some((at + 1, kind))
    });
    found.next()
}

/// Sets the longer side and keeps shape and extent. Where `size` or `cell` are faulty they are left for the
/// check to complain of.
fn resize(landscape: &mut Table, side: u64) -> Result<(), String> {
    if landscape.get("from").is_some() {
        return Err("the size comes from the file in `from`; add a `resample` step instead".to_owned());
    }
    let side = i64::try_from(side.max(1)).unwrap_or(i64::MAX);
    let range = (f64::NEG_INFINITY, f64::INFINITY);
    let mut ignored = Diagnostics::default();
    let old = landscape.get("size").and_then(|node| Sides::read(node, range, &mut ignored).ok());
    let old = old.unwrap_or(Sides { columns: 1, rows: 1 });
    let longer = old.columns.max(old.rows);
    let scaled = |old: u64| (i128::from(old) * i128::from(side) / i128::from(longer)).max(1) as i64;
    let sides = [scaled(old.columns), scaled(old.rows)];
    if side < longer as i64 && landscape.get("finest").is_none() {
        let finest = [old.columns, old.rows].map(|side| given(Value::Integer(side as i64)));
        landscape.set("finest", given(Value::List(finest.to_vec())));
    }
    // Of a size over the limit the user should read, not of the tiny cell that would follow from it.
    let fits = Size::new(sides[0] as usize, sides[1] as usize).is_ok();
    if fits
        && let Some(cell) =
            landscape.get("cell").map_or(Some(1.0), |node| f64::read(node, range, &mut ignored).ok())
        && landscape.get("size").is_some()
    {
        landscape.set("cell", given(Value::Number(cell * longer as f64 / side as f64)));
    }
    let sides = sides.map(|side| given(Value::Integer(side)));
    landscape.set("size", given(Value::List(sides.to_vec())));
    Ok(())
}

/// Cells along the longer side of a preview; none where the landscape is small enough as it is.
fn preview_side(landscape: &Table) -> Option<u64> {
    let mut ignored = Diagnostics::default();
    let range = (f64::NEG_INFINITY, f64::INFINITY);
    let size = landscape.get("size").and_then(|node| Sides::read(node, range, &mut ignored).ok());
    let Some(size) = size else { return landscape.get("from").map(|_| LEAST_PREVIEW) };
    let longer = size.columns.max(size.rows);
    let side = (longer / PREVIEW_FACTOR).max(LEAST_PREVIEW);
    (side < longer).then_some(side)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(text: &str, overrides: &Overrides) -> (String, Vec<String>) {
        let mut recipe = source::parse("r", text).expect("test recipes are TOML");
        let mut diagnostics = Diagnostics::default();
        overrides.apply(&mut recipe, &mut diagnostics);
        let messages = diagnostics.found.into_iter().map(|diagnostic| diagnostic.message).collect();
        (super::super::canonical::text(&recipe), messages)
    }

    fn set(text: &str, path: &str, value: &str) -> (String, Vec<String>) {
        let set = vec![(path.to_owned(), value.to_owned())];
        changed(text, &Overrides { set, ..Overrides::default() })
    }

    const TWO_STEPS: &str = "[[step]]\ndo = \"slide\"\nrate = 1\n[[step]]\ndo = \"slide\"\n";

    #[test]
    fn a_path_with_a_number_reaches_one_step() {
        let (text, diagnostics) = set(TWO_STEPS, "step.2.rate", "0.5");
        assert_eq!(diagnostics, [""; 0]);
        assert_eq!(text, "[[step]]\ndo = \"slide\"\nrate = 1\n[[step]]\ndo = \"slide\"\nrate = 0.5\n");
    }

    #[test]
    fn a_path_with_a_name_reaches_all_steps_of_that_name_and_their_inner_tables() {
        let (text, diagnostics) = set(TWO_STEPS, "slide.under.talus", "steep");
        assert_eq!(diagnostics, [""; 0]);
        assert_eq!(text.matches("under = { talus = \"steep\" }").count(), 2, "{text}");
    }

    #[test]
    fn a_path_that_leads_nowhere_names_what_was_probably_meant() {
        assert!(set(TWO_STEPS, "slid.rate", "1").1[0].contains("did you mean `slide`?"));
        assert!(set(TWO_STEPS, "step.3.rate", "1").1[0].contains("steps 1 to 2"));
        assert!(set(TWO_STEPS, "step.1.rate.low", "1").1[0].contains("`rate` is not a table"));
        assert!(set(TWO_STEPS, "landscape", "1").1[0].contains("ends before it names a key"));
        let none = &set(TWO_STEPS, "eye.far", "1").1[0];
        assert!(
            none.contains("output.N.KEY for pictures") && none.contains("for one of: slide, slide"),
            "{none}"
        );
    }

    #[test]
    fn a_path_with_the_name_of_a_picture_is_answered_with_its_number() {
        let text = format!("{TWO_STEPS}[[output]]\nlayer = \"height\"\n[[output]]\npicture = \"view\"\n");
        let message = &set(&text, "view.snow_line", "1").1[0];
        assert!(message.ends_with("it is output.2.KEY"), "{message}");
        assert!(message.contains("`view` is no step, but the picture of output 2"), "{message}");
    }

    #[test]
    fn a_value_cannot_smuggle_in_another_key() {
        let (text, _) = set(TWO_STEPS, "step.2.rate", "1\nother = 2");
        assert!(text.contains(r#"rate = "1\nother = 2""#), "{text}");
    }

    #[test]
    fn a_new_size_keeps_shape_and_extent() {
        let size = Overrides { size: Some(64), ..Overrides::default() };
        let (text, _) = changed("[landscape]\nsize = [512, 256]\ncell = 10\n", &size);
        assert_eq!(text, "[landscape]\ncell = 80.0\nfinest = [512, 256]\nsize = [64, 32]\n");
        let (text, _) = changed("[landscape]\nsize = [32, 16]\n", &size);
        assert_eq!(text, "[landscape]\ncell = 0.5\nsize = [64, 32]\n", "nothing is finer than it will be");
        let (_, diagnostics) = changed("[landscape]\nfrom = \"a.tif\"\n", &size);
        assert!(diagnostics[0].contains("resample"), "{diagnostics:?}");
    }

    #[test]
    fn a_preview_is_the_landscape_on_fewer_cells() {
        let preview = Overrides { preview: true, ..Overrides::default() };
        let (text, _) = changed("[landscape]\nsize = [1024, 512]\ncell = 10\n", &preview);
        assert_eq!(text, "[landscape]\ncell = 40.0\nfinest = [1024, 512]\nsize = [256, 128]\n");
        let (text, _) = changed("[landscape]\nsize = 200\ncell = 10\n", &preview);
        assert_eq!(text, "[landscape]\ncell = 10\nsize = 200\n", "small as it is");
        let (_, diagnostics) = changed("[landscape]\nfrom = \"a.tif\"\n", &preview);
        assert!(diagnostics[0].contains("resample"), "{diagnostics:?}");
    }
}
