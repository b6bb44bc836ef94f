//! How many streams run along the axes and diagonals of the grid that the ground stands on.
//!
//! Streams are traced from cell to cell, and paths of a few cells favour eight directions whatever the ground does: on
//! waves of all directions in equal measure, which nothing carved, 48 to 53 % of them run within 10° of a multiple of 45°,
//! where 44.4 % of all directions do. So the ground is sampled on grids that are turned against its own by angles all
//! around, with cells half as long, streams are traced on each (D8-LTD, over filled hollows), and their directions are turned
//! back and counted in the frame of the ground: what tracing favours falls on all of its directions alike, and what is
//! left is the ground's own.

use crate::catmull_rom;
use crate::flow::{DirectionRule, Routed, Routing, accumulate, route};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};

/// Grids that are turned against that of the ground, in even steps of a quarter turn.
const GRIDS: usize = 8;

/// The first of them in degrees: none lies on the axes or the diagonals of the ground.
const FIRST_DEG: f64 = 1.7;

/// Cells of a turned grid along a cell of the ground: samples between cells see slopes that lie across them.
const FINER: usize = 2;

/// Cells of the ground that a stream drains, and the cells over which its direction counts.
const DRAINED: [f64; 2] = [30.0, 100.0];
const LENGTH: usize = 8;

/// Cells of the ground along the border of a turned grid in which no stream begins: what drains to them is not known.
const MARGIN: usize = 6;

/// Directions of streams in the frame of the ground.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreamAzimuths {
    /// Degrees from east over south, 0 to 360, of each stream on each of the grids.
    pub degrees: Vec<f64>,
}

impl StreamAzimuths {
    /// Of square ground within its largest inscribed circle: of streams that drain 30 to 100 cells, the direction over 8 cells.
    /// Cells under the domain's sea have none.
    ///
    /// # Errors
    /// [`Error::Run`] for ground that is not square or has cells without data, or on which no grid fits.
    pub fn of(domain: &Domain, height: &Field) -> Result<Self, Error> {
        let Size { columns, rows } = domain.size;
        // A square in the circle, in an even number of cells.
        let side = (columns as f64 * FINER as f64 / std::f64::consts::SQRT_2) as usize / 2 * 2;
        if columns != rows || domain.valid.is_some() || side <= 2 * FINER * (MARGIN + LENGTH) {
            let message = format!(
                "directions of streams are measured on square ground of 40 cells a side and more, all with data; this is \
                 {} cells",
                domain.size
            );
            return Err(Error::Run(message));
        }
        let routing = Routing {
            directions: DirectionRule::LeastDeviation,
            sea_level: domain.sea_level,
            ..Routing::default()
        };
        let mut degrees = Vec::new();
        for grid in 0..GRIDS {
            let turn = FIRST_DEG + 90.0 * grid as f64 / GRIDS as f64;
            let routed = route(&turned(height, Size::square(side)?, turn), None, &routing);
            degrees.extend(headings(&routed).map(|heading| (heading + turn).rem_euclid(360.0)));
        }
        Ok(Self { degrees })
    }

    /// Share of the streams that run within 10° of a multiple of 45°: 0.444 of those that know no direction.
    pub fn along_the_grid(&self) -> f64 {
        let is_near = |degrees: &&f64| {
            let beside = degrees.rem_euclid(45.0);
            beside <= 10.0 || beside >= 35.0
        };
        self.degrees.iter().filter(is_near).count() as f64 / self.degrees.len().max(1) as f64
    }
}

/// Ground on a grid turned by so many degrees about the middle, clockwise as rows go south.
fn turned(height: &Field, size: Size, degrees: f64) -> Field {
    let (sine, cosine) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
    let [middle_x, middle_y] = [height.size().columns, height.size().rows].map(|cells| 0.5 * cells as f64);
    Field::from_function(size, |x, y| {
        let [east, south] = [(x, size.columns), (y, size.rows)]
            .map(|(at, cells)| (at as f64 + 0.5 - 0.5 * cells as f64) / FINER as f64);
        let place_x = middle_x + cosine * east - sine * south - 0.5;
        let place_y = middle_y + sine * east + cosine * south - 0.5;
        sampled(height, place_x, place_y)
    })
}

