//! Makes ground, erodes it, paints a dam, finds the rivers and writes a GeoTIFF.

use weald::prelude::{Brush, Effect, Error, Landscape, LandscapeExt, steps};

fn main() -> Result<(), Error> {
    let mut landscape = Landscape::empty(96, 64, 20.0)?; // columns, rows, metres
    landscape.run_with(&steps::DiamondSquare { relief: 300.0, ..Default::default() }, 7)?;
    landscape.run(&steps::Hydraulic { iterations: 120, ..Default::default() })?;
    let dam = Effect::Add { material: "soil".to_owned(), thickness: 15.0 };
    landscape.paint(&Brush::line(dam, &[[900.0, 200.0], [900.0, 1100.0]], 60.0))?;
    landscape.run(&steps::Flow::default())?;
    landscape.run(&steps::Rivers::default())?;
    assert!(landscape.field("river")?.sum() > 50.0, "there are rivers");
    landscape.save("height", std::env::temp_dir().join("weald_six_names.tif"))
}
