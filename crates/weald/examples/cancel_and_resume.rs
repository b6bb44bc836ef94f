//! Runs a recipe with progress, stops it half-way as Ctrl-C does, and goes on from the checkpoint.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use weald::prelude::Error;
use weald::recipe::{Options, Overrides, Progress, Recipe, Run, Silent};

/// Wants the run to end after 150 iterations.
struct Impatient(AtomicU64);

impl Progress for Impatient {
    fn progress(&self, done: u64, total: u64, _cells: usize) {
        println!("{done} of {total}");
        self.0.store(done, Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.0.load(Relaxed) >= 150
    }
}

const RECIPE: &str = "landscape = { size = [48, 48], cell = 20.0, seed = 7 }
    step = [{ do = 'fbm' }, { do = 'hydraulic', iterations = 600 }]
    output = [{ layer = 'height', file = 'height.npy' }]";

fn main() -> Result<(), Error> {
    let recipe = Recipe::parse("valley.toml", RECIPE, &Overrides::default())?;
    let folder = std::env::temp_dir().join(format!("weald_cancel_{}", std::process::id()));
    let options = Options::into_folder(&folder);
    let run = Run { recipe: &recipe, options: options.clone() };
    let stopped = run.landscape(&Impatient(AtomicU64::new(0))).expect_err("it was impatient");
    assert!(matches!(stopped, Error::Interrupted(_)), "{stopped}");

    let resumed = Run { recipe: &recipe, options: Options { resume: true, ..options } }.landscape(&Silent)?;
    assert_eq!(resumed, recipe.landscape()?, "the same bits as without the stop");
    std::fs::remove_dir_all(&folder).expect("the folder is there");
    Ok(())
}
