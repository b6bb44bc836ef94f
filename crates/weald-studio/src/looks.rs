//! What the viewport shows of a landscape, and in which light.

use weald::Landscape;
use weald::parameter::Nested;
use weald::picture::{Drape, GroundColour, Scale, View};

/// All colours that a layer can have.
pub(crate) const RAMPS: [Scale; 6] =
    [Scale::Meadow, Scale::Water, Scale::Ember, Scale::Balance, Scale::Compass, Scale::Grey];

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
    /// A layer whose value is told under the pointer, and by which the ground is coloured where it is draped.
    pub(crate) layer: Option<String>,
    /// Whether the layer colours the ground.
    pub(crate) drapes: bool,
    /// Its colours.
    pub(crate) ramp: Scale,
    /// Whether they follow the logarithm of its values.
    pub(crate) logarithmic: bool,
}

impl Default for Looks {
    fn default() -> Self {
        Self {
            hour: 17.0,
            ground: None,
            exaggeration: 1.0,
            water: true,
            exposure: 0.0,
            layer: None,
            drapes: true,
            ramp: Scale::Meadow,
            logarithmic: false,
        }
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

    /// The layer that is draped over a landscape; `None` where none is chosen, or the landscape has it no more.
    pub(crate) fn drape(&self, landscape: &Landscape) -> Option<Drape> {
        let layer = self.layer.as_ref().filter(|layer| self.drapes && landscape.field(layer).is_ok())?;
        Some(Drape { ramp: self.ramp, logarithmic: self.logarithmic, ..Drape::of(layer) })
    }

    /// The view of a landscape that has these looks.
    pub(crate) fn view(&self, landscape: &Landscape) -> View {
        let [sun_azimuth_deg, sun_altitude_deg] = self.sun_deg();
        View {
            sun_azimuth_deg,
            sun_altitude_deg,
            ground: self.ground,
            drape: self.drape(landscape).map(Nested),
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
    use weald::parameter::{Kind, Parameters};

    #[test]
    fn all_colours_of_the_recipe_are_offered() {
        let parameters = Drape::parameters();
        let ramp = parameters.iter().find(|parameter| parameter.name == "ramp").expect("there");
        assert!(matches!(&ramp.kind, Kind::Choice(words) if *words == RAMPS.map(Scale::word)));
    }

    #[test]
    fn the_sun_goes_from_east_by_south_to_west_and_never_below_what_is_drawn() {
        let at = |hour| Looks { hour, ..Looks::default() }.sun_deg();
        assert_eq!(at(0.0), [90.0, LOWEST_DEG]);
        assert!((at(12.25)[0] - 180.0).abs() < 1e-9 && (at(12.25)[1] - NOON_DEG).abs() < 1e-9);
        assert_eq!(at(23.0)[0], 270.0);
    }
}
