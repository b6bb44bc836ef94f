//! A raster on another grid of the same country, such as results of metres back on the degrees that came in.
//!
//! Both grids lie in one CRS and along its axes, so each direction is worked out by itself.

use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

use super::Raster;

weald_core::choices! {
    /// How a cell gets its value from those of another grid.
    pub enum Resampling {
        /// Between the four around its centre, those without data left out.
        Linear = "linear",
        /// That of the cell in which its centre lies.
        Nearest = "nearest",
        /// The greatest of the cells whose centres lie in it, else that of the nearest: no river is lost.
        Greatest = "greatest",
    }
}

/// Where a grid lies, and which of its cells have data.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Columns and rows.
    pub size: Size,
    /// CRS, origin and cells.
    pub georeference: Georeference,
    /// Cells with data; `None` where all have.
    pub valid: Option<Mask>,
}

/// The raster on another grid. A cell has data where it has there and the cell of the raster around its centre has.
///
/// # Errors
/// [`Error::Run`] for a raster without a place, in another CRS, or that reaches over none of the grid.
pub fn regrid(raster: &Raster, grid: &Grid, how: Resampling) -> Result<Raster, Error> {
    let Some(place) = &raster.georeference else {
        return Err(Error::Run(
            "the landscape has no georeferencing, so nothing goes back to a grid".to_owned(),
        ));
    };
    if place.epsg != grid.georeference.epsg {
        return Err(Error::Run(
            "the landscape is in another CRS than the grid to which it should go back".to_owned(),
        ));
    }
    let old = raster.field.size();
    let across = Axis::of(0, (place, old.columns), (&grid.georeference, grid.size.columns));
    let down = Axis::of(1, (place, old.rows), (&grid.georeference, grid.size.rows));
    let index_of = |x: usize, y: usize| Some(old.index(across.nearest[x]?, down.nearest[y]?));
    let size = grid.size;
    let has_data = |x: usize, y: usize| {
        grid.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y))
            && index_of(x, y).is_some_and(|index| raster.is_valid_at(index))
    };
    let field = Field::from_function(size, |x, y| match index_of(x, y).filter(|_| has_data(x, y)) {
        None => 0.0,
        Some(index) => match how {
            Resampling::Nearest => raster.field.values()[index],
            Resampling::Linear => linear(raster, &across.between[x], &down.between[y]),
            Resampling::Greatest => greatest(raster, across.within[x], down.within[y], index),
        },
    });
    let flags: Vec<bool> =
        (0..size.cells()).map(|at| has_data(at % size.columns, at / size.columns)).collect();
    if !flags.contains(&true) {
        return Err(Error::Run(
            "no cell of the grid to which results should go back lies in the landscape".to_owned(),
        ));
    }
    let valid = Mask::new(size, flags);
    let georeference = Some(grid.georeference.clone());
    Ok(Raster { field, valid, georeference, cell: None, ..raster.clone() })
}

/// Where the cells of the new grid lie among those of the old one, along one direction.
struct Axis {
    /// The cell around the centre; `None` beyond the old grid.
    nearest: Vec<Option<usize>>,
    /// The two cells whose centres are around the centre, with their weights.
    between: Vec<[(usize, f64); 2]>,
    /// First cell whose centre lies in the new one, and the first that does no more.
    within: Vec<[usize; 2]>,
}

impl Axis {
    fn of(
        axis: usize,
        (old, old_count): (&Georeference, usize),
        (new, new_count): (&Georeference, usize),
    ) -> Self {
        let sign = if axis == 0 { 1.0 } else { -1.0 };
        // Distance from the edge of the old grid, in its cells, of a place that is so many new cells from the new edge.
        let place = |cells: f64| {
            let start = (new.origin[axis] - old.origin[axis]) * sign / old.pixel[axis];
            start + cells * (new.pixel[axis] / old.pixel[axis])
        };
        let last = old_count - 1;
        let centres: Vec<f64> = (0..new_count).map(|at| place(at as f64 + 0.5)).collect();
        let nearest = |&centre: &f64| (centre >= 0.0 && centre < old_count as f64).then_some(centre as usize);
        let between = |&centre: &f64| {
            let from_centre = (centre - 0.5).clamp(0.0, last as f64);
            let (cell, share) = (from_centre.floor() as usize, from_centre - from_centre.floor());
            [(cell, 1.0 - share), ((cell + 1).min(last), share)]
        };
        // The first old centre at or beyond a new edge; a billionth less, so that edges that are the same by reckoning are.
        let first = |at: usize| ((place(at as f64) - 0.5 - 1e-9).ceil().max(0.0) as usize).min(old_count);
        Self {
            nearest: centres.iter().map(nearest).collect(),
            between: centres.iter().map(between).collect(),
            within: (0..new_count).map(|at| [first(at), first(at + 1)]).collect(),
        }
    }
}