/// Catmull and Rom's spline through the middles of cells, of which the first lies at 0.
fn sampled(height: &Field, x: f64, y: f64) -> f32 {
    let Size { columns, rows } = height.size();
    let [first_x, first_y] = [x, y].map(|place| libm::floor(place) as i64 - 1);
    let [across, down] = [x, y].map(|place| catmull_rom::weights(place - libm::floor(place)));
    let within = |at: i64, cells: usize| at.clamp(0, cells as i64 - 1) as usize;
    let row = |y: i64| {
        let cells = (first_x..).zip(across);
        cells
            .map(|(x, weight)| weight * f64::from(height.at(within(x, columns), within(y, rows))))
            .sum::<f64>()
    };
    (first_y..).zip(down).map(|(y, weight)| weight * row(y)).sum::<f64>() as f32
}

/// Directions of the streams on a grid, in degrees from its own east over its south.
fn headings(routed: &Routed) -> impl Iterator<Item = f64> {
    let directions = &routed.directions;
    let size = directions.size();
    let areas = accumulate(directions, None, None);
    let cells = (FINER * FINER) as f64;
    let is_inside = move |at: usize, count: usize| (FINER * MARGIN..count - FINER * MARGIN).contains(&at);
    let starts = (0..size.cells()).filter(move |&cell| {
        (cells * DRAINED[0]..=cells * DRAINED[1]).contains(&areas[cell])
            && is_inside(cell % size.columns, size.columns)
            && is_inside(cell / size.columns, size.rows)
    });
    starts.filter_map(move |start| {
        let end = (0..FINER * LENGTH).try_fold(start, |cell, _| directions.downstream(cell))?;
        let [begin, end] = [start, end].map(|cell| [cell % size.columns, cell / size.columns]);
        let [east, south] = [0, 1].map(|axis| end[axis] as f64 - begin[axis] as f64);
        Some(libm::atan2(south, east).to_degrees())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_and_a_grid_of_gutters_are_told_apart_in_the_frame_of_the_ground() {
        let size = Size::square(96).expect("small");
        let domain = Domain::new(size, 10.0);
        for degrees in [0.0, 20.0, 45.0, 70.0_f64] {
            let [east, south] = [libm::cos(degrees.to_radians()), libm::sin(degrees.to_radians())];
            // Gutters 12 cells apart down the plane.
            let gutters = |x: usize, y: usize| {
                let across = south * x as f64 - east * y as f64;
                let bottom = libm::cos(across * std::f64::consts::TAU / 12.0);
                (500.0 - 2.0 * (east * x as f64 + south * y as f64) - 6.0 * bottom) as f32
            };
            let azimuths = StreamAzimuths::of(&domain, &Field::from_function(size, gutters)).expect("square");
            assert!(azimuths.degrees.len() > 200, "{} streams", azimuths.degrees.len());
            let off = |found: f64| (found - degrees + 180.0).rem_euclid(360.0) - 180.0;
            let mean =
                azimuths.degrees.iter().map(|&found| off(found)).sum::<f64>() / azimuths.degrees.len() as f64;
            assert!(mean.abs() < 2.0, "{degrees}°: {mean}° off");
            let is_of_the_grid = degrees % 45.0 == 0.0;
            assert_eq!(azimuths.along_the_grid() > 0.5, is_of_the_grid, "{degrees}°");
        }
    }

    #[test]
    fn ground_that_is_not_square_is_refused() {
        let size = Size { columns: 96, rows: 64 };
        let flat = Field::filled(size, 0.0);
        let refused = StreamAzimuths::of(&Domain::new(size, 10.0), &flat).expect_err("oblong");
        assert!(refused.to_string().contains("96 × 64"), "{refused}");
    }
}
