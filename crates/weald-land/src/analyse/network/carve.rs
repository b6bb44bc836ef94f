//! Where the ground was carved: whether the deepest cuts connect, and whether they follow the water.

use super::drainage::Drainage;
use super::ground::Ground;
use super::power_law::line;
use super::valleys::deepest;

/// The deepest cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carve {
    /// Length of the longest connected cut over the longer side of the grid, among the twentieth of the land
    /// that lost most height.
    pub reach: f64,
    /// Share of those cells that belong to the largest connected cut.
    pub largest: f64,
    /// Correlation, -1 to 1, of the logarithms of lost height and of the upslope area of a cell, over
    /// the cells that lost height. It does not tell networks from gullies.
    pub against_area: f64,
}

/// Compares the ground with what it was; `before` in cells.
pub(super) fn carve(ground: &Ground<'_>, before: &[f64], drainage: &Drainage) -> Carve {
    let lost: Vec<f64> = before.iter().zip(&ground.height).map(|(before, after)| before - after).collect();
    let carved = drainage.order.iter().filter(|&&cell| lost[cell] > 0.0);
    let points: Vec<[f64; 2]> =
        carved.map(|&cell| [libm::log(drainage.area[cell]), libm::log(lost[cell])]).collect();
    let cut = deepest(ground, &lost);
    Carve { reach: cut.reach, largest: cut.largest, against_area: line(&points).correlation }
}
