//! Moisture of the soil, from 0 to 1: wet where the ground is little above the water that it drains to, or much
//! land drains through it.
//!
//! ```text
//! moisture = 1 - (1 - near) (1 - gathered)        near = 2^(-h / half_height)
//! gathered = (wetness - dry) / (wet - dry), within 0 and 1
//! ```
//!
//! `h` is the height above the nearest drainage: above the first water on the flow path (Rennó et al. 2008,
//! "HAND, a new terrain descriptor using SRTM-DEM", doi 10.1016/j.rse.2008.03.018), or above the outlet where
//! there is none. Water is what a simulation left, rivers and lakes, and the sea, as far as they are named.
//! How the two are joined is a choice of Weald: either alone makes ground wet.

use rayon::prelude::*;

use super::{CELLS_PER_TASK, ensure_finite};
use crate::flow::directions::Directions;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Moisture>(
    "moisture",
    Stage::Analyse,
    "moisture of the soil from nearby water and gathered flow",
    "Rennó et al. 2008; Beven and Kirkby 1979",
);

parameters! {
    /// Moisture of the soil, from layers that `flow` and `wetness` write.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::{flow_step::FlowStep, moisture::Moisture, wetness::Wetness};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 20)?, 10.0)); // columns, rows, metres
    /// let valley = |x, y| 5.0 * (x as f32 - 4.0).abs() - 0.1 * y as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// FlowStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// Wetness::default().run(&mut landscape, &Job::unwatched(0))?;
    /// Moisture::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let (floor, ridge) = (landscape.field("moisture")?.at(4, 10), landscape.field("moisture")?.at(0, 10));
    /// assert!(floor > 0.7 && ridge < 0.3, "{floor} on the floor of the valley, {ridge} on its ridge");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Moisture {
        /// Layer of the height of the ground.
        of: LayerName = LayerName::of("height");
        /// Layer of the topographic wetness index.
        wetness: LayerName = LayerName::of("wetness");
        /// Layer of the depth of water that a simulation left.
        water: Option<LayerName> = None;
        /// Shallower water of a simulation counts as overland flow and wets nothing.
        shallowest: f64 = 0.05, range 0.0..=1000.0, unit "m", with water;
        /// Layer of rivers.
        rivers: Option<LayerName> = None;
        /// Layer of lakes.
        lakes: Option<LayerName> = None;
        /// Height above water at which nearness has fallen to a half.
        half_height: f64 = 5.0, range 1.0e-3..=1.0e5, unit "m";
        /// Wetness index of ground that gathers nothing.
        dry: f64 = 6.0, range -50.0..=50.0;
        /// Wetness index of ground that is soaked by what gathers.
        wet: f64 = 14.0, range -50.0..=50.0;
    }
}

impl Step for Moisture {
    fn reads(&self) -> Vec<String> {
        let needed = [self.of.0.as_str(), self.wetness.0.as_str(), "flow_direction"].map(str::to_owned);
        let named = [&self.water, &self.rivers, &self.lakes].into_iter().flatten().map(|name| name.0.clone());
        needed.into_iter().chain(named).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![("moisture".to_owned(), "1"), ("height_above_water".to_owned(), "m")]
    }

