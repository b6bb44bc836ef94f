//! Every recipe of the project and every template is good, and runs at small size.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use weald::picture::RayMarched;
use weald::recipe::template::TEMPLATES;
use weald::recipe::{Ground, Options, Overrides, Recipe, Run, Silent};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn recipes() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("recipes")).expect("the project has recipes");
    let paths = entries.map(|entry| entry.expect("the folder can be listed").path());
    let mut recipes: Vec<_> = paths.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    recipes.sort();
    recipes
}

/// Changes that make a recipe quick: a small grid where it has no file, and few iterations of everything.
fn small(recipe: &Recipe, mut set: Vec<(String, String)>) -> Overrides {
    for planned in &recipe.steps {
        if (planned.entry.parameters)().iter().any(|parameter| parameter.name == "iterations") {
            set.push((format!("{}.iterations", planned.entry.name), "8".to_owned()));
        }
    }
    let size = matches!(recipe.ground, Ground::Empty { .. }).then_some(32);
    Overrides { size, seed: None, set }
}

fn run_small(file: &str, text: &str, set: &[(String, String)]) {
    let given = Overrides { set: set.to_vec(), ..Overrides::default() };
    let recipe = Recipe::parse(file, text, &given).unwrap_or_else(|error| panic!("{error}"));
    let recipe = Recipe::parse(file, text, &small(&recipe, set.to_vec())).expect("it is good when small");
    let out = tempfile::tempdir().expect("a temporary folder");
    // What a device draws is ray-marched here.
    let options = Options { render: Some(Arc::new(RayMarched)), ..Options::into_folder(out.path()) };
    let run = Run { recipe: &recipe, options };
    let report = run.execute(&Silent).unwrap_or_else(|error| panic!("{file} runs: {error}"));
    assert_eq!(report.outputs.len(), recipe.outputs.len());
    for output in &report.outputs {
        assert!(out.path().join(&output.file).is_file(), "{file} writes {}", output.file);
        // A material that only deposits make is nowhere yet after so few steps.
        let made = output.layer.as_deref() == Some("height");
        let flat = output.range.is_some_and(|(low, high)| low >= high);
        assert!(!(made && flat), "{file}: {} is not flat", output.file);
    }
}

#[test]
fn every_recipe_of_the_project_runs() {
    let recipes = recipes();
    assert!(recipes.len() >= 5, "there are {} recipes", recipes.len());
    for path in recipes {
        let text = std::fs::read_to_string(&path).expect("the recipe can be read");
        run_small(&path.display().to_string(), &text, &[]);
    }
}

#[test]
fn every_template_runs() {
    let elevation = root().join("data/jacksboro_fault_utm16_80m.tif").display().to_string();
    for template in TEMPLATES {
        let given = [("landscape.from".to_owned(), elevation.clone())];
        let set = if template.text.contains("\nfrom = ") { &given[..] } else { &[] };
        run_small(template.name, template.text, set);
    }
}
