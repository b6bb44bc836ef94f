//! Upslope areas on a real elevation model, beside those of GRASS GIS. `tests/data/README.md` has the commands.

use std::path::{Path, PathBuf};

use weald::analyse::flow::{Routing, accumulate, route};
use weald::io;

fn near(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Pearson's correlation.
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |axis: usize| pairs.iter().map(|pair| pair[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let product = |f: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(f).sum::<f64>();
    let covariance = product(&|pair| (pair[0] - x) * (pair[1] - y));
    covariance / (product(&|pair| (pair[0] - x).powi(2)) * product(&|pair| (pair[1] - y).powi(2))).sqrt()
}

/// Correlation of the logarithms of our areas and those of a file, and the number of cells.
fn agreement(file: &str) -> (f64, usize) {
    let ground = io::read(&near("../../data/jacksboro_fault_utm16_80m.tif")).expect("the model is there");
    let theirs = io::read(&near(file)).expect("the result is there");
    let land = ground.land.as_ref().expect("its corners have no data");
    let routed = route(&ground.field, Some(land), &Routing::default());
    let ours = accumulate(&routed.directions, Some(land), None);
    let known = |cell: &usize| {
        land.is_land_at(*cell) && theirs.land.as_ref().is_none_or(|known| known.is_land_at(*cell))
    };
    let pair = |cell: usize| [ours[cell].ln(), f64::from(theirs.field.values()[cell].max(1.0)).ln()];
    let pairs: Vec<_> = (0..ours.len()).filter(known).map(pair).collect();
    (correlation(&pairs), pairs.len())
}

#[test]
fn areas_after_filling_agree_with_those_of_r_terraflow() {
    let (correlation, cells) = agreement("tests/data/jacksboro_accumulation_terraflow.tif");
    assert!(cells > 145_000, "{cells} cells are compared");
    assert!(correlation >= 0.99, "{correlation}");
    println!("terraflow {correlation} {cells}");
}

#[test]
fn areas_after_filling_agree_with_those_of_r_watershed() {
    let (correlation, cells) = agreement("tests/data/jacksboro_accumulation_watershed.tif");
    assert!(cells > 145_000, "{cells} cells are compared");
    println!("watershed {correlation} {cells}");
    assert!(correlation >= 0.99, "{correlation}");
}
