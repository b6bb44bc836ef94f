//! An inclined plane: `z = height + slope * d`, where `d` is the distance uphill from the middle of the
//! landscape.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Plane>(
    "plane",
    Stage::Generate,
    "an inclined plane through the middle of the landscape",
    "Weald",
);

parameters! {
    /// An inclined plane.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::plane::Plane;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// let plane = Plane { slope: 0.1, azimuth_deg: 180.0, height: 50.0, ..Plane::default() };
    /// plane.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert_eq!((height.at(4, 3), height.at(4, 4), height.at(4, 5)), (51.0, 50.0, 49.0), "it falls to the south");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Plane {
        /// Rise over run.
        slope: f64 = 0.1, range 0.0..=1000.0;
        /// Direction in which the ground falls, clockwise from north: 180 falls to the south.
        azimuth_deg: f64 = 180.0, range -360.0..=360.0, unit "deg";
        /// Height at the middle of the landscape.
        height: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Plane {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        let azimuth = self.azimuth_deg.to_radians();
        let (east, south) = (libm::sin(azimuth), -libm::cos(azimuth));
        let fall = self.slope * domain.cell;
        let [middle_x, middle_y] = [domain.size.columns, domain.size.rows].map(|n| (n as f64 - 1.0) / 2.0);
        Ok(super::by_cells(domain.size, |x, y| {
            let downhill = east * (x as f64 - middle_x) + south * (y as f64 - middle_y);
            self.height - fall * downhill
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

    fn rise(azimuth_deg: f64) -> [f32; 2] {
        let plane = Plane { slope: 0.5, azimuth_deg, height: 7.0, ..Plane::default() };
        let field =
            plane.fill(&Domain::new(Size::square(5).expect("small"), 2.0), 0).expect("any grid will do");
        assert_eq!(field.at(2, 2), 7.0, "the middle has the stated height");
        [field.at(3, 2) - field.at(2, 2), field.at(2, 3) - field.at(2, 2)]
    }

    #[test]
    fn the_ground_falls_towards_its_azimuth() {
        for (azimuth, east, south) in
            [(0.0, 0.0, 1.0), (90.0, -1.0, 0.0), (180.0, 0.0, -1.0), (-90.0, 1.0, 0.0)]
        {
            let [x, y] = rise(azimuth);
            assert!((x - east).abs() < 1e-6 && (y - south).abs() < 1e-6, "{azimuth}: {x} {y}");
        }
    }
}
