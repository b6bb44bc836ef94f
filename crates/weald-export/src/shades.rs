//! In which colours measures are drawn by programs that open their files.

use weald_io::{Shades, Spread};
use weald_picture::{Scale, Tint, encode};

use super::classes::is_of_classes;

/// Colours of a ramp that a file holds.
const COLOURS: usize = 9;

/// Heights above the zero of the model, in the colours of atlases.
const HEIGHTS: [&str; 4] = ["height", "bedrock", "river_level", "lake_level"];

/// Quantities that reach over many orders of magnitude.
const LOGARITHMIC: [&str; 2] = ["accumulation", "discharge"];

/// Quantities of both signs.
const SIGNED: [&str; 7] = [
    "curvature_profile",
    "curvature_tangential",
    "curvature_mean",
    "northness",
    "eastness",
    "flux_x",
    "flux_y",
];

/// Of both signs, and beyond all bounds where the ground is nearly flat.
const SIGNED_FAR: [&str; 1] = ["curvature_plan"];

/// Amounts of water, which is blue.
const WATER: [&str; 7] = ["water", "wet", "wetness", "moisture", "lake_depth", "river_width", "river_depth"];

/// Amounts that are worn off.
const WORN: [&str; 1] = ["erosion"];

/// The colours of a layer of measures; `None` for numbers of things.
pub fn shades(layer: &str) -> Option<Shades> {
    let is_one_of = |names: &[&str]| names.contains(&layer);
    let (spread, ramp) = match layer {
        _ if is_of_classes(layer) => return None,
        "aspect" => (Spread::Compass, Scale::Compass.ramp()),
        _ if is_one_of(&HEIGHTS) => (Spread::Even, Tint::Hypsometric.ramp()),
        _ if is_one_of(&LOGARITHMIC) => (Spread::Logarithmic, Scale::Water.ramp()),
        _ if is_one_of(&SIGNED) => (Spread::Centred, Scale::Balance.ramp()),
        _ if is_one_of(&SIGNED_FAR) => (Spread::CentredFar, Scale::Balance.ramp()),
        _ if is_one_of(&WATER) => (Spread::Even, Scale::Water.ramp()),
        _ if is_one_of(&WORN) => (Spread::Even, Scale::Ember.ramp()),
        _ => (Spread::Even, Scale::Meadow.ramp()),
    };
    let colour = |at: usize| encode(ramp.at(at as f32 / (COLOURS - 1) as f32));
    Some(Shades { spread, colours: (0..COLOURS).map(colour).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_has_classes_or_shades() {
        for layer in ["slope", "accumulation", "aspect", "curvature_mean", "sand", "height"] {
            assert!(shades(layer).is_some() && !is_of_classes(layer), "{layer}");
        }
        for layer in ["river", "flow_direction"] {
            assert!(shades(layer).is_none(), "{layer}");
        }
    }

    #[test]
    fn lowland_is_green_and_summits_are_pale() {
        let colours = shades("height").expect("it is a measure").colours;
        let [low, high] = [colours[0], colours[COLOURS - 1]];
        assert!(
            low[1] > low[0] && low[1] > low[2] && high.iter().all(|&channel| channel > 230),
            "{colours:?}"
        );
    }

    #[test]
    fn directions_end_where_they_begin_and_no_curvature_is_pale() {
        let colours = |layer: &str| shades(layer).expect("it is a measure").colours;
        let aspect = colours("aspect");
        let is_near = |[one, other]: [[u8; 3]; 2]| one.iter().zip(other).all(|(a, b)| a.abs_diff(b) < 4);
        assert!(is_near([aspect[0], aspect[COLOURS - 1]]), "{aspect:?}");
        let curvature = colours("curvature_plan");
        assert!(curvature[COLOURS / 2].iter().all(|&channel| channel > 220), "{curvature:?}");
        assert!(
            curvature[0][2] > curvature[0][0] && curvature[COLOURS - 1][0] > curvature[COLOURS - 1][2],
            "{curvature:?}"
        );
    }
}