    fn faults(&self) -> Vec<Fault> {
        let fault = format!("`wet` is {}, but must be above `dry`, which is {}", self.wet, self.dry);
        (self.wet <= self.dry).then_some(Fault::of("wet", fault)).into_iter().collect()
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some(if layer == "moisture" { (0.0, 1.0) } else { (0.0, f64::INFINITY) })
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        ensure_finite(landscape, &self.of.0)?;
        ensure_finite(landscape, &self.wetness.0)?;
        let directions = Directions::of(landscape.field("flow_direction")?, landscape.domain.valid.as_ref())?;
        let water = self.water_cells(landscape, &directions)?;
        let above = height_above_water(landscape.field(&self.of.0)?, &directions, &water);
        let wetness = landscape.field(&self.wetness.0)?.values();
        let moisture = |(cell, &above): (usize, &f32)| {
            if water[cell] {
                return 1.0;
            }
            let near = libm::exp2(-f64::from(above) / self.half_height);
            let gathered = ((f64::from(wetness[cell]) - self.dry) / (self.wet - self.dry)).clamp(0.0, 1.0);
            (1.0 - (1.0 - near) * (1.0 - gathered)) as f32
        };
        let cells = above.values().par_iter().enumerate().with_min_len(CELLS_PER_TASK);
        let moisture = cells.map(moisture).collect();
        landscape.insert("moisture", "1", Field::from_values(above.size(), moisture));
        landscape.insert("height_above_water", "m", above);
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

impl Moisture {
    /// Which cells are water.
    fn water_cells(&self, landscape: &Landscape, directions: &Directions) -> Result<Vec<bool>, Error> {
        let mut water: Vec<bool> =
            (0..directions.codes().len()).map(|cell| directions.is_sea(cell)).collect();
        let named = [(&self.water, self.shallowest as f32), (&self.rivers, 0.0), (&self.lakes, 0.0)];
        for (name, least) in named.into_iter().filter_map(|(name, least)| Some((name.as_ref()?, least))) {
            for (water, &value) in water.iter_mut().zip(landscape.field(&name.0)?.values()) {
                *water |= value > least;
            }
        }
        Ok(water)
    }
}

/// Height of each cell above the first water on its flow path, or above the outlet where there is none;
/// 0 in water, and where the path leads over ground that is higher. In metres.
pub fn height_above_water(height: &Field, directions: &Directions, water: &[bool]) -> Field {
    let ends = |cell: usize| water[cell] || directions.downstream(cell).is_none();
    let end = directions.first_on_path(|cell| ends(cell).then_some(cell as u32));
    let height_at = |cell: usize| height.values()[cell];
    let above = |cell| end(cell).map_or(0.0, |end| (height_at(cell) - height_at(end as usize)).max(0.0));
    let cells = (0..water.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
    Field::from_values(height.size(), cells.map(above).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Routing, route};
    use weald_core::domain::Domain;
    use weald_core::grid::Size;

    #[test]
    fn the_height_above_water_is_counted_along_the_flow() {
        let size = Size::new(7, 1).expect("legal");
        let height = Field::from_values(size, vec![9.0, 6.0, 5.0, 4.0, 2.0, 1.0, 0.5]);
        let directions = route(&height, None, &Routing::default()).directions;
        let water: Vec<bool> = (0..7).map(|cell| cell == 3).collect();
        let above = height_above_water(&height, &directions, &water);
        assert_eq!(above.values(), [5.0, 2.0, 1.0, 0.0, 1.5, 0.5, 0.0]);
    }

    #[test]
    fn a_valley_with_water_is_wettest_in_it_and_dries_upward() {
        let size = Size::new(41, 30).expect("legal");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        let height = Field::from_function(size, |x, y| (x as f32 - 20.0).abs() * 2.0 + (30 - y) as f32 * 0.1);
        let water = Field::from_function(size, |x, _| if x == 20 { 1.0 } else { 0.0 });
        let routed = route(&height, None, &Routing::default());
        landscape.insert("flow_direction", "1", routed.directions.layer());
        landscape.insert("height", "m", height);
        landscape.insert("water", "m", water);
        landscape.insert("wetness", "1", Field::filled(size, 5.0));
        let step = Moisture { water: Some(LayerName::of("water")), ..Moisture::default() };
        step.run(&mut landscape, &Job::unwatched(1)).expect("it runs");
        let moisture = landscape.field("moisture").expect("written");
        assert_eq!(moisture.at(20, 15), 1.0);
        assert!((1..20).all(|x| moisture.at(x, 15) < moisture.at(x + 1, 15)), "{:?}", moisture.row(15));
        assert!(moisture.at(0, 15) < 0.01);
        landscape.insert("wetness", "1", Field::filled(size, 10.0));
        step.run(&mut landscape, &Job::unwatched(1)).expect("it runs");
        let gathered = landscape.field("moisture").expect("written").at(0, 15);
        assert!((0.5..0.51).contains(&gathered), "half-way from dry to wet: {gathered}");
    }
}
