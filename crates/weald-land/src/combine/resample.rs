//! Brings the whole landscape to another number of cells over the same ground.
//!
//! Finer: Catmull-Rom interpolation (Catmull and Rom 1974; Keys 1981 with a = -1/2, doi
//! 10.1109/TASSP.1981.1163711) through the centres of sixteen cells, kept between the lowest and the highest
//! of them. Next to no-data or the edge of the grid, where sixteen cells with data do not exist, the mean of
//! the nearest four with data by their bilinear weights. Coarser: the mean over the part of each old cell
//! that lies in the new one, again of cells with data. So no value leaves the range of the cells around it:
//! depths stay positive, masks within 0 to 1.
//!
//! A fine cell has data where the old cell under its centre has; a coarse one where half of its area has.

use rayon::prelude::*;

use crate::catmull_rom;
use weald_core::domain::{Domain, Georeference};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::Sides;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Resample>(
    "resample",
    Stage::Combine,
    "brings all layers to another number of cells over the same ground",
    "Catmull and Rom 1974; Keys 1981",
);

parameters! {
    /// Change of resolution.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_core::parameter::Sides;
    /// # use weald_land::combine::resample::Resample;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| x as f32));
    /// Resample { size: Sides { columns: 4, rows: 3 } }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.domain.cell, 20.0, "half as many cells a side over the same ground");
    /// assert_eq!(landscape.field("height")?.row(0), [0.5, 2.5, 4.5, 6.5], "each the mean of four");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Resample {
        /// Cells a side, or `[columns, rows]`, in the proportion of the landscape.
        size: Sides = Sides::NEEDED;
    }
}

impl Step for Resample {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        Vec::new()
    }

    fn resized(&self) -> Option<(u32, u32)> {
        let side = |cells: u64| u32::try_from(cells).unwrap_or(u32::MAX);
        Some((side(self.size.columns), side(self.size.rows)))
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        Change::between(domain, self.cells()?).map(drop)
    }

    fn domain_after(&self, domain: &Domain) -> Option<Domain> {
        let change = Change::between(domain, self.cells().ok()?).ok()?;
        Some(change.domain(change.valid()))
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let change = Change::between(&landscape.domain, self.cells()?)?;
        let valid = change.valid();
        let mut resampled = Landscape::new(change.domain(valid));
        resampled.materials.clone_from(&landscape.materials);
        for (name, layer) in landscape.layers() {
            resampled.insert(name, &layer.unit, change.field(&layer.field));
        }
        for (name, plants) in landscape.all_plants() {
            resampled.plant(name, plants.clone());
        }
        resampled.attach_all_of(landscape);
        *landscape = resampled;
        Ok(Outcome::default())
    }
}

impl Resample {
    fn cells(&self) -> Result<Size, Error> {
        Size::new(self.size.columns as usize, self.size.rows as usize)
    }
}

/// A field on `old` brought to another number of cells over the same ground, and where it has data.
///
/// # Errors
/// [`Error::Run`] where the cells would not be square.
pub fn resampled(old: &Domain, field: &Field, size: Size) -> Result<(Field, Option<Mask>), Error> {
    let change = Change::between(old, size)?;
    Ok((change.field(field), change.valid()))
}

/// From one grid to another over the same ground.
struct Change<'a> {
    old: &'a Domain,
    size: Size,
    /// Old cells a new cell spans.
    factor: f64,
}

impl<'a> Change<'a> {
    fn between(old: &'a Domain, size: Size) -> Result<Self, Error> {
        let factor = old.size.columns as f64 / size.columns as f64;
        let rows = old.size.rows as f64 / factor;
        if (rows - size.rows as f64).abs() >= 1.0 {
            return Err(Error::Run(format!(
                "{} cells brought to {size} would not be square; for {} columns give {} rows",
                old.size,
                size.columns,
                rows.round().max(1.0)
            )));
        }
        Ok(Self { old, size, factor })
    }

    fn domain(&self, valid: Option<Mask>) -> Domain {
        let georeference = self
            .old
            .georeference
            .clone()
            .map(|old| Georeference { pixel: old.pixel.map(|side| side * self.factor), ..old });
        let cell = self.old.cell * self.factor;
        Domain {
            size: self.size,
            cell,
            georeference,
            valid,
            finest: self.old.finest,
            sea_level: self.old.sea_level,
        }
    }

