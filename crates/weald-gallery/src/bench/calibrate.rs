//! What the templates take on this machine, for estimates of recipes that have not run here.

use std::path::Path;
use std::time::Instant;

use weald::recipe::template::TEMPLATES;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald_core::error::Error;

/// Cells along the longer side: two sizes tell what grows with the cells and what does not.
const SIDES: [u64; 2] = [128, 256];

/// Steps and outputs that no template has.
const OTHERS: &str = include_str!("calibrate.toml");

/// Runs every template that reads no file and needs no device, and a recipe of all other steps, and keeps in `folder` what its steps and outputs took; its
/// files go into `out`. `report` is told each run and its seconds.
///
/// # Errors
/// Those of the runs.
pub fn calibrate(folder: &Path, out: &Path, report: &mut dyn FnMut(&str, f64)) -> Result<(), Error> {
    let templates = TEMPLATES.iter().map(|template| (template.name, template.text));
    for (name, text) in templates.chain([("others", OTHERS)]) {
        let file = format!("{name}.toml");
        let recipe = Recipe::parse(&file, text, &Overrides::default())?;
        let draws = recipe.outputs.iter().any(|output| output.render().is_some());
        if draws || !recipe.inputs().is_empty() {
            continue;
        }
        for side in SIDES {
            let overrides = Overrides { size: Some(side), ..Overrides::default() };
            let recipe = Recipe::parse(&file, text, &overrides)?;
            let started = Instant::now();
            let options = Options { timings: Some(folder.to_owned()), ..Options::into_folder(out) };
            Run { recipe: &recipe, options }.execute(&Silent)?;
            report(&format!("{name} {side}"), started.elapsed().as_secs_f64());
        }
    }
    Ok(())
}
