//! The fractal ground that the figures of Han 2015 begin with.

use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;

/// Seed of the ground in figures that show a single one.
pub(super) const SEED: u64 = 3;

/// Fractal ground of `side` cells with a relief of a fifth of that, cells of size 1.
pub(super) fn start_terrain(side: usize, seed: u64) -> Result<Landscape, Error> {
    let mut landscape = Landscape::new(Domain::new(Size::square(side)?, 1.0));
    let keys = format!("relief = {:?}\nroughness = 0.9", side as f64 / 256.0 * 50.0);
    run_steps(&mut landscape, seed, &[("diamond-square", &keys)])?;
    Ok(landscape)
}
