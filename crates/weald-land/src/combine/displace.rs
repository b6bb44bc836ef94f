//! Bends a layer: every cell takes the value from a place that other layers say ("domain warping").
//!
//! ```text
//! v'(p) = v(p + (east(p), south(p)))        bilinear between cell centres, the edge beyond the edge
//! ```
//!
//! Cells without data give nothing: of the four cells around a place those with data share its weight, and where
//! none has any the cell keeps its own value. Common practice in terrain tools.

use rayon::prelude::*;

use super::{store, written};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Displace>(
    "displace",
    Stage::Combine,
    "bends a layer: each cell takes the value from a place that other layers say",
    "Weald",
);

parameters! {
    /// Displacement.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::displace::Displace;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| (x * x) as f32));
    /// landscape.insert("shift", "m", Field::filled(landscape.domain.size, 20.0)); // two cells
    /// Displace { east: Some(LayerName::of("shift")), ..Displace::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.values(), [4.0, 9.0, 16.0, 16.0, 16.0], "the edge goes on");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Displace {
        /// Layer that is read.
        layer: LayerName = LayerName::of("height");
        /// Layer with the way eastward to the place that a cell takes its value from, in metres. Without it, 0.
        east: Option<LayerName> = None;
        /// The same southward.
        south: Option<LayerName> = None;
        /// Factor on both.
        factor: f64 = 1.0, range -1.0e6..=1.0e6;
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

impl Step for Displace {
    fn reads(&self) -> Vec<String> {
        let offsets = self.east.iter().chain(&self.south);
        std::iter::once(&self.layer).chain(offsets).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn faults(&self) -> Vec<Fault> {
        let nowhere = self.east.is_none() && self.south.is_none();
        nowhere
            .then(|| Fault::of("east", "give `east`, `south` or both, or nothing is displaced"))
            .into_iter()
            .collect()
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let offset =
            |name: &Option<LayerName>| name.as_ref().map(|name| landscape.field(&name.0)).transpose();
        let bent = Bent {
            field: landscape.field(&self.layer.0)?,
            valid: landscape.domain.valid.as_ref(),
            offsets: [offset(&self.east)?, offset(&self.south)?],
            cells_per_metre: self.factor / landscape.domain.cell,
        };
        let size = bent.field.size();
        let cells = (0..size.cells()).into_par_iter().with_min_len(super::CELLS_PER_TASK);
        let values = cells.map(|at| bent.value(at % size.columns, at / size.columns)).collect();
        store(landscape, &self.layer, self.into.as_ref(), Field::from_values(size, values))?;
        Ok(Outcome::default())
    }
}

/// A field seen through a displacement.
struct Bent<'a> {
    field: &'a Field,
    valid: Option<&'a Mask>,
    offsets: [Option<&'a Field>; 2],
    cells_per_metre: f64,
}

impl Bent<'_> {
    fn value(&self, x: usize, y: usize) -> f32 {
        let offset = |offset: Option<&Field>| {
            offset.map_or(0.0, |offset| f64::from(offset.at(x, y)) * self.cells_per_metre)
        };
        let size = self.field.size();
        let ([west, east], to_east) = between(x as f64 + offset(self.offsets[0]), size.columns);
        let ([north, south], to_south) = between(y as f64 + offset(self.offsets[1]), size.rows);
        let corners = [
            (west, north, (1.0 - to_east) * (1.0 - to_south)),
            (east, north, to_east * (1.0 - to_south)),
            (west, south, (1.0 - to_east) * to_south),
            (east, south, to_east * to_south),
        ];
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, y, weight) in corners {
            if self.valid.is_none_or(|valid| valid.is_valid(x, y)) {
                sum += weight * f64::from(self.field.at(x, y));
                weights += weight;
            }
        }
        if weights > 0.0 { (sum / weights) as f32 } else { self.field.at(x, y) }
    }
}

/// The cells on both sides of a place along one side of the grid, and how far it lies from the first to the second.
fn between(place: f64, side: usize) -> ([usize; 2], f64) {
    let place = if place.is_finite() { place.clamp(0.0, (side - 1) as f64) } else { 0.0 };
    let first = (place as usize).min(side - 1);
    ([first, (first + 1).min(side - 1)], place - first as f64)
}
