//! Hack's exponent h: the longest river of a basin against its area, `L ~ A^h`.
//!
//! Source: Hack 1957, "Studies of longitudinal stream profiles in Virginia and Maryland", USGS Professional Paper
//! 294-B, doi 10.3133/pp294B; in nature about 0.57. Lengths follow D8 flow paths.

use super::drainage::Drainage;
use super::input::CHANNEL_AREA;
use super::power_law::exponent;

/// h over octaves of area from 100 cells upwards; `None` where fewer than three octaves have ten cells each.
pub(super) fn exponent_of_length(drainage: &Drainage) -> Option<f64> {
    let length = lengths(drainage);
    let sample = |&cell: &usize| [drainage.area[cell], length[cell]];
    exponent(drainage.order.iter().map(sample), CHANNEL_AREA)
}

/// Cells along the longest path down to each cell, itself included.
fn lengths(drainage: &Drainage) -> Vec<f64> {
    let mut length = vec![1.0; drainage.area.len()];
    for &cell in drainage.order.iter().rev() {
        if let Some(next) = drainage.next(cell) {
            length[next] = f64::max(length[next], length[cell] + drainage.step(cell, next));
        }
    }
    length
}

#[cfg(test)]
mod tests {
    use super::super::drainage::tests::dry;
    use super::*;

    #[test]
    fn rivers_side_by_side_are_as_long_as_their_areas() {
        let found = exponent_of_length(&dry(12, 900, |_, y| -y)).expect("four octaves");
        assert!((found - 1.0).abs() < 0.01, "{found}");
    }

    #[test]
    fn a_basin_that_widens_as_it_grows_longer_has_an_exponent_of_a_half() {
        // A triangle: row y drains y cells westward to a trunk in column 1, and the rest of the row eastward.
        let height = |x: f64, y: f64| match x {
            0.0 => 1000.0,
            _ if x <= y => x - 0.01 * y,
            _ => 2.0 * y - x - 0.01 * y,
        };
        let drainage = dry(200, 200, height);
        let length = lengths(&drainage);
        let trunk = |y: usize| y * 200 + 1;
        let samples = (20..199).map(|y| [drainage.area[trunk(y)], length[trunk(y)]]);
        assert!(drainage.area[trunk(198)] > 15_000.0, "the trunk gathers {}", drainage.area[trunk(198)]);
        let found = exponent(samples, CHANNEL_AREA).expect("seven octaves");
        assert!((found - 0.5).abs() < 0.02, "{found}");
    }
}
