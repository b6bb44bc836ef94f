//! A round bowl in flat ground: `z = rim - depth (1 - (r/R)²)` inside radius `R`, a paraboloid.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Basin>("basin", Stage::Generate, "a round bowl in flat ground", "Weald");

parameters! {
    /// A bowl.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::basin::Basin;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// Basin { depth: 30.0, rim: 80.0, ..Basin::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert_eq!((height.at(4, 4), height.at(0, 0)), (50.0, 80.0), "the middle, and the ground around");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Basin {
        /// Depth of the deepest point below the rim.
        depth: f64 = 50.0, range 0.0..=1.0e6, unit "m";
        /// Height of the rim and of the ground around.
        rim: f64 = 100.0, range -1.0e6..=1.0e6, unit "m";
        /// Radius of the rim. Without it, half the shorter side of the landscape.
        radius: Option<f64> = None, range 1.0e-3..=1.0e9, unit "m";
        /// The deepest point, from the western edge. Without it, the middle.
        center_x: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// The deepest point, from the northern edge. Without it, the middle.
        center_y: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Basin {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        let shorter = domain.size.columns.min(domain.size.rows) as f64 * domain.cell;
        let rim_radius = self.radius.unwrap_or(shorter / 2.0);
        let distance = super::distance_from(domain, [self.center_x, self.center_y]);
        Ok(super::by_cells(domain.size, |x, y| {
            let share = (distance(x, y) / rim_radius).min(1.0);
            self.rim - self.depth * (1.0 - share * share)
        }))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn the_bowl_is_a_paraboloid_between_its_deepest_point_and_its_rim() {
        let basin = Basin { depth: 32.0, rim: 40.0, radius: Some(8.0), ..Basin::default() };
        let field =
            basin.fill(&Domain::new(Size::square(21).expect("small"), 1.0), 0).expect("any grid will do");
        assert_eq!(field.at(10, 10), 8.0);
        assert_eq!(field.at(14, 10), 40.0 - 32.0 * 0.75, "half way out, a quarter of the way up");
        assert_eq!(field.at(2, 10), 40.0);
        assert_eq!(field.at(0, 0), 40.0);
    }
}
