//! The two dimensions, and coordinates along one: centres of cells at even distances.

use super::super::Fault;
use weald_core::grid::Size;

/// A dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// From north to south.
    Y,
    /// From west to east.
    X,
}

impl Axis {
    /// Name of the dimension and of its coordinate.
    pub fn name(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::X => "x",
        }
    }

    /// Cells along it.
    pub fn length(self, size: Size) -> usize {
        match self {
            Self::Y => size.rows,
            Self::X => size.columns,
        }
    }
}

/// Coordinates may be off by this share of a cell: what `float32` makes of degrees.
const TOLERANCE: f64 = 0.05;

/// Centres of the cells along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Centres {
    /// The first coordinate.
    pub(super) first: f64,
    /// The last coordinate.
    pub(super) last: f64,
    /// How many there are.
    pub(super) count: usize,
}

impl Centres {
    /// # Errors
    /// [`Fault::Damaged`] naming the first coordinate that is not where an even distance would put it.
    pub(super) fn of(name: &str, coordinates: &[f64]) -> Result<Self, Fault> {
        let (first, last) = (coordinates[0], coordinates[coordinates.len() - 1]);
        let centres = Self { first, last, count: coordinates.len() };
        let step = centres.step().unwrap_or(1.0);
        let is_off = |index: usize, coordinate: f64| {
            let off = (coordinate - (first + index as f64 * step)).abs();
            off.is_nan() || off > TOLERANCE * step.abs() || step == 0.0
        };
        let off = coordinates.iter().enumerate().find(|(index, coordinate)| is_off(*index, **coordinate));
        match off {
            None => Ok(centres),
            Some((index, coordinate)) => Err(Fault::damaged(format!(
                "coordinate {index} of `{name}` is {coordinate}, not {} as even cells would have it; bring the \
                 file to an even grid, with xarray: ds.interp({name}=…)",
                first + index as f64 * step
            ))),
        }
    }

    /// Distance from one to the next, below 0 where they fall; `None` for one alone.
    pub(super) fn step(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.last - self.first) / (self.count - 1) as f64)
    }

    /// Whether cells that begin at `edge` with a side of `step` have these centres.
    pub(super) fn agree_with(&self, edge: f64, step: f64) -> bool {
        let near = |centre: f64, index: usize| {
            (centre - (edge + (index as f64 + 0.5) * step)).abs() <= TOLERANCE * step.abs()
        };
        near(self.first, 0) && near(self.last, self.count - 1)
    }

    /// From the other end.
    pub(super) fn reversed(self) -> Self {
        Self { first: self.last, last: self.first, ..self }
    }

    /// In units of another size.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { first: self.first * factor, last: self.last * factor, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_coordinates_have_a_first_a_step_and_a_count() {
        let centres = Centres::of("y", &[9.0, 7.0, 5.0]).expect("even");
        assert_eq!(centres.step(), Some(-2.0));
        assert!(centres.agree_with(10.0, -2.0) && !centres.agree_with(8.0, -2.0));
        assert!(!centres.agree_with(10.0, -2.2));
        assert_eq!(Centres::of("y", &[3.0]).expect("one").step(), None);
    }

    #[test]
    fn coordinates_that_are_not_even_are_refused() {
        for coordinates in [[0.0, 1.0, 3.0], [0.0, f64::NAN, 2.0], [1.0, 1.0, 1.0], [0.0, 1.0, f64::INFINITY]]
        {
            assert!(Centres::of("x", &coordinates).is_err(), "{coordinates:?}");
        }
        assert!(Centres::of("x", &[f64::NAN]).is_err());
    }

    #[test]
    fn degrees_in_32_bits_are_even_enough() {
        let coordinates: Vec<f64> =
            (0..1000).map(|index| f64::from((-84.414_17 + f64::from(index) / 1200.0) as f32)).collect();
        assert!(Centres::of("x", &coordinates).is_ok());
    }
}
