//! Results of steps that are kept: what is run again, what is not, and that it makes no difference to the bits.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use weald::edit::{Brush, Effect};
use weald::engine::Job;
use weald::parameter::Diagnostics;
use weald::random::{hash2, unit};
use weald::recipe::catalog::CATALOG;
use weald::recipe::source::Table;
use weald::recipe::{
    Cache, CacheLimits, Options, Overrides, Recipe, Report, Run, Session, SessionOptions, Silent,
};
use weald::step::{Layered, Stage};
use weald::{LandscapeExt, steps};

const RECIPE: &str = r#"
[landscape]
size = [96, 80]
cell = 20.0
seed = 7
[[material]]
name = "rock"
[[material]]
name = "soil"
thickness = 1.5
[[step]]
do = "diamond-square"
relief = 300.0
[[step]]
do = "hydraulic"
model = "stava"
iterations = 120
[[step]]
do = "thermal"
iterations = 60
[[step]]
do = "slope"
[[step]]
do = "flow"
[[step]]
do = "rivers"
[[step]]
do = "sunlight"
directions = 8
[[step]]
do = "wetness"
[[step]]
do = "moisture"
[[step]]
do = "soil"
[[step]]
do = "select"
where = [{ layer = "slope", below = 20.0, soft = 8.0 }]
into = "gentle"
[[step]]
do = "scatter"
plant = "fern"
into = "ferns"
spacing = 60.0
where = [{ layer = "gentle", above = 0.3, soft = 0.4 }]
[[output]]
layer = "height"
file = "h.npy"
[[output]]
layer = "gentle"
file = "g.npy"
[[output]]
layer = "river"
file = "r.npy"
[[output]]
layer = "soil_depth"
file = "s.npy"
[[output]]
export = "plants"
of = "ferns"
file = "ferns.csv"
"#;

