//! A recipe for one view of its landscape, put together from the command line: `weald render`.

use std::path::PathBuf;

use super::fractal::table_of;
use super::overrides::{Overrides, given};
use super::parameter::{Diagnostics, Parameters, key, without_effect};
use super::plan::{Content, FilmKeys, Output, Recipe};
use super::source::{self, Node, Table, Value};
use weald_core::error::Error;
use weald_picture::{RenderKeys, View};

/// What the command line says of a view. Values are TOML; what is no TOML is text.
#[derive(Clone, Debug, Default)]
pub struct ViewRequest {
    /// The recipe.
    pub recipe: PathBuf,
    /// Changes to it.
    pub overrides: Overrides,
    /// Keys of the view, in place of those that the recipe's first view has.
    pub keys: Vec<(String, String)>,
}

impl ViewRequest {
    /// The recipe with the view as its only output, and the view.
    ///
    /// # Errors
    /// As [`Recipe::load`]; faults of the keys are of line 0.
    pub fn recipe(&self) -> Result<(Recipe, View), Error> {
        let file = self.recipe.display().to_string();
        let mut table = source::parse(&file, &Recipe::text_of(&self.recipe)?)?;
        let mut diagnostics = Diagnostics::default();
        self.overrides.apply(&mut table, &mut diagnostics);
        let mut view = first_view(&table).unwrap_or_default();
        for name in FilmKeys::parameters().iter().chain(&RenderKeys::parameters()).map(|own| key(own.name)) {
            view.take(name);
        }
        view.set("picture", given(Value::Text("view".to_owned())));
        view.set("file", given(Value::Text("view.png".to_owned())));
        let own = table_of(&self.keys);
        for (name, node) in &own.entries {
            view.set(name, node.clone());
        }
        // What the recipe's view says has no effect beside some keys of the request: `azimuth_deg` beside `eye`.
        for name in without_effect(&view, &View::parameters()) {
            if own.get(name).is_none() {
                view.take(name);
            }
        }
        table.set("output", given(Value::List(vec![given(Value::Table(view))])));
        let mut recipe = Recipe::of_changed_table(&file, &table, diagnostics)?;
        let outputs = std::mem::take(&mut recipe.outputs);
        let view = outputs.iter().find_map(view_of).cloned();
        Ok((recipe, view.expect("the only output is a view")))
    }
}

fn view_of(output: &Output) -> Option<&View> {
    match &output.content {
        Content::Picture { picture, .. } => picture.as_view(),
        _ => None,
    }
}

/// The first output that is a view, drawn on a device or not.
fn first_view(recipe: &Table) -> Option<Table> {
    let Value::List(outputs) = &recipe.get("output")?.value else { return None };
    let tables = outputs.iter().filter_map(|node| match node {
        Node { value: Value::Table(table), .. } => Some(table),
        _ => None,
    });
    let is_view = |table: &&Table| matches!(table.get("picture"), Some(Node { value: Value::Text(name), .. }) if ["view", "render"].contains(&name.as_str()));
    tables.into_iter().find(is_view).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(keys: &[(&str, &str)]) -> (tempfile::TempDir, ViewRequest) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("land.toml");
        let text = "[landscape]\nsize = 8\ncell = 10.0\n[[step]]\ndo = \"constant\"\nheight = 3.0\n\
                    [[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n\
                    [[output]]\npicture = \"view\"\nsun_altitude_deg = 9.0\nazimuth_deg = 30\nframes = 20\nfile = \"b.mp4\"\n";
        std::fs::write(&path, text).expect("written");
        let keys = keys.iter().map(|(key, text)| ((*key).to_owned(), (*text).to_owned())).collect();
        (folder, ViewRequest { recipe: path, overrides: Overrides::default(), keys })
    }

    #[test]
    fn a_request_has_the_light_of_the_first_view_and_the_keys_of_the_command_line() {
        let (_folder, asked) = request(&[("sun_azimuth_deg", "100")]);
        let (recipe, view) = asked.recipe().expect("good");
        assert!(recipe.outputs.is_empty(), "nothing but the view is drawn");
        assert_eq!((view.sun_altitude_deg, view.sun_azimuth_deg), (9.0, 100.0));
    }

    #[test]
    fn what_the_recipe_says_of_the_camera_gives_way_to_the_command_line() {
        let (_folder, asked) = request(&[("eye", "[4, 4]"), ("eye_height", "2")]);
        let (_, view) = asked.recipe().expect("good");
        assert_eq!((view.eye_height, view.azimuth_deg), (2.0, View::default().azimuth_deg));
        let (_folder, asked) = request(&[("eye", "[4, 4]"), ("distance", "9")]);
        let message = asked.recipe().expect_err("both are asked for").to_string();
        assert!(message.contains("`distance` has no effect beside `eye`"), "{message}");
    }

    #[test]
    fn a_key_out_of_its_range_is_told_as_of_the_command_line() {
        let (_folder, asked) = request(&[("sun_altitude_deg", "95")]);
        let message = asked.recipe().expect_err("95° is no altitude").to_string();
        assert!(message.contains("as changed on the command line") && message.contains("95"), "{message}");
    }
}
