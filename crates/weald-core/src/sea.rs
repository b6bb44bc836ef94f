//! The sea: ground no higher than its level that is connected to the border of the grid or of the data by such ground.
//!
//! Hollows inland lie dry, however deep. Where a landscape has a sea level, the sea stands in its layer `water` beside
//! rivers and lakes, so that whatever asks for water finds it, and alone in `sea_depth`.

use crate::domain::Domain;
use crate::error::Error;
use crate::grid::{Field, Size};
use crate::landscape::Landscape;

/// Layer of the ground under the sea.
const GROUND: &str = "height";

/// Layer of the depth of water.
const WATER: &str = "water";

/// Layer of the depth of the sea alone.
const SEA: &str = "sea_depth";

/// The layers that a landscape with a sea has from the start.
pub const LAYERS: [&str; 2] = [WATER, SEA];

/// Which cells the sea reaches, of those that are low enough; by the numbers of cells, row by row.
pub fn reach(size: Size, is_low: impl Fn(usize) -> bool, has_data: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut reached = vec![false; size.cells()];
    let at_border = |cell: usize| {
        let (x, y) = (cell % size.columns, cell / size.columns);
        x == 0
            || y == 0
            || x + 1 == size.columns
            || y + 1 == size.rows
            || size.neighbours(cell).any(|c| !has_data(c))
    };
    let is_open = |cell: usize| has_data(cell) && is_low(cell);
    let mut open: Vec<usize> = (0..size.cells()).filter(|&cell| is_open(cell) && at_border(cell)).collect();
    for &cell in &open {
        reached[cell] = true;
    }
    while let Some(cell) = open.pop() {
        for beside in size.neighbours(cell) {
            if !reached[beside] && is_open(beside) {
                reached[beside] = true;
                open.push(beside);
            }
        }
    }
    reached
}

/// Which cells of a landscape with a sea level are sea, over the ground of `height` in metres; `None` without one.
pub fn cells(landscape: &Landscape, height: &Field) -> Option<Vec<bool>> {
    cells_on(&landscape.domain, height)
}

/// The same on a grid with a sea level.
pub fn cells_on(domain: &Domain, height: &Field) -> Option<Vec<bool>> {
    let level = domain.sea_level? as f32;
    let has_data = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
    Some(reach(domain.size, |cell| height.values()[cell] <= level, has_data))
}

/// Lets the sea stand in the layers `water` and `sea_depth`, in metres over the layer `height`, where the landscape has a sea
/// level and ground. Where the sea stood before and no longer does, its water is gone; other water that stands deeper, or
/// where there is no sea, stays.
///
/// # Errors
/// None but for a layer of another size than the landscape, which is a bug.
pub fn stand(landscape: &mut Landscape) -> Result<(), Error> {
    let Ok(height) = landscape.field(GROUND) else { return Ok(()) };
    let (Some(sea), Some(level)) = (cells(landscape, height), landscape.domain.sea_level) else {
        return Ok(());
    };
    let depth = |cell: usize| (level - f64::from(height.values()[cell])) as f32;
    let depths =
        sea.iter().enumerate().map(|(cell, &is_sea)| if is_sea { depth(cell).max(0.0) } else { 0.0 });
    let sea = Field::from_values(height.size(), depths.collect());
    let (before, sea_before) = (landscape.field(WATER).ok(), landscape.field(SEA).ok());
    let water = sea.values().iter().enumerate().map(|(cell, &depth)| {
        let at = |field: Option<&Field>| field.map_or(0.0, |field| field.values()[cell]);
        let other = if at(before) <= at(sea_before) { 0.0 } else { at(before) };
        other.max(depth)
    });
    let water = Field::from_values(height.size(), water.collect());
    landscape.insert(WATER, "m", water);
    landscape.insert(SEA, "m", sea);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;

    #[test]
    fn the_sea_comes_in_from_the_border_and_leaves_hollows_and_deeper_water_alone() {
        // A coast in the west, a hollow below the sea inland, and a lake above it.
        let size = Size { columns: 9, rows: 5 };
        let ground = |x, y| {
            if x < 3 {
                -2.0
            } else if (x, y) == (6, 2) {
                -5.0
            } else {
                4.0
            }
        };
        let mut landscape = Landscape::new(Domain { sea_level: Some(1.0), ..Domain::new(size, 10.0) });
        landscape.insert("height", "m", Field::from_function(size, ground));
        let lake = |x, y| if (x, y) == (6, 2) || (x, y) == (1, 1) { 7.0 } else { 0.0 };
        landscape.insert("water", "m", Field::from_function(size, lake));
        stand(&mut landscape).expect("there is ground");
        let water = landscape.field("water").expect("stands");
        assert_eq!(
            [(0, 0), (2, 4), (3, 0), (6, 2), (1, 1)].map(|(x, y)| water.at(x, y)),
            [3.0, 3.0, 0.0, 7.0, 7.0]
        );
        landscape.insert("height", "m", Field::filled(size, 2.0));
        stand(&mut landscape).expect("there is ground");
        let water = landscape.field("water").expect("stands");
        assert_eq!(
            [(0, 0), (6, 2), (1, 1)].map(|(x, y)| water.at(x, y)),
            [0.0, 7.0, 7.0],
            "the sea has gone"
        );
        landscape.remove("water");
        landscape.insert("height", "m", Field::from_function(size, ground));
        stand(&mut landscape).expect("there is ground");
        assert_eq!(landscape.field("water").expect("stands").at(6, 2), 0.0, "the hollow is no sea");
        landscape.domain.sea_level = None;
        landscape.remove("water");
        stand(&mut landscape).expect("nothing to do");
        assert!(landscape.field("water").is_err(), "without a sea level there is no sea");
    }
}
