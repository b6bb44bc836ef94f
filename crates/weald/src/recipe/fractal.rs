//! The recipe of one fractal, put together from the command line: `weald fractal`.

use std::path::Path;

use super::overrides::{given, value_of};
use super::plan::Recipe;
use super::source::{self, Node, Table, Value};
use weald_core::error::{Diagnostic, Error, RecipeError};

/// What the command line says of a fractal. Values are TOML; what is no TOML is text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FractalRequest {
    /// Name of a built-in fractal, a `.flame` file, or a recipe with a `[[fractal]]` table.
    pub of: String,
    /// Keys of a deformation, added to those of a recipe.
    pub deform: Vec<(String, String)>,
    /// Files and the keys of their `[[output]]` tables, those of a picture or of points.
    pub outputs: Vec<Vec<(String, String)>>,
}

/// Name of the fractal of a request that names none which a recipe could use.
const NAME: &str = "fractal";

impl FractalRequest {
    /// The recipe that makes the files.
    ///
    /// # Errors
    /// [`Error::Recipe`] with all faults; those of the command line are of line 0.
    pub fn recipe(&self) -> Result<Recipe, Error> {
        let mut fractal = self.fractal()?;
        let name = match fractal.get("name").map(|node| &node.value) {
            Some(Value::Text(name)) => name.clone(),
            _ => self.name(),
        };
        fractal.set("name", given(Value::Text(name.clone())));
        if !self.deform.is_empty() {
            let table = given(Value::Table(table_of(&self.deform)));
            match fractal.get_mut("deform").map(|node| &mut node.value) {
                Some(Value::List(items)) => items.push(table),
                _ => fractal.set("deform", given(Value::List(vec![table]))),
            }
        }
        let outputs = self.outputs.iter().map(|keys| {
            let mut output = table_of(keys);
            output.set("fractal", given(Value::Text(name.clone())));
            given(Value::Table(output))
        });
        let mut recipe = Table::default();
        recipe.set("fractal", given(Value::List(vec![given(Value::Table(fractal))])));
        recipe.set("output", given(Value::List(outputs.collect())));
        Recipe::of_table(&self.of, &recipe)
    }

    /// What messages call the fractal: as it was asked for, without folder and extension.
    fn name(&self) -> String {
        let stem = Path::new(&self.of).file_stem().unwrap_or_default().to_string_lossy();
        let is_legal = |letter: &char| letter.is_ascii_alphanumeric() || "_-".contains(*letter);
        let name: String = stem.chars().filter(is_legal).take(64).collect();
        if name.is_empty() { NAME.to_owned() } else { name }
    }

    /// The table of the fractal: the first of a recipe, or one that names what it is made of.
    fn fractal(&self) -> Result<Table, Error> {
        let path = Path::new(&self.of);
        let has =
            |extension: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension));
        if has("toml") {
            return self.first_of_recipe(path);
        }
        let mut table = Table::default();
        if has("flame") {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            table.set("flame", given(Value::Text(name)));
        } else {
            table.set("of", given(Value::Text(self.of.clone())));
        }
        Ok(table)
    }

    fn first_of_recipe(&self, path: &Path) -> Result<Table, Error> {
        let recipe = source::parse(&self.of, &Recipe::text_of(path)?)?;
        let first = match recipe.get("fractal").map(|node| &node.value) {
            Some(Value::List(items)) => items.first(),
            _ => None,
        };
        if let Some(Node { value: Value::Table(table), .. }) = first {
            return Ok(table.clone());
        }
        let message = "there is no [[fractal]] table to be drawn".to_owned();
        let diagnostics = vec![Diagnostic { line: 1, message }];
        Err(RecipeError { file: self.of.clone(), diagnostics }.into())
    }
}

/// Keys with dots lead into tables.
pub(super) fn table_of(keys: &[(String, String)]) -> Table {
    let mut table = Table::default();
    for (key, text) in keys {
        match key.split_once('.') {
            None => table.set(key, given(value_of(text))),
            Some((outer, inner)) => {
                if table.get(outer).is_none() {
                    table.set(outer, given(Value::Table(Table::default())));
                }
                if let Some(Node { value: Value::Table(within), .. }) = table.get_mut(outer) {
                    within.set(inner, given(value_of(text)));
                }
            }
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Content;

    fn keys(keys: &[(&str, &str)]) -> Vec<(String, String)> {
        keys.iter().map(|(key, text)| ((*key).to_owned(), (*text).to_owned())).collect()
    }

    fn request(of: &str, output: &[(&str, &str)]) -> FractalRequest {
        let outputs = vec![keys(&[&[("picture", "fractal"), ("file", "a.png")], output].concat())];
        FractalRequest { of: of.to_owned(), deform: Vec::new(), outputs }
    }

    #[test]
    fn a_request_becomes_a_recipe_that_needs_no_ground() {
        let asked = request("fern", &[("wind.speed", "4"), ("frames", "8"), ("background", "dark")]);
        let deform = keys(&[("by", "permutation"), ("from", "5"), ("to", "7")]);
        let recipe = FractalRequest { deform, ..asked }.recipe().expect("good");
        assert_eq!((recipe.fractals.len(), recipe.fractals[0].deform.len()), (1, 1));
        assert!(matches!(recipe.outputs[0].content, Content::Film { name: "fractal", .. }));
        assert!(recipe.effective().contains("wind = { speed = 4 }"), "{}", recipe.effective());
    }

    #[test]
    fn faults_of_the_command_line_are_told() {
        let fault = |asked: FractalRequest| asked.recipe().expect_err("a fault").to_string();
        assert!(fault(request("fren", &[])).contains("did you mean `fern`?"));
        assert!(fault(request("fern", &[("gama", "2")])).contains("did you mean `gamma`?"));
        assert!(fault(request("fern", &[("gamma", "20")])).contains("is 20, outside its range: 0.1 to 10"));
        let deform = keys(&[("by", "swap"), ("from", "3"), ("to", "2")]);
        let message = fault(FractalRequest { deform, ..request("fern", &[]) });
        assert!(message.contains("`from` is 3 and `to` is 2"), "{message}");
        assert!(fault(request("none.toml", &[])).contains("none.toml: the recipe cannot be read"));
    }
}
