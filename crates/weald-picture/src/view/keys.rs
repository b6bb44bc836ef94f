//! The parameters of a perspective view.

use crate::colour_scale::Drape;
use weald_core::domain::Domain;
use weald_core::parameter::{LayerName, Nested, Places};

weald_core::choices! {
    /// What the ground of a view is coloured by.
    pub enum GroundColour {
        /// Meadow, forest, scree, rock and snow, by slope, height, soil and moisture.
        Natural = "natural",
        /// The materials at the surface.
        Materials = "materials",
    }
}

weald_core::choices! {
    /// What lies around the landscape of a view.
    pub enum Around {
        /// Nothing: a block that is cut out of the land, on a plain.
        Block = "block",
        /// Land or sea up to the horizon, which goes on as the border begins it.
        Horizon = "horizon",
    }
}

weald_core::parameters! {
    /// A perspective view.
    pub struct View {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Width of the picture.
        width: u32 = 1600, range 16..=16384, unit "px";
        /// Height of the picture.
        height: u32 = 900, range 16..=16384, unit "px";
        /// Most rays per pixel; an even one takes three. With 1, edges are aliased.
        samples: u32 = 6, range 1..=64;
        /// Azimuth at which the camera stands (yaw), clockwise from north, seen from what it looks at.
        azimuth_deg: f64 = 205.0, range 0.0..=360.0, unit "deg", without eye;
        /// Elevation angle at which the camera stands (pitch), above the horizon, seen from what it looks at.
        altitude_deg: f64 = 27.0, range 0.0..=90.0, unit "deg", without eye;
        /// How far it is from what it looks at. By default the landscape just fills the picture.
        distance: Option<f64> = None, range 1.0e-3..=1.0e8, unit "m", without eye;
        /// Place that the camera looks at, `[x, y]` in metres east and south of the north-western corner. By
        /// default the middle of the landscape.
        target: Option<Places> = None;
        /// Place where the camera stands, `[x, y]` as for `target`, in place of azimuth, altitude and distance.
        eye: Option<Places> = None;
        /// Height of the camera above the ground at `eye`, or above the lowest ground outside the landscape.
        eye_height: f64 = 100.0, range 0.0..=1.0e7, unit "m", with eye;
        /// Horizontal field of view.
        field_of_view_deg: f64 = 30.0, range 1.0..=120.0, unit "deg";
        /// Turn of the camera about what it looks at, clockwise seen from above: the frames of a turntable
        /// differ in it. Where it is given, the distance by default shows the landscape whole at any turn.
        turn_deg: Option<f64> = None, range -36000.0..=36000.0, unit "deg";
        /// What lies around the landscape: cut sides on a plain, or land and sea that go on to the horizon; that is made
        /// up of the landscape's own ground, and cells without data are filled. By default `horizon` with `eye` or where
        /// the landscape has a sea level, else `block`.
        around: Option<Around> = None;
        /// Azimuth of the sun, clockwise from north.
        sun_azimuth_deg: f64 = 265.0, range 0.0..=360.0, unit "deg";
        /// Elevation angle of the sun above the horizon.
        sun_altitude_deg: f64 = 28.0, range 1.0..=90.0, unit "deg";
        /// Diameter of the sun in the sky: a larger one has softer shadows.
        sun_diameter_deg: f64 = 0.53, range 0.01..=20.0, unit "deg";
        /// Share of the sky that fair-weather clouds hide, whose shadows lie on the land. They are 1300 m above the highest
        /// ground.
        clouds: f64 = 0.0, range 0.0..=1.0;
        /// Meteorological visibility: how far one sees through the haze at the lowest ground. By default the haze
        /// takes a seventh of the light between the middle of the landscape and the camera.
        visibility: Option<f64> = None, range 1.0..=1.0e12, unit "m";
        /// Brightness: each 1 more is twice as bright.
        exposure: f64 = 0.0, range -8.0..=8.0, unit "stops";
        /// Factor on heights.
        exaggeration: f64 = 1.0, range 0.01..=100.0;
        /// What colours the ground. By default `materials` where the recipe names materials of its own, else
        /// `natural`.
        ground: Option<GroundColour> = None, without drape;
        /// A layer that colours the ground in place of `ground`, as in a map of it.
        drape: Option<Nested<Drape>> = None;
        /// Slope from which natural ground is bare rock. By default that of the steepest tenth of the land, but
        /// between 30° and 42°.
        rock_deg: Option<f64> = None, range 1.0..=89.0, unit "deg", unless ground = "materials";
        /// Elevation up to which trees grow on natural ground. By default the lower 60 % of the relief.
        tree_line: Option<f64> = None, unit "m", unless ground = "materials";
        /// How far woods spread over natural ground below `tree_line`: 0 nowhere, 0.5 where it is moist, 1 wherever it is not too
        /// steep.
        woods: f64 = 0.5, range 0.0..=1.0, unless ground = "materials";
        /// Elevation from which snow lies on natural ground that is not too steep. By default there is none.
        snow_line: Option<f64> = None, unit "m", unless ground = "materials";
        /// Whether lakes (layer `water`) and rivers (layers `flux_x`, `flux_y`) are drawn where they exist.
        water: bool = true;
        /// Factor on the drawn width of rivers; 1 is the usual width for their drainage area.
        river_width: f64 = 2.0, range 0.0..=100.0, when water = true;
    }
}

impl View {
    /// Whether land and sea go on to the horizon around a landscape.
    pub(super) fn has_horizon(&self, domain: &Domain) -> bool {
        match self.around {
            Some(around) => around == Around::Horizon,
            None => self.eye.is_some() || domain.sea_level.is_some(),
        }
    }

    /// The view with its camera further on by a share of a turn, for the frames of a turntable: `share` 0 is the
    /// first of them, 0.25 a quarter of the way round.
    #[must_use]
    pub fn turned(&self, share: f64) -> Self {
        Self { turn_deg: Some(self.turn_deg.unwrap_or(0.0) + 360.0 * share), ..self.clone() }
    }
}
