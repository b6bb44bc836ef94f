//! Draws a fern in the wind, and writes points with their codes for a viewer of point clouds.

use weald::prelude::Error;
use weald::recipe::{FractalRequest, Options, Run, Silent};

fn main() -> Result<(), Error> {
    let output = |keys: &[(&str, &str)]| {
        keys.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
    };
    let picture = [("picture", "fractal"), ("file", "weald_fern.png"), ("size", "160"), ("wind.speed", "4")];
    let points = [("export", "points"), ("file", "weald_fern.ply"), ("count", "20000")];
    let outputs = vec![output(&picture), output(&points)];
    let recipe = FractalRequest { of: "fern".to_owned(), outputs, ..Default::default() }.recipe()?;

    let folder = std::env::temp_dir();
    let options = Options { report: false, ..Options::into_folder(&folder) };
    let report = Run { recipe: &recipe, options }.execute(&Silent)?;
    assert_eq!(report.outputs.len(), 2);
    let bytes = std::fs::read(folder.join("weald_fern.ply")).expect("it was written");
    assert!(bytes.starts_with(b"ply\n") && bytes.len() > 20_000 * 12);
    Ok(())
}
