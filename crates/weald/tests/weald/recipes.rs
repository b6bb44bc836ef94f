//! Every recipe of the project and every template is good, and runs at small size.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use weald::picture::RayMarched;
use weald::recipe::schema::schema;
use weald::recipe::template::TEMPLATES;
use weald::recipe::{Ground, Options, Overrides, Recipe, Run, Silent, migrate};

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

/// Changes that make a recipe quick: a small grid where it has no file, few iterations of everything, few plants.
fn small(recipe: &Recipe, mut set: Vec<(String, String)>) -> Overrides {
    for planned in &recipe.steps {
        for (key, value) in [("iterations", "8"), ("count", "200")] {
            if (planned.entry.parameters)().iter().any(|parameter| parameter.name == key) {
                set.push((format!("{}.{key}", planned.entry.name), value.to_owned()));
            }
        }
    }
    let size = matches!(recipe.ground, Ground::Empty { .. }).then_some(32);
    Overrides { size, set, ..Overrides::default() }
}

/// The recipe with views of a hundredth of the pixels: rays are most of the time that a small landscape takes.
fn with_small_views(text: &str) -> String {
    let mut recipe: toml::Table = toml::from_str(text).expect("recipes are TOML");
    let outputs = recipe.get_mut("output").and_then(|outputs| outputs.as_array_mut());
    for output in outputs.into_iter().flatten().filter_map(|output| output.as_table_mut()) {
        let picture = output.get("picture").and_then(|picture| picture.as_str());
        if matches!(picture, Some("view" | "render")) {
            output.extend([("width", 160), ("height", 90)].map(|(key, side)| (key.to_owned(), side.into())));
        }
    }
    toml::to_string(&recipe).expect("it was TOML")
}

