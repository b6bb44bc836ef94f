//! The landscape before the first step.

use std::path::Path;

use super::layer_file::LayerFile;
use super::plan::{FractalSource, Ground, PlannedFractal, Recipe};
use crate::ground_file;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_plants::Fractal;
use weald_plants::Vegetation;
use weald_plants::ifs::{Ifs, flame};

/// Makes or reads the ground and its materials; the texts tell the user what had to be done to it.
pub(super) fn load(recipe: &Recipe) -> Result<(Landscape, Vec<String>), Error> {
    let (mut landscape, mut notes) = match &recipe.ground {
        Ground::Empty { size, cell, finest } => {
            (Landscape::new(Domain { finest: *finest, ..Domain::new(*size, *cell) }), Vec::new())
        }
        Ground::File { path, cell, said } => ground_file::read(path, *cell, said)?,
    };
    landscape.materials = materials(recipe);
    landscape.set_fractals(fractals(recipe)?);
    for planned in &recipe.materials {
        let Some((path, scale)) = planned.file.clone() else { continue };
        let file = LayerFile { scale, ..LayerFile::plain(path) };
        let (thickness, more) = file.read(&landscape.domain)?;
        landscape.insert(&planned.material.name, "m", thickness);
        notes.extend(more);
    }
    Ok((landscape, notes))
}

/// What the ground is made of.
pub(super) fn materials(recipe: &Recipe) -> Vec<Material> {
    recipe.materials.iter().map(|planned| planned.material.clone()).collect()
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