/// The mean of four cells, the weights of those with data grown to make up for the others.
fn linear(raster: &Raster, across: &[(usize, f64); 2], down: &[(usize, f64); 2]) -> f32 {
    let (mut sum, mut whole) = (0.0, 0.0);
    for (y, weight_y) in down {
        for (x, weight_x) in across {
            let index = raster.field.size().index(*x, *y);
            if raster.is_valid_at(index) {
                sum += weight_x * weight_y * f64::from(raster.field.values()[index]);
                whole += weight_x * weight_y;
            }
        }
    }
    (sum / whole) as f32
}

fn greatest(raster: &Raster, across: [usize; 2], down: [usize; 2], nearest: usize) -> f32 {
    let size = raster.field.size();
    let cells = (down[0]..down[1]).flat_map(|y| (across[0]..across[1]).map(move |x| size.index(x, y)));
    let held = cells.filter(|&index| raster.is_valid_at(index)).map(|index| raster.field.values()[index]);
    held.reduce(f32::max).unwrap_or(raster.field.values()[nearest])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(pixel: [f64; 2]) -> Georeference {
        Georeference { epsg: Some(4326), origin: [10.0, 47.0], pixel, keys: None }
    }

    /// Three rows of degrees over four of metres, as a raster at 40° comes out.
    fn back(values: &[f32], valid: Option<Vec<bool>>, how: Resampling) -> Vec<f32> {
        let size = Size { columns: 2, rows: 4 };
        let valid = valid.and_then(|valid| Mask::new(size, valid));
        let field = Field::from_values(size, values.to_vec());
        let raster = Raster { valid, georeference: Some(place([1.0, 0.75])), ..Raster::from(field) };
        let grid = Grid { size: Size { columns: 2, rows: 3 }, georeference: place([1.0, 1.0]), valid: None };
        let back = regrid(&raster, &grid, how).expect("the same country");
        assert_eq!(back.georeference, Some(place([1.0, 1.0])));
        back.field.values().to_vec()
    }

    #[test]
    fn a_plane_stays_a_plane_and_a_river_stays_whole() {
        // Rows of the old grid have their centres at 0.375, 1.125, 1.875 and 2.625, those of the new at 0.5, 1.5, 2.5.
        let plane = [0.375, 0.375, 1.125, 1.125, 1.875, 1.875, 2.625, 2.625];
        assert_eq!(back(&plane, None, Resampling::Linear), [0.5, 0.5, 1.5, 1.5, 2.5, 2.5]);
        assert_eq!(back(&plane, None, Resampling::Nearest), [0.375, 0.375, 1.875, 1.875, 2.625, 2.625]);
        // Row 1 holds no centre of a new row, so that it is lost by the nearest.
        let river = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(back(&river, None, Resampling::Nearest), [0.0; 6]);
        assert_eq!(back(&river, None, Resampling::Greatest), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn what_has_no_data_gives_none_and_adds_nothing() {
        let valid = vec![true, true, true, true, true, true, false, true];
        let values = [4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 0.0, 4.0];
        assert_eq!(back(&values, Some(valid), Resampling::Linear), [4.0, 4.0, 4.0, 4.0, 0.0, 4.0]);
    }

    #[test]
    fn another_crs_and_another_country_are_refused() {
        let raster = |georeference| Raster {
            georeference,
            ..Raster::from(Field::filled(Size { columns: 2, rows: 2 }, 1.0))
        };
        let grid = Grid { size: Size { columns: 2, rows: 2 }, georeference: place([1.0, 1.0]), valid: None };
        let mut elsewhere = place([1.0, 1.0]);
        elsewhere.origin = [20.0, 47.0];
        let other = Georeference { epsg: Some(4258), ..place([1.0, 1.0]) };
        for wrong in [None, Some(elsewhere), Some(other)] {
            assert!(regrid(&raster(wrong), &grid, Resampling::Nearest).is_err());
        }
    }
}