fn run_small(file: &str, text: &str, set: &[(String, String)]) {
    let text = &with_small_views(text);
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

/// Name and text of every recipe and template.
fn texts() -> Vec<(String, String)> {
    let read = |path: PathBuf| (path.display().to_string(), std::fs::read_to_string(&path).expect("a text"));
    let recipes = recipes().into_iter().map(read);
    recipes.chain(TEMPLATES.iter().map(|one| (one.name.to_owned(), one.text.to_owned()))).collect()
}

/// What the schema says against a recipe.
fn against(text: &str) -> Vec<String> {
    crate::json_schema::faults(&schema(), &toml::from_str(text).expect("recipes are TOML"))
}

#[test]
fn the_schema_takes_every_recipe_of_the_project() {
    for (name, text) in texts() {
        assert_eq!(against(&text), [""; 0], "{name}");
    }
}

#[test]
fn the_schema_and_the_check_refuse_the_same_keys() {
    let with = |step: &str, output: &str| {
        format!("[landscape]\nsize = 8\n[[step]]\ndo = \"plane\"\n[[step]]\n{step}\n[[output]]\n{output}\n")
    };
    let height = "layer = \"height\"\nfile = \"a.tif\"";
    let both = |text: &str, is_good: bool| {
        let checked = Recipe::parse("r.toml", text, &Overrides::default());
        assert_eq!(checked.is_ok(), is_good, "the check: {text}: {:?}", checked.err());
        assert_eq!(against(text).is_empty(), is_good, "the schema: {text}: {:?}", against(text));
    };
    for (step, is_good) in [
        ("do = \"hydraulic\"", true),
        ("do = \"hydraulic\"\nlaw = \"dissolution\"", true),
        ("do = \"hydraulic\"\ndeposition = 0.5", false),
        ("do = \"hydraulic\"\nmodel = \"mei\"\ndeposition = 0.5", true),
        ("do = \"hydraulic\"\nmodel = \"mei\"\nevaporation = 1.5", false),
        ("do = \"hydraulic\"\nmodel = \"stava\"\nevaporation = 1.5", true),
        ("do = \"hydraulic\"\nmodel = \"stava\"\nconserve = false", true),
        ("do = \"hydraulic\"\nconserve = false", false),
        ("do = \"hydraulic\"\nmodel = \"stava\"\nconserve = false\nepsilon = 1.0", false),
        ("do = \"flow\"\nexponent = 4.0", false),
        ("do = \"flow\"\nexponent = 4.0\nmethod = \"mfd\"", true),
    ] {
        both(&with(step, height), is_good);
    }
    for (keys, is_good) in [
        ("eye = [1, 2]", true),
        ("eye = [1, 2]\ndistance = 5.0", false),
        ("eye_height = 2.0", false),
        ("ground = \"materials\"\nsnow_line = 5.0", false),
        ("frames = 3\nframes_per_second = 5.0", true),
        ("frames_per_second = 5.0", false),
    ] {
        both(&with("do = \"slope\"", &format!("picture = \"view\"\nfile = \"a.png\"\n{keys}")), is_good);
    }
    both(&with("do = \"slope\"", height).replace("[landscape]", "weald = 2\n[landscape]"), false);
}

#[test]
fn every_recipe_says_its_format_and_has_the_names_of_today() {
    for (name, text) in texts() {
        let migrated = migrate(&name, &text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(migrated.changes, [], "{name}");
        assert_eq!(migrated.text, text, "{name}");
    }
}

#[test]
fn a_recipe_with_every_old_name_is_told_so_and_runs_when_rewritten() {
    let old = "# Of last year.\n\n[landscape]\nsize = 12 # cells\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"flow\"\n\
               [[step]]\ndo = \"constant\"\ninto = \"water\"\n[[step]]\ndo = \"lakes\"\nfrom = \"water\"\nfilm = 0.2\n\
               [[step]]\ndo = \"wetness\"\nleast_slope = 0.01\n[[step]]\ndo = \"moisture\"\nwater = \"water\"\nfilm = 0.1\n\
               [[step]]\ndo = \"curvature\"\nlevel_deg = 0.1\n[[step]]\ndo = \"sunlight\"\n[[step]]\ndo = \"soil\"\n\
               [[step]]\ndo = \"grass\"\n[[output]]\nexport = \"grass\"\nmost = 5000000\nfile = \"g.glb\"\n";
    let check = |text: &str| Recipe::parse("r.toml", text, &Overrides::default());
    let told = check(old).expect_err("old names").to_string();
    let lines: Vec<_> = told.lines().collect();
    assert_eq!(lines.len(), 5, "{told}");
    assert!(
        lines[0].starts_with("r.toml:15: lakes: `film` is now called `shallowest`; `weald migrate"),
        "{told}"
    );
    let migrated = migrate("r.toml", old).expect("it is rewritten");
    assert_eq!(migrated.changes.len(), 6, "{:?}", migrated.changes);
    let today = check(&migrated.text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(migrate("r.toml", &migrated.text).expect("again").text, migrated.text);
    let without_format = migrated.text.replace("weald = 1\n\n", "");
    assert_eq!(check(&without_format).expect("today's").hash(), today.hash());
    assert!(without_format.starts_with("# Of last year.\n\n[landscape]\nsize = 12 # cells\n"));
}

#[test]
fn layers_of_numbers_that_another_step_has_changed_are_refused_where_they_are_read() {
    let recipe = |before: &str, between: &str, after: &str| {
        let text = format!(
            "[landscape]\nsize = 16\n[[step]]\ndo = \"fbm\"\n{before}[[step]]\ndo = \"flow\"\n{between}[[step]]\ndo = \
             \"{after}\"\n[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n"
        );
        Recipe::parse("r.toml", &text, &Overrides::default())
    };
    let averaged = "[[step]]\ndo = \"resample\"\nsize = 8\n";
    let painted = "[[step]]\ndo = \"constant\"\nheight = 3.0\ninto = \"flow_direction\"\n";
    for between in [averaged, painted] {
        for after in ["watersheds", "rivers"] {
            let refused = recipe("", between, after).expect_err("refused").to_string();
            assert!(refused.contains("reads `flow_direction`, whose numbers step 3"), "{refused}");
            assert!(refused.contains("put a step `flow` between them"), "{refused}");
        }
    }
    recipe(averaged, "", "watersheds").expect("made behind it");
    recipe("", "", "watersheds").expect("as it was made");
}
