//! A volcano of layers: a cone whose flanks grow steeper towards the rim of a crater.
//!
//! ```text
//! z = base + rise f(r) / f(crater)        f(r) = e^(−c r / R) − e^(−c)
//! ```
//!
//! from the rim of the crater to the foot at R: the logarithmic curve that Milne (1878, "On the form of volcanoes",
//! Geological Magazine 5) found on photographs of Fuji and others. The crater is a bowl, a paraboloid.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Volcano>(
    "volcano",
    Stage::Generate,
    "a cone with a crater, steeper towards its rim, on flat ground",
    "Milne 1878, On the form of volcanoes, Geological Magazine 5",
);

parameters! {
    /// A volcano as eruptions leave it, before rain cuts it.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::volcano::Volcano;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(81, 81)?, 100.0)); // columns, rows, metres
    /// let volcano = Volcano { rise: 900.0, radius: 3500.0, crater_radius: 400.0, crater_depth: 150.0, ..Volcano::default() };
    /// volcano.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// let [floor, rim, foot] = [40, 44, 80].map(|x| height.at(x, 40));
    /// assert_eq!((floor, rim, foot), (750.0, 900.0, 0.0), "a crater of 150 m in a cone of 900 m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Volcano {
        /// Height of the rim of the crater above the ground around.
        rise: f64 = 1500.0, range 0.0..=1.0e6, unit "m";
        /// Height of the ground around.
        base: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Distance from the axis to the foot.
        radius: f64 = 8000.0, range 0.001..=1.0e9, unit "m";
        /// How hollow the flanks are (c): 0 for a straight cone; at 3 they are 20 times as steep at the axis as at the foot.
        concavity: f64 = 3.0, range 0.0..=20.0;
        /// Distance from the axis to the rim of the crater; 0 for a tip.
        crater_radius: f64 = 300.0, range 0.0..=1.0e9, unit "m";
        /// Depth of the crater below its rim.
        crater_depth: f64 = 150.0, range 0.0..=1.0e6, unit "m";
        /// The axis, from the western edge. Without it, the middle.
        center_x: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// The axis, from the northern edge. Without it, the middle.
        center_y: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Volcano {
    /// Height above the ground around at a distance from the axis, of a cone without a crater and of any height.
    fn flank(&self, distance: f64) -> f64 {
        let share = (distance / self.radius).min(1.0);
        let c = self.concavity;
        if c == 0.0 { 1.0 - share } else { libm::exp(-c * share) - libm::exp(-c) }
    }

    fn height(&self, distance: f64) -> f64 {
        if distance >= self.crater_radius {
            return self.base + self.rise * (self.flank(distance) / self.flank(self.crater_radius));
        }
        let from_axis = distance / self.crater_radius;
        self.base + self.rise - self.crater_depth * (1.0 - from_axis * from_axis)
    }
}

impl Generator for Volcano {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        let distance = super::distance_from(domain, [self.center_x, self.center_y]);
        Ok(super::by_cells(domain.size, |x, y| self.height(distance(x, y))))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }

    fn contradictions(&self) -> Vec<Fault> {
        let wide = format!(
            "`crater_radius` is {} m, but `radius`, the foot, is {} m: the crater must be narrower",
            self.crater_radius, self.radius
        );
        if self.crater_radius < self.radius { Vec::new() } else { vec![Fault::of("crater_radius", wide)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flanks_grow_steeper_upward_by_the_factor_that_concavity_says_and_meet_rim_and_foot() {
        for concavity in [0.0, 1.0, 3.0, 8.0] {
            let volcano = Volcano { concavity, crater_radius: 0.0, ..Volcano::default() };
            let slope = |distance: f64| volcano.height(distance) - volcano.height(distance + 0.01);
            let ratio = slope(0.0) / slope(volcano.radius - 0.01);
            assert!((ratio / concavity.exp() - 1.0).abs() < 1e-3, "concavity {concavity}: {ratio}");
            assert_eq!(volcano.height(volcano.radius), volcano.base);
            assert!((volcano.height(0.0) - volcano.rise).abs() < 1e-9);
        }
        let volcano = Volcano::default();
        let [inside, outside] = [-1e-6, 1e-6].map(|off| volcano.height(volcano.crater_radius + off));
        assert!((inside - outside).abs() < 1e-3, "the rim is one line: {inside} m and {outside} m");
    }
}
