//! What the viewport shows of a landscape, and in which light.

use weald::picture::{GroundColour, View};

/// Light, colours and heights of the viewport.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Looks {
    /// Hours since midnight, by which the sun stands.
    pub(crate) hour: f64,
    /// What the ground is coloured by; by the recipe where none is chosen.
    pub(crate) ground: Option<GroundColour>,
    /// Factor on heights.
    pub(crate) exaggeration: f64,
    /// Whether water is drawn.
    pub(crate) water: bool,
    /// Brightness: each 1 more is twice as bright.
    pub(crate) exposure: f64,
    /// A layer that is shown as a map in place of the view.
    pub(crate) layer: Option<String>,
}

impl Default for Looks {
    fn default() -> Self {
        Self { hour: 17.0, ground: None, exaggeration: 1.0, water: true, exposure: 0.0, layer: None }
    }
}

/// Hours of sunrise and sunset, and how high the sun stands at noon, as on a day of spring in the middle latitudes.
const DAY: [f64; 2] = [6.0, 18.5];
const NOON_DEG: f64 = 55.0;

/// The lowest sun that is drawn.
const LOWEST_DEG: f64 = 2.0;

impl Looks {
    /// The sun's azimuth, clockwise from north, and altitude, in degrees: east in the morning, west in the evening.
    pub(crate) fn sun_deg(&self) -> [f64; 2] {
        let share = ((self.hour - DAY[0]) / (DAY[1] - DAY[0])).clamp(0.0, 1.0);
        let altitude = NOON_DEG * (std::f64::consts::PI * share).sin();
        [90.0 + 180.0 * share, altitude.max(LOWEST_DEG)]
    }

    /// The view that has these looks.
    pub(crate) fn view(&self) -> View {
        let [sun_azimuth_deg, sun_altitude_deg] = self.sun_deg();
        View {
            sun_azimuth_deg,
            sun_altitude_deg,
            ground: self.ground,
            exaggeration: self.exaggeration,
            water: self.water,
            exposure: self.exposure,
            field_of_view_deg: 40.0,
            ..View::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_goes_from_east_by_south_to_west_and_never_below_what_is_drawn() {
        let at = |hour| Looks { hour, ..Looks::default() }.sun_deg();
        assert_eq!(at(0.0), [90.0, LOWEST_DEG]);
        assert!((at(12.25)[0] - 180.0).abs() < 1e-9 && (at(12.25)[1] - NOON_DEG).abs() < 1e-9);
        assert_eq!(at(23.0)[0], 270.0);
    }
}
