//! Reads an elevation model, finds its rivers as lines, and measures them.

use weald::analyse::rivers::{Reach, Rivers};
use weald::prelude::{Error, Landscape, LandscapeExt, steps};

fn main() -> Result<(), Error> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/jacksboro_fault_utm16_80m.tif");
    let mut landscape = Landscape::open(file)?;
    landscape.run(&steps::Flow::default())?;
    landscape.run(&steps::Rivers { area: Some(5.0e6), ..Default::default() })?;

    let rivers = Rivers::of(&landscape)?;
    let length: f64 = rivers.reaches.iter().map(Reach::length).sum();
    let land = landscape.domain.valid_cells() as f64 * landscape.domain.cell_area();
    let order = rivers.reaches.iter().map(|reach| reach.order).max();
    println!("{:.0} km of rivers, {:.2} km/km²", length / 1000.0, 1000.0 * length / land);
    assert!((0.1..2.0).contains(&(1000.0 * length / land)), "a plausible drainage density");
    assert!(order >= Some(3), "Strahler order {order:?}");

    let georeference = landscape.domain.georeference.as_ref();
    assert_eq!(georeference.and_then(|place| place.epsg), Some(32616), "UTM, zone 16 north");
    Ok(())
}