    fn valid(&self) -> Option<Mask> {
        let old = self.old.valid.as_ref()?;
        let flag = |x, y| {
            if self.factor <= 1.0 {
                return old.is_valid(self.under(x, old.size().columns), self.under(y, old.size().rows));
            }
            let area = |kept| self.parts(x, y).filter(move |part| old.is_valid(part.x, part.y) == kept);
            area(true).map(|part| part.area).sum::<f64>() >= area(false).map(|part| part.area).sum()
        };
        let cells = (0..self.size.rows).flat_map(|y| (0..self.size.columns).map(move |x| (x, y)));
        Mask::new(self.size, cells.map(|(x, y)| flag(x, y)).collect())
    }

    fn field(&self, old: &Field) -> Field {
        let mut new = Field::filled(self.size, 0.0);
        new.values_mut().par_chunks_mut(self.size.columns).enumerate().for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                *value =
                    if self.factor > 1.0 { self.mean(old, x, y) } else { self.between_centres(old, x, y) };
            }
        });
        new
    }

    fn has_data(&self, x: usize, y: usize) -> bool {
        self.old.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y))
    }

    /// The old cell under the centre of a new one, along an axis of `count` old cells.
    fn under(&self, new: usize, count: usize) -> usize {
        (((new as f64 + 0.5) * self.factor) as usize).min(count - 1)
    }

    /// Old cells that a new one touches along an axis, each with the length that they share.
    fn touched(&self, new: usize, count: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let ends = [new, new + 1].map(|edge| (edge as f64 * self.factor).min(count as f64));
        let first = (ends[0] as usize).min(count - 1);
        let last = (libm::ceil(ends[1]) as usize).clamp(first + 1, count);
        (first..last).map(move |old| (old, ends[1].min(old as f64 + 1.0) - ends[0].max(old as f64)))
    }

    /// Old cells that a new one touches.
    fn parts(&self, x: usize, y: usize) -> impl Iterator<Item = Part> {
        let rows = self.touched(y, self.old.size.rows);
        rows.flat_map(move |(old_y, height)| {
            let columns = self.touched(x, self.old.size.columns);
            columns.map(move |(old_x, width)| Part { x: old_x, y: old_y, area: width * height })
        })
    }

    fn mean(&self, field: &Field, x: usize, y: usize) -> f32 {
        let (mut area, mut sum) = (0.0, 0.0);
        for part in self.parts(x, y).filter(|part| self.has_data(part.x, part.y)) {
            area += part.area;
            sum += part.area * f64::from(field.at(part.x, part.y));
        }
        if area > 0.0 { (sum / area) as f32 } else { 0.0 }
    }

    fn between_centres(&self, field: &Field, x: usize, y: usize) -> f32 {
        let place = |new: usize| (new as f64 + 0.5) * self.factor - 0.5;
        let [place_x, place_y] = [place(x), place(y)];
        let [before_x, before_y] = [place_x, place_y].map(|place| libm::floor(place) as i64);
        let fraction = [place_x - before_x as f64, place_y - before_y as f64];
        self.cubic(field, [before_x, before_y], fraction)
            .unwrap_or_else(|| self.linear(field, [before_x, before_y], fraction))
    }

    /// The old cell, where it exists and has data.
    fn value(&self, field: &Field, x: i64, y: i64) -> Option<f64> {
        let size = field.size();
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < size.columns && y < size.rows && self.has_data(x, y)).then(|| f64::from(field.at(x, y)))
    }

    fn cubic(&self, field: &Field, [x, y]: [i64; 2], [way_x, way_y]: [f64; 2]) -> Option<f32> {
        let (mut sum, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for (row, weight_y) in (y - 1..).zip(catmull_rom::weights(way_y)) {
            for (column, weight_x) in (x - 1..).zip(catmull_rom::weights(way_x)) {
                let value = self.value(field, column, row)?;
                sum += weight_x * weight_y * value;
                (low, high) = (low.min(value), high.max(value));
            }
        }
        Some(sum.clamp(low, high) as f32)
    }

    fn linear(&self, field: &Field, [x, y]: [i64; 2], [way_x, way_y]: [f64; 2]) -> f32 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (row, weight_y) in [(y, 1.0 - way_y), (y + 1, way_y)] {
            for (column, weight_x) in [(x, 1.0 - way_x), (x + 1, way_x)] {
                if let Some(value) = self.value(field, column, row) {
                    sum += weight_x * weight_y * value;
                    weights += weight_x * weight_y;
                }
            }
        }
        if weights > 0.0 { (sum / weights) as f32 } else { 0.0 }
    }
}

/// The part of an old cell that lies in a new one, its area in old cells.
struct Part {
    x: usize,
    y: usize,
    area: f64,
}