fn parse(folder: &Path, text: &str) -> Recipe {
    let file = folder.join("r.toml").display().to_string();
    Recipe::parse(&file, text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn run(folder: &Path, text: &str, cache: Option<&Arc<Cache>>) -> Report {
    let options = Options { cache: cache.cloned(), ..Options::into_folder(folder.join("out")) };
    let recipe = parse(folder, text);
    Run { recipe: &recipe, options }.execute(&Silent).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The steps that ran, by their names.
fn ran(report: &Report) -> Vec<&str> {
    report.steps.iter().filter(|step| !step.cached).map(|step| step.step.as_str()).collect()
}

/// All files but the report.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = fs::read_dir(folder.join("out"))
        .expect("there are outputs")
        .map(|entry| entry.expect("is readable").path())
        .filter(|path| path.is_file() && path.extension().is_none_or(|extension| extension != "json"))
        .map(|path| (path.display().to_string(), fs::read(&path).expect("is readable")))
        .collect();
    files.sort();
    files
}

/// Everything is worth keeping here, however quickly it was made.
fn cache(folder: &Path) -> Arc<Cache> {
    let limits = CacheLimits { memory: 0, ..CacheLimits::default() };
    Arc::new(Cache::in_folder(folder.join("cache"), limits).keeping_all())
}

#[test]
fn only_the_changed_step_and_what_depends_on_it_run_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let (folder, cache) = (folder.path(), cache(folder.path()));
    assert_eq!(ran(&run(folder, RECIPE, Some(&cache))).len(), 12);
    let first = files(folder);
    assert_eq!(ran(&run(folder, RECIPE, Some(&cache))), [""; 0], "nothing has changed");
    assert_eq!(files(folder), first);
    let change = |from: &str, to: &str| {
        assert!(RECIPE.contains(from), "{from}");
        let text = RECIPE.replace(from, to);
        let report = run(folder, &text, Some(&cache));
        ran(&report).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(change("below = 20.0", "below = 15.0"), ["select", "scatter"]);
    assert_eq!(change("spacing = 60.0", "spacing = 70.0"), ["scatter"]);
    assert_eq!(change("directions = 8", "directions = 9")[0], "sunlight");
    assert!(!change("directions = 8", "directions = 10").contains(&"rivers".to_owned()));
    assert_eq!(
        change("iterations = 60", "iterations = 61").len(),
        10,
        "thermal and all that reads the ground"
    );
    assert_eq!(change("seed = 7", "seed = 8").len(), 12);
    assert_eq!(change("thickness = 1.5", "thickness = 1.6").len(), 12, "a material is another one");
    assert_eq!(change("file = \"h.npy\"", "file = \"height.npy\""), [""; 0], "an output is no step");
}

/// A recipe with some of its numbers changed, and steps left out.
fn edited(seed: u64) -> String {
    let random = |which: i64| unit(hash2(seed, 5, which));
    let pick =
        |which: i64, values: &[&str]| values[(random(which) * values.len() as f64) as usize].to_owned();
    let mut text = RECIPE
        .replace("relief = 300.0", &pick(0, &["relief = 300.0", "relief = 200.0"]))
        .replace(
            "iterations = 120",
            &pick(1, &["iterations = 120", "iterations = 90", "iterations = 120\ndissolution = {}"]),
        )
        .replace("iterations = 60", &pick(2, &["iterations = 60", "iterations = 30"]))
        .replace("below = 20.0", &pick(3, &["below = 20.0", "below = 30.0", "above = 10.0"]))
        .replace("spacing = 60.0", &pick(4, &["spacing = 60.0", "spacing = 90.0"]))
        .replace("seed = 7", &pick(5, &["seed = 7", "seed = 7", "seed = 9"]))
        .replace("thickness = 1.5", &pick(6, &["thickness = 1.5", "thickness = 0.5"]))
        .replace("size = [96, 80]", &pick(7, &["size = [96, 80]", "size = [96, 80]", "size = [72, 60]"]));
    if random(8) < 0.4 {
        text = text.replace("[[step]]\ndo = \"thermal\"\niterations = 60\n", "");
    }
    if random(9) < 0.3 {
        text = text.replace(
            "[[step]]\ndo = \"slope\"",
            "[[step]]\ndo = \"resample\"\nsize = [48, 40]\n[[step]]\ndo = \"slope\"",
        );
    }
    text
}

#[test]
fn cached_and_fresh_results_are_equal_to_the_bit_over_random_edits() {
    let folder = tempfile::tempdir().expect("a folder");
    let (cached_in, fresh_in) = (folder.path().join("cached"), folder.path().join("fresh"));
    for folder in [&cached_in, &fresh_in] {
        fs::create_dir(folder).expect("made");
    }
    let cache = cache(folder.path());
    let mut taken = 0;
    for seed in 0..60 {
        let text = edited(seed);
        let report = run(&cached_in, &text, Some(&cache));
        taken += report.steps.iter().filter(|step| step.cached).count();
        run(&fresh_in, &text, None);
        let names = |files: Vec<(String, Vec<u8>)>| -> Vec<_> {
            files
                .into_iter()
                .map(|(name, bytes)| (name.rsplit('/').next().map(str::to_owned), bytes))
                .collect()
        };
        assert!(names(files(&cached_in)) == names(files(&fresh_in)), "edit {seed}:\n{text}");
        fs::remove_dir_all(cached_in.join("out")).expect("removed");
        fs::remove_dir_all(fresh_in.join("out")).expect("removed");
    }
    assert!(taken > 90, "{taken} steps were taken from the cache");
}

#[test]
fn a_damaged_or_a_foreign_entry_is_never_believed() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    run(folder, RECIPE, Some(&cache(folder)));
    let first = files(folder);
    let entries = || -> Vec<_> {
        let entries = fs::read_dir(folder.join("cache")).expect("is there");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("is readable").path()).collect();
        paths.sort();
        paths
    };
    assert_eq!(entries().len(), 12);
    for (number, path) in entries().iter().enumerate() {
        let mut bytes = fs::read(path).expect("is readable");
        let at = (number * 7919) % bytes.len();
        bytes[at] ^= 0x10;
        fs::write(path, bytes).expect("written");
    }
    assert_eq!(ran(&run(folder, RECIPE, Some(&cache(folder)))).len(), 12, "all are damaged");
    assert_eq!(files(folder), first);
    let paths = entries();
    let bytes: Vec<_> = paths.iter().map(|path| fs::read(path).expect("is readable")).collect();
    for (at, path) in paths.iter().enumerate() {
        fs::write(path, &bytes[(at + 1) % bytes.len()]).expect("written");
    }
    assert_eq!(ran(&run(folder, RECIPE, Some(&cache(folder)))).len(), 12, "all are of something else");
    assert_eq!(files(folder), first);
    for path in entries() {
        fs::write(path, b"").expect("written");
    }
    assert_eq!(ran(&run(folder, RECIPE, Some(&cache(folder)))).len(), 12, "all are empty");
}

