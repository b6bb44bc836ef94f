//! Random recipes: what passes the check runs to its end, with the same files for any number of threads.
//!
//! `WEALD_RANDOM_RECIPES=1000 cargo test -p weald --test weald random_recipes -- --nocapture` is the long version, whose
//! figures stand in CORRECTNESS.md; `WEALD_FIRST_RECIPE` is the first, `WEALD_KEEP_RECIPES` a folder for their texts,
//! `WEALD_RECIPE_SECONDS` how long a run may take, and `WEALD_RECIPES=7,31` are some of them alone, such as those that took too
//! long.

mod made;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use weald::Error;
use weald::picture::RayMarched;
use weald::recipe::{Options, Overrides, Progress, Recipe, Report, Run};

/// Recipes of the short version.
const FEW: u64 = 40;
/// Numbers of threads, whose files are compared.
const THREADS: [usize; 4] = [1, 2, 3, 5];
/// Seconds after which a run of the short version is ended; it then proves nothing.
const TIMEOUT: u64 = 5;

fn wanted(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// Ends a run that takes too long.
struct Patience {
    since: Instant,
    most: Duration,
}

impl Patience {
    fn begins() -> Self {
        let most = Duration::from_secs(wanted("WEALD_RECIPE_SECONDS").unwrap_or(TIMEOUT));
        Self { since: Instant::now(), most }
    }
}

impl Progress for Patience {
    fn cancelled(&self) -> bool {
        self.since.elapsed() > self.most
    }
}

/// What only the ground shows that a run makes, so that no check can tell it: numbers that grow without bound.
fn is_of_the_ground(error: &Error) -> bool {
    matches!(error, Error::NotFinite(_))
}

/// How a recipe ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused,
    Done,
    /// Refused by a step or an output for what is in a layer.
    OfTheGround,
    TooLong,
}

fn run(recipe: &Recipe, threads: usize, out: &Path) -> Result<Report, Error> {
    let options =
        Options { threads: Some(threads), render: Some(Arc::new(RayMarched)), ..Options::into_folder(out) };
    let progress = Patience::begins();
    catch_unwind(AssertUnwindSafe(|| Run { recipe, options }.execute(&progress)))
        .unwrap_or_else(|_| Err(Error::Run("it panicked".to_owned())))
}

/// All files below a folder with what is in them. What tells of seconds differs from run to run.
fn files(folder: &Path, below: &Path, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(folder.join(below)).expect("it can be listed") {
        let entry = entry.expect("it can be listed");
        let name = below.join(entry.file_name());
        if entry.path().is_dir() {
            files(folder, &name, found);
        } else if name.extension().is_none_or(|end| end != "html") && name != Path::new("report.json") {
            found.insert(name.display().to_string(), std::fs::read(entry.path()).expect("it can be read"));
        }
    }
}

fn written(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    files(folder, Path::new(""), &mut found);
    found
}

/// Checks and runs one recipe; an error says what is wrong with the outcome.
fn outcome(text: &str) -> Result<End, String> {
    let checked = Recipe::parse("r.toml", text, &Overrides::default());
    let recipe = match checked {
        Err(error) if [3, 5].contains(&error.exit_code()) => return Ok(End::Refused),
        Err(error) => return Err(format!("the check ends with {}: {error}", error.exit_code())),
        Ok(recipe) => recipe,
    };
    let outs = THREADS.map(|threads| (threads, tempfile::tempdir().expect("a folder")));
    for (threads, out) in &outs {
        match run(&recipe, *threads, out.path()) {
            Ok(_) => {}
            Err(Error::Interrupted(_)) => return Ok(End::TooLong),
            Err(error) if is_of_the_ground(&error) => {
                println!("of the ground, {}: {error}", error.exit_code());
                return Ok(End::OfTheGround);
            }
            Err(error) => {
                return Err(format!("good, but the run ends with {}: {error}", error.exit_code()));
            }
        }
    }
    let [one, others @ ..] = outs.map(|(threads, out)| (threads, written(out.path())));
    for (threads, other) in &others {
        let mut names = one.1.keys().chain(other.keys());
        if let Some(name) = names.find(|name| one.1.get(*name) != other.get(*name)) {
            return Err(format!("{name} differs between 1 and {threads} threads"));
        }
    }
    Ok(End::Done)
}

/// The numbers of the recipes to run.
fn numbers() -> Vec<u64> {
    if let Ok(some) = std::env::var("WEALD_RECIPES") {
        return some.split(',').map(|number| number.parse().expect("a number of a recipe")).collect();
    }
    let first = wanted("WEALD_FIRST_RECIPE").unwrap_or(0);
    (first..first + wanted("WEALD_RANDOM_RECIPES").unwrap_or(FEW)).collect()
}

#[test]
fn what_passes_the_check_runs_to_its_end_with_the_same_files_for_any_number_of_threads() {
    let numbers = numbers();
    let count = numbers.len() as u64;
    let mut ends: BTreeMap<End, u64> = BTreeMap::new();
    let mut faults = Vec::new();
    for seed in numbers {
        let text = made::recipe(seed);
        if let Some(folder) = std::env::var_os("WEALD_KEEP_RECIPES") {
            std::fs::write(Path::new(&folder).join(format!("r{seed}.toml")), &text).expect("written");
        }
        match outcome(&text) {
            Ok(end) => {
                if end == End::TooLong {
                    println!("recipe {seed}: took too long");
                }
                *ends.entry(end).or_default() += 1;
            }
            Err(fault) => {
                if count > FEW {
                    println!("recipe {seed}: {fault}");
                }
                faults.push(format!("recipe {seed}: {fault}\n{text}"));
            }
        }
    }
    println!("{count} random recipes: {ends:?}, faults: {}", faults.len());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let done = ends.get(&End::Done).copied().unwrap_or_default();
    assert!(5 * done > count, "only {done} of {count} recipes ran");
}
