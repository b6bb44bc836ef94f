//! A cone on flat ground: `z = max(base, peak - slope r)`, where `r` is the distance from its axis.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Cone>("cone", Stage::Generate, "a cone on flat ground", "Weald");

parameters! {
    /// A cone.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::cone::Cone;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// Cone { peak: 40.0, slope: 0.5, ..Cone::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert_eq!((height.at(4, 4), height.at(6, 4)), (40.0, 30.0), "10 m lower at 20 m from the axis");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Cone {
        /// Height of the tip. A cell holds it only where its centre lies on the axis.
        peak: f64 = 100.0, range -1.0e6..=1.0e6, unit "m";
        /// Height of the ground around.
        base: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Rise over run of the flank.
        slope: f64 = 1.0, range 0.0..=1000.0;
        /// The axis, from the western edge. Without it, the middle.
        center_x: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// The axis, from the northern edge. Without it, the middle.
        center_y: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Cone {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        let radius = super::distance_from(domain, [self.center_x, self.center_y]);
        Ok(super::by_cells(domain.size, |x, y| (self.peak - self.slope * radius(x, y)).max(self.base)))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }

    fn contradictions(&self) -> Vec<Fault> {
        let upside_down =
            format!("`peak` is {} m, below `base`, {} m: the cone would not show", self.peak, self.base);
        if self.peak < self.base { vec![Fault::of("peak", upside_down)] } else { Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn the_flank_falls_by_its_slope_and_ends_at_the_base() {
        let cone = Cone { peak: 50.0, base: 10.0, slope: 2.0, ..Cone::default() };
        let field =
            cone.fill(&Domain::new(Size::square(21).expect("small"), 3.0), 0).expect("any grid will do");
        assert_eq!(field.at(10, 10), 50.0);
        assert_eq!(field.at(13, 14), 50.0 - 2.0 * 3.0 * 5.0, "3, 4, 5");
        assert_eq!(field.at(0, 0), 10.0);
    }

    #[test]
    fn the_axis_is_placed_in_metres_from_the_north_western_corner() {
        let cone = Cone { center_x: Some(15.0), center_y: Some(5.0), ..Cone::default() };
        let field =
            cone.fill(&Domain::new(Size::square(4).expect("small"), 10.0), 0).expect("any grid will do");
        assert_eq!(field.at(1, 0), 100.0, "the centre of cell (1, 0) lies at 15 m, 5 m");
    }
}
