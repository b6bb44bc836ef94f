//! Rain on a cone of rock under sand: the sand is washed and slides down, the rock stands.

use weald::erode::hydraulic::{Model, StavaKeys};
use weald::material::Material;
use weald::prelude::{Error, Landscape, LandscapeExt, steps};
use weald::recipe::parameter::Nested;

fn main() -> Result<(), Error> {
    let mut landscape = Landscape::empty(64, 64, 2.0)?; // columns, rows, metres
    let sand = Material { thickness: 3.0, ..Material::built_in("sand").expect("a built-in material") };
    landscape.materials = vec![Material::built_in("rock").expect("a built-in material"), sand];
    landscape.run(&steps::Cone { peak: 60.0, slope: 1.2, ..Default::default() })?;

    let keys = StavaKeys { slippage: Some(Nested::default()), ..Default::default() };
    let rain = steps::Hydraulic { model: Model::Stava(keys), iterations: 200, ..Default::default() };
    let outcome = landscape.run(&rain)?;

    let (thinnest, thickest) = landscape.field("sand")?.range(None).expect("there are cells");
    println!("of 3 m of sand there are now {thinnest:.1} to {thickest:.1} m");
    assert!(thinnest < 2.5 && thickest > 3.5, "sand has moved: {thinnest} to {thickest} m");
    let budget = outcome.budget.expect("water is counted");
    assert!(budget.solid.error().abs() < 1e-4, "and none is lost: {:?}", budget.solid);
    landscape.save("sand", std::env::temp_dir().join("weald_sand.npy"))
}
