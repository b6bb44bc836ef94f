//! Brings a layer from one range to another, along a line, a power or a curve.
//!
//! ```text
//! t = (v - from_low) / (from_high - from_low)        v' = to_low + (to_high - to_low) c(t^gamma)
//! ```
//!
//! where `c` is the curve through the given heights at even steps from 0 to 1.

use super::{map, store, target, written};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Remap>("remap", Stage::Combine, "brings a layer from one range to another", "Weald");

parameters! {
    /// Change of range.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::remap::Remap;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| 100.0 * x as f32));
    /// let remap = Remap { from: vec![0.0, 200.0], into: Some(LayerName::of("mask")), ..Remap::default() };
    /// remap.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("mask")?.values(), [0.0, 0.5, 1.0, 1.0, 1.0]);
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Remap {
        /// Layer that is read.
        layer: LayerName = LayerName::of("height");
        /// `[low, high]` of the values before. Empty: the layer's own range over cells with data.
        from: Vec<f64> = Vec::new(), range -1.0e9..=1.0e9;
        /// `[low, high]` of the values after; high first turns them over.
        to: Vec<f64> = vec![0.0, 1.0], range -1.0e9..=1.0e9;
        /// Whether values outside `from` become the ends of `to`; otherwise the line goes on beyond them.
        clamp: bool = true, with from;
        /// Exponent of the way from low to high: above 1 lowers the middle, below 1 lifts it.
        gamma: f64 = 1.0, range 0.01..=100.0;
        /// Heights of a curve at even steps from 0 to 1, joined by lines: `[0, 0, 1]` cuts off the lower
        /// half.
        curve: Vec<f64> = Vec::new(), range 0.0..=1.0;
        /// Unit of the result, for files and the report: `"1"` for a mask. Without it, the unit of `layer`.
        unit: Option<String> = None;
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

/// Longest unit, in characters.
const MAX_UNIT_LENGTH: usize = 32;

impl Step for Remap {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn faults(&self) -> Vec<Fault> {
        let range_is_right = match self.from[..] {
            [] => true,
            [low, high] => low < high,
            _ => false,
        };
        let unit_is_right = self.unit.as_ref().is_none_or(|unit| {
            (1..=MAX_UNIT_LENGTH).contains(&unit.chars().count()) && !unit.chars().any(char::is_control)
        });
        let shaped = self.gamma != 1.0 || !self.curve.is_empty();
        let rules = [
            (
                "from",
                !range_is_right,
                format!(
                    "`from` is {:?}, but must be [low, high] with low below high, or be left out",
                    self.from
                ),
            ),
            (
                "to",
                self.to.len() != 2,
                format!("`to` is {:?}, but must be two numbers, [low, high]", self.to),
            ),
            ("unit", !unit_is_right, format!("`unit` must be 1 to {MAX_UNIT_LENGTH} printable characters")),
            (
                "curve",
                self.curve.len() == 1,
                "`curve` has one height, but a curve has two or more".to_owned(),
            ),
            (
                "clamp",
                shaped && !self.clamp,
                "`gamma` and `curve` have no meaning outside `from`: set `clamp = true`".to_owned(),
            ),
        ];
        let broken = rules.into_iter().filter(|(_, broken, _)| *broken);
        broken.map(|(key, _, sentence)| Fault::of(key, sentence)).collect()
    }

    fn reach(&self) -> Option<Reach> {
        // Without it the range is that of the whole.
        (self.from.len() == 2).then(Reach::default)
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let field = landscape.field(&self.layer.0)?;
        let range = self.range_before(field.range(landscape.domain.valid.as_ref()));
        let remapped = map(field, |value| self.value(f64::from(value), range) as f32);
        match &self.unit {
            Some(unit) => landscape.insert(target(self.into.as_ref(), &self.layer), unit, remapped),
            None => store(landscape, &self.layer, self.into.as_ref(), remapped)?,
        }
        Ok(Outcome::default())
    }
}

impl Remap {
    fn range_before(&self, own: Option<(f32, f32)>) -> [f64; 2] {
        match self.from[..] {
            [low, high] => [low, high],
            _ => own.map_or([0.0, 1.0], |(low, high)| [f64::from(low), f64::from(high)]),
        }
    }

    fn value(&self, value: f64, [low, high]: [f64; 2]) -> f64 {
        // A layer that is the same everywhere has no range of its own: it goes to the low end.
        let fraction = if high > low { (value - low) / (high - low) } else { 0.0 };
        let fraction = if self.clamp { self.shaped(fraction.clamp(0.0, 1.0)) } else { fraction };
        self.to[0] * (1.0 - fraction) + self.to[1] * fraction
    }

    fn shaped(&self, fraction: f64) -> f64 {
        let fraction = if self.gamma == 1.0 { fraction } else { libm::pow(fraction, self.gamma) };
        if self.curve.is_empty() {
            return fraction;
        }
        let place = fraction * (self.curve.len() - 1) as f64;
        let before = (place as usize).min(self.curve.len() - 2);
        let beyond = place - before as f64;
        self.curve[before] * (1.0 - beyond) + self.curve[before + 1] * beyond
    }
}
