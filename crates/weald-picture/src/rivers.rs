//! River lines on a sheet, from mean fluxes: their courses, as wide as the root of what they carry.
//!
//! Downstream a river widens with the square root of its discharge (Leopold and Maddock 1953, doi 10.3133/pp252). True
//! widths are hairs on most maps, so a river that drains the whole sheet gets [`WIDEST`] lines and others their share of
//! that, but no less than a hair of one pixel.

use super::courses::{Reach, courses, least_area};
use super::drainage::Drainage;
use super::sheet::Sheet;
use super::strokes::{Point, Strokes};
use weald_core::domain::Domain;
use weald_core::grid::Field;

/// Width in lines of a river that drains as much as the whole sheet.
const WIDEST: f32 = 7.0;

/// Pixels of the finest river at its head, and below it.
const HAIR: [f32; 2] = [0.5, 1.0];

/// Draws the rivers of a landscape; `None` where nothing flows.
pub(super) fn draw(
    flux: [&Field; 2],
    domain: &Domain,
    sheet: &Sheet,
    least_area: Option<f64>,
) -> Option<Strokes> {
    let [across, down] = [sheet.across() as f32, sheet.down() as f32];
    let cells = domain.size.cells() as f32;
    let least = least_area.map(|area| (area / domain.cell_area()) as f32);
    let canvas = Canvas { pixels: [sheet.width, sheet.height], least_area: least };
    strokes(flux, domain, canvas, |reach| {
        let width = (sheet.line() * WIDEST * (reach.area / cells).min(1.0).sqrt()).max(HAIR[1]);
        let width = HAIR[0] + (width - HAIR[0]) * reach.share;
        Point { x: reach.place[0] * across, y: reach.place[1] * down, width, opacity: 1.0 }
    })
}

/// Columns and rows of pixels, and the least area of a river in cells; `None` for one that suits the grid.
#[derive(Clone, Copy)]
pub(super) struct Canvas {
    pub(super) pixels: [usize; 2],
    pub(super) least_area: Option<f32>,
}

/// Draws the rivers on a canvas, each point as `point` says; `None` where nothing flows.
pub(super) fn strokes(
    flux: [&Field; 2],
    domain: &Domain,
    canvas: Canvas,
    point: impl Fn(Reach) -> Point,
) -> Option<Strokes> {
    let drainage = Drainage::of(flux, domain);
    drainage.flow.strength.iter().any(|&strength| strength > 0.0).then(|| {
        let mut strokes = Strokes::new(canvas.pixels[0], canvas.pixels[1]);
        let least = canvas.least_area.unwrap_or(least_area(domain.size));
        for course in courses(&drainage, least) {
            strokes.draw(&course.into_iter().map(&point).collect::<Vec<_>>());
        }
        strokes
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    /// Water that gathers from both banks in column 32 and leaves to the south.
    fn valley() -> [Field; 2] {
        let size = Size::square(64).expect("legal");
        let east = Field::from_function(size, |x, _| if x < 32 { x as f32 } else { x as f32 - 63.0 });
        let south = Field::from_function(size, |x, y| if x == 32 { 63.0 * (y as f32 + 1.0) } else { 0.0 });
        [east, south]
    }

    #[test]
    fn a_river_widens_with_the_root_of_its_discharge_down_to_the_border() {
        let [east, south] = valley();
        let domain = Domain::new(east.size(), 1.0);
        let sheet = Sheet::new(&domain, Some(1024)).expect("legal");
        let strokes = draw([&east, &south], &domain, &sheet, None).expect("water flows");
        let width = |y: usize| strokes.row(y).iter().sum::<f32>();
        let widths = [240, 400, 600, 800, 1023].map(width);
        assert!(widths.windows(2).all(|pair| pair[0] < pair[1]), "{widths:?}");
        let doubled = width(960) / width(480);
        assert!((doubled - 1.414).abs() < 0.05, "{doubled} times as wide with twice the water");
    }

    #[test]
    fn still_water_has_no_rivers() {
        let size = Size::square(16).expect("legal");
        let still = Field::filled(size, 0.0);
        let domain = Domain::new(size, 1.0);
        let sheet = Sheet::new(&domain, None).expect("legal");
        assert!(draw([&still, &still], &domain, &sheet, None).is_none());
    }
}
