//! What the figures of layered ground share: materials, runs of the model, pictures, and slopes.

use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_picture::{Along, Image, Materials, Picture, Section};

/// Publication of the model.
pub(super) const SOURCE: &str = "Šťava, Beneš, Brisbin, Křivánek 2008, doi 10.2312/SCA/SCA08/201-210";

/// A material that is like a built-in one, under a name of its own.
pub(super) fn material(name: &str, like: &str) -> Material {
    let built_in = Material::built_in(like).expect("figures name built-in materials only");
    Material { name: name.to_owned(), ..built_in }
}

/// Ground of these materials, with cells of `cell` metres.
pub(super) fn ground(height: Field, cell: f64, materials: Vec<Material>) -> Landscape {
    let mut landscape = Landscape::new(Domain::new(height.size(), cell));
    landscape.materials = materials;
    landscape.insert("height", "m", height);
    landscape
}

/// The ground after a run of the model over open edges, without rain and evaporation.
pub(super) fn simulated(start: &Landscape, iterations: u32, keys: &str) -> Result<Landscape, Error> {
    let mut landscape = start.clone();
    let keys = format!(
        "model = \"stava\"\niterations = {iterations}\nrain = 0.0\nevaporation = 0.0\nboundary = \"open\"\n{keys}"
    );
    run_steps(&mut landscape, 0, &[("hydraulic", &keys)])?;
    Ok(landscape)
}

/// Each landscape from above, side by side.
pub(super) fn from_above(landscapes: &[&Landscape]) -> Result<Image, Error> {
    let picture = Materials { width: Some(640), ..Materials::default() };
    beside(landscapes, &picture)
}

/// Each landscape cut open from west to east or from north to south at a share of its way, side by side.
pub(super) fn cut_open(landscapes: &[&Landscape], along: Along, at: f64) -> Result<Image, Error> {
    beside(landscapes, &Section { along, at, width: 640, ..Section::default() })
}

fn beside(landscapes: &[&Landscape], picture: &dyn Picture) -> Result<Image, Error> {
    let images: Result<Vec<_>, _> = landscapes.iter().map(|landscape| picture.render(landscape)).collect();
    Ok(Image::beside(&images?, 10))
}

/// The four neighbours of a cell that is not at the edge.
pub(super) fn four(size: Size, at: usize) -> [usize; 4] {
    [at - size.columns, at - 1, at + 1, at + size.columns]
}

/// Steepest fall to one of the four neighbours from a cell that is not at the edge, as a tangent.
pub(super) fn steepest_fall(height: &Field, at: usize, cell: f64) -> f64 {
    let fall = |next: usize| f64::from(height.values()[at] - height.values()[next]);
    four(height.size(), at).map(fall).into_iter().fold(0.0, f64::max) / cell
}
