//! A dome: `z = base + rise (1 - r²)²` within an ellipse, where `r` goes from 0 in its middle to 1 on its edge; flat ground
//! around. It meets the flat without a bend, so that ground which rises by it has no rim.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Dome>("dome", Stage::Generate, "a smooth dome, round or long, on flat ground", "Weald");

parameters! {
    /// A dome: ground of itself, or where and how fast ground rises.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::dome::Dome;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// Dome { rise: 40.0, radius: 30.0, ..Dome::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert_eq!((height.at(4, 4), height.at(7, 4)), (40.0, 0.0), "flat from 30 m off its middle");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Dome {
        /// Height of its middle above the ground around; below 0, a hollow.
        rise: f64 = 1.0, range -1.0e6..=1.0e6, unit "m";
        /// Height of the ground around.
        base: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Distance from the middle to the edge along its axis.
        radius: f64 = 5000.0, range 0.001..=1.0e9, unit "m";
        /// The same across its axis. Without it, as long: the dome is round.
        radius_across: Option<f64> = None, range 0.001..=1.0e9, unit "m";
        /// Direction of its axis, clockwise from north.
        azimuth_deg: f64 = 90.0, range -360.0..=360.0, unit "deg";
        /// Its middle, from the western edge. Without it, that of the landscape.
        center_x: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Its middle, from the northern edge. Without it, that of the landscape.
        center_y: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Dome {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        let azimuth = self.azimuth_deg.to_radians();
        let (east, north) = (libm::sin(azimuth), libm::cos(azimuth));
        let across = self.radius_across.unwrap_or(self.radius);
        let [width, length] = domain.extent();
        let (middle_x, middle_y) =
            (self.center_x.unwrap_or(0.5 * width), self.center_y.unwrap_or(0.5 * length));
        Ok(super::by_cells(domain.size, |x, y| {
            let off_east = (x as f64 + 0.5) * domain.cell - middle_x;
            let off_north = middle_y - (y as f64 + 0.5) * domain.cell;
            let on_axis = (off_east * east + off_north * north) / self.radius;
            let beside = (off_east * north - off_north * east) / across;
            let inside = (1.0 - on_axis * on_axis - beside * beside).max(0.0);
            self.base + self.rise * inside * inside
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
    fn a_long_dome_lies_along_its_axis_and_is_flat_around() {
        let domain = Domain::new(Size::square(41).expect("small"), 1.0);
        let dome = Dome {
            rise: 8.0,
            base: -3.0,
            radius: 20.0,
            radius_across: Some(5.0),
            azimuth_deg: 45.0,
            ..Dome::default()
        };
        let field = dome.fill(&domain, 0).expect("it has no faults");
        assert_eq!([field.at(20, 20), field.at(20 + 6, 20 + 6), field.at(0, 0)], [5.0, -3.0, -3.0]);
        assert!(
            (f64::from(field.at(20 + 6, 20 - 6)) - (-3.0 + 8.0 * (1.0_f64 - 72.0 / 400.0).powi(2))).abs()
                < 1e-5
        );
    }
}
