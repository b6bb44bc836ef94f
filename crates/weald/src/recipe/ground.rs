//! The landscape before the first step.

use std::path::Path;

use super::layer_file::LayerFile;
use super::layer_output::placeless;
use super::plan::{FractalSource, Ground, PlannedFractal, Recipe};
use crate::ground_file;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::sea;
use weald_io::Said;
use weald_plants::Fractal;
use weald_plants::Vegetation;
use weald_plants::ifs::{Ifs, flame};

/// Makes or reads the ground and its materials; the texts tell the user what had to be done to it.
pub(super) fn load(recipe: &Recipe) -> Result<(Landscape, Vec<String>), Error> {
    let (mut landscape, mut notes) = match &recipe.ground {
        Ground::Empty { size, cell, finest } => {
            let first = recipe.first_grid(*size, *cell, *finest);
            // A recipe that was read for a run out of core may be larger.
            Size::new(first.size.columns, first.size.rows)?;
            (Landscape::new(first), Vec::new())
        }
        Ground::File { path, cell, said } => ground_file::read(path, *cell, said)?,
    };
    landscape.domain.sea_level = recipe.sea_level;
    sea::stand(&mut landscape)?;
    landscape.materials = materials(recipe);
    landscape.set_fractals(fractals(recipe)?);
    for planned in &recipe.materials {
        let Some((path, scale, said)) = planned.file.clone() else { continue };
        let file = LayerFile { scale, said, ..LayerFile::plain(path) };
        let (thickness, more) = file.read(&landscape.domain)?;
        landscape.insert(&planned.material.name, "m", thickness);
        notes.extend(more);
    }
    Ok((landscape, notes))
}

/// The file from which the ground comes, with what the recipe says of it.
pub(super) fn source(recipe: &Recipe) -> Option<(&Path, &Said)> {
    match &recipe.ground {
        Ground::File { path, said, .. } => Some((path, said)),
        Ground::Empty { .. } => None,
    }
}

/// Refuses outputs on the grid of a file that does not say where it lies, before the first step.
pub(super) fn check_outputs(recipe: &Recipe, landscape: &Landscape) -> Result<(), Error> {
    let goes_back = recipe.outputs.iter().any(|output| output.treatment().to_source.is_some());
    match source(recipe) {
        Some((path, _)) if goes_back && landscape.domain.georeference.is_none() => Err(placeless(path)),
        _ => Ok(()),
    }
}

/// What the ground is made of.
pub(super) fn materials(recipe: &Recipe) -> Vec<Material> {
    recipe.materials.iter().map(|planned| planned.material.clone()).collect()
}

impl Recipe {
    /// The materials of its tables, bedrock first.
    pub fn make_materials(&self) -> Vec<Material> {
        materials(self)
    }

    /// The fractals of its `[[fractal]]` tables, as a landscape carries them.
    ///
    /// # Errors
    /// [`Error::Input`] for a file of flames.
    pub fn make_fractals(&self) -> Result<Vec<Fractal>, Error> {
        fractals(self)
    }
}

/// The fractals of the recipe, those of files with them.
pub(super) fn fractals(recipe: &Recipe) -> Result<Vec<Fractal>, Error> {
    recipe.fractals.iter().map(fractal).collect()
}

fn fractal(planned: &PlannedFractal) -> Result<Fractal, Error> {
    let ifs = match &planned.fractal_source {
        FractalSource::Known(ifs) => (**ifs).clone(),
        FractalSource::Flame { path, number } => flame(path, *number)?,
    };
    let fractal = Fractal { name: planned.name.clone(), ifs, deform: planned.deform.clone() };
    if let (FractalSource::Flame { path, .. }, Err(faults)) = (&planned.fractal_source, fractal.deformation())
    {
        let name = &planned.name;
        return Err(Error::input(
            path,
            format!("its fractal does not go with the deformations of `{name}`: {}", faults.join("; ")),
        ));
    }
    Ok(fractal)
}

/// One flame of a file, counted from 1.
fn flame(path: &Path, number: usize) -> Result<Ifs, Error> {
    let flames = flame::read(path)?;
    let count = flames.len();
    let found = number.checked_sub(1).and_then(|place| flames.into_iter().nth(place));
    found.ok_or_else(|| Error::input(path, format!("has {count} flames; there is no number {number}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Overrides;

    fn faults(landscape: &str, output: &str) -> String {
        let text = format!(
            "[landscape]\n{landscape}\n[[step]]\ndo = \"flow\"\n[[output]]\nfile = \"a.tif\"\n{output}\n"
        );
        Recipe::parse("r.toml", &text, &Overrides::default())
            .map_or_else(|error| error.to_string(), |_| String::new())
    }

    #[test]
    fn what_cannot_go_back_is_refused_with_the_recipe() {
        let from = "from = \"dem.tif\"";
        assert_eq!(faults(from, "layer = \"accumulation\"\ngrid = \"source\""), "");
        assert_eq!(faults(from, "layer = \"accumulation\"\ngrid = \"source\"\nresampling = \"linear\""), "");
        assert_eq!(faults(from, "layer = \"flow_direction\"\ncodes = \"esri\""), "");
        let flat = "size = 8\n[[step]]\ndo = \"constant\"";
        for (landscape, output, part) in [
            (flat, "layer = \"accumulation\"\ngrid = \"source\"", "needs `from` in [landscape]"),
            (
                from,
                "layer = \"accumulation\"\nresampling = \"linear\"",
                "`resampling` has no effect without grid = \"source\"",
            ),
            (
                from,
                "layer = \"accumulation\"\ncodes = \"esri\"",
                "`codes` goes with layer = \"flow_direction\"",
            ),
            (
                from,
                "layer = \"flow_direction\"\ngrid = \"source\"",
                "lead to neighbours that another grid has not",
            ),
            (from, "picture = \"relief\"\ngrid = \"source\"", "`grid`"),
            (from, "layer = \"height\"\ngrid = \"sorce\"", "one of \"landscape\" | \"source\""),
        ] {
            let message = faults(landscape, output);
            assert!(message.contains(part), "{part}: {message}");
        }
    }
}