/// What is kept is found by the layers that a step says it reads, so that it may look at no others.
#[test]
fn no_step_but_a_simulation_looks_at_a_layer_that_it_does_not_say_it_reads() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut whole = parse(folder.path(), RECIPE).landscape().expect("runs");
    whole.run(&steps::Lakes::default()).expect("there are lakes");
    let mut compared = Vec::new();
    for entry in CATALOG.iter().filter(|entry| entry.stage != Stage::Erode) {
        let mut diagnostics = Diagnostics::default();
        let step = (entry.read)(&Table::default(), &mut diagnostics);
        let mut seen: Vec<_> = step.reads();
        seen.extend(step.reads_where_there());
        if step.layered() != Layered::Never {
            seen.extend(["bedrock", "soil", "regolith"].map(str::to_owned));
        }
        let mut restricted = whole.clone();
        let hidden: Vec<_> =
            whole.layers().map(|(name, _)| name.to_owned()).filter(|name| !seen.contains(name)).collect();
        for name in &hidden {
            drop(restricted.remove(name));
        }
        let (mut full, job) = (whole.clone(), || Job::unwatched(3));
        let Ok(outcome) = step.run(&mut full, &job()) else { continue };
        let other = step.run(&mut restricted, &job());
        assert_eq!(other.as_ref().map_err(ToString::to_string), Ok(&outcome), "{}", entry.name);
        for (name, _) in step.writes() {
            assert!(full.field(&name).ok() == restricted.field(&name).ok(), "{}: {name}", entry.name);
        }
        for plants in step.plants() {
            assert!(full.plants(&plants).ok() == restricted.plants(&plants).ok(), "{}: {plants}", entry.name);
        }
        compared.push(entry.name);
    }
    assert!(compared.len() > 25, "{compared:?}");
}

#[test]
fn a_changed_file_runs_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let (folder, cache) = (folder.path(), cache(folder.path()));
    run(folder, RECIPE, None);
    fs::copy(folder.join("out/h.npy"), folder.join("dem.npy")).expect("copied");
    let text = "[landscape]\nfrom = \"dem.npy\"\ncell = 20.0\n[[step]]\ndo = \"slope\"\n[[step]]\ndo = \"load\"\n\
                file = \"dem.npy\"\ninto = \"other\"\n[[output]]\nlayer = \"slope\"\nfile = \"slope.npy\"\n\
                [[output]]\nlayer = \"other\"\nfile = \"other.npy\"\n";
    assert_eq!(ran(&run(folder, text, Some(&cache))).len(), 2);
    assert_eq!(ran(&run(folder, text, Some(&cache))).len(), 0);
    let mut bytes = fs::read(folder.join("dem.npy")).expect("is there");
    let last = bytes.len() - 2;
    bytes[last] ^= 1;
    fs::write(folder.join("dem.npy"), bytes).expect("written");
    assert_eq!(ran(&run(folder, text, Some(&cache))).len(), 2);
}

#[test]
fn a_sea_at_another_level_runs_again() {
    let (own, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let cache = cache(own.path());
    for level in [40, 150] {
        let text = RECIPE.replace("seed = 7", &format!("seed = 7\nsea_level = {level}"));
        let report = run(own.path(), &text, Some(&cache));
        assert!(ran(&report).contains(&"flow"), "{level} m: {:?}", ran(&report));
        run(other.path(), &text, None);
        let bytes = |folder: &Path| files(folder).into_iter().map(|(_, bytes)| bytes).collect::<Vec<_>>();
        assert!(bytes(own.path()) == bytes(other.path()), "{level} m");
    }
}

#[test]
fn what_is_kept_stays_within_its_limits() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let limits = CacheLimits { memory: 200_000, disk: 300_000 };
    let cache = Arc::new(Cache::in_folder(folder.join("cache"), limits).keeping_all());
    for seed in 0..6 {
        run(folder, &edited(seed), Some(&cache));
        assert!(cache.bytes_in_memory() <= limits.memory, "{} bytes", cache.bytes_in_memory());
        let entries = fs::read_dir(folder.join("cache")).expect("is there");
        let bytes: u64 =
            entries.map(|entry| entry.and_then(|entry| entry.metadata()).expect("is there").len()).sum();
        assert!(bytes > 0 && bytes <= limits.disk + 100_000, "{bytes} bytes");
        fs::remove_dir_all(folder.join("out")).expect("removed");
    }
}

#[test]
fn a_session_takes_what_a_run_has_left_and_what_follows_from_strokes_is_kept_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let (folder, cache) = (folder.path(), cache(folder.path()));
    run(folder, RECIPE, Some(&cache));
    let open = || {
        let options =
            SessionOptions { step: Some(2), cache: Some(Arc::clone(&cache)), ..SessionOptions::default() };
        Session::open(parse(folder, RECIPE), options, &Silent).expect("opens")
    };
    let finish = |depth: f64| {
        let mut session = open();
        session.advance(20).expect("runs");
        session.paint(Brush::dab(Effect::AddWater { depth }, [900.0, 800.0], 300.0)).expect("paints");
        session.advance(20).expect("runs");
        session.finish(&Silent).expect("runs")
    };
    let [one, other, again] = [1.0, 30.0, 1.0].map(finish);
    assert!(one.field("height").ok() != other.field("height").ok(), "another stroke, another landscape");
    assert_eq!(one.field("river").ok(), again.field("river").ok());
    let mut session = open();
    let untouched = session.finish(&Silent).expect("runs");
    assert!(untouched.field("slope").ok() != one.field("slope").ok());
}
