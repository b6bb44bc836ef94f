//! What layers are, in words, and their units as people are shown them.

/// The layers that steps write under names of their own, each with what it is.
pub const LAYERS: &[(&str, &str)] = &[
    ("height", "height of the ground"),
    ("bedrock", "height of the top of the bedrock"),
    ("soil", "thickness of the material soil"),
    ("regolith", "thickness of the ground that standing water has softened"),
    ("water", "depth of the water at the end"),
    ("sediment", "sediment in the water, as the depth that it would have as ground"),
    ("flux_x", "water that flows east through the eastern edge of a cell, mean of the last whole cycle"),
    ("flux_y", "water that flows south through the southern edge of a cell, mean of the last whole cycle"),
    ("erosion", "net loss of ground since the start of the simulation, 0 where it gained"),
    ("deposition", "net gain of ground since the start of the simulation, 0 where it lost"),
    (
        "flow_direction",
        "neighbour to which a cell drains: 1 east, 2 south-east, and on clockwise to 8 north-east; 0 outlet, at the \
         border of the grid and beside cells without data, holes too; 9 sea",
    ),
    ("accumulation", "upslope (drainage) area, the cell's own included"),
    ("discharge", "mean annual discharge: upslope area times runoff, not of the simulated water"),
    ("river", "1 on rivers, else 0"),
    ("river_width", "width of the river by its discharge; 0 beside rivers"),
    ("river_depth", "depth of the river by its discharge; 0 beside rivers"),
    ("river_level", "level of the river; the height of the ground beside rivers"),
    ("strahler", "Strahler order of the river; 0 beside rivers"),
    ("lake", "number of the lake, 0 beside lakes"),
    ("lake_level", "level of the lake; the height of the ground beside lakes"),
    ("lake_depth", "depth of the lake; 0 beside lakes"),
    ("sea_depth", "depth of the sea; 0 on land"),
    (
        "exposure",
        "how open the coast lies to waves: 1 where it faces the wind over the full fetch; 0 beside the coast",
    ),
    ("watershed", "number of the watershed, the largest first from 1; 0 in none"),
    ("wetness", "topographic wetness index ln(a / tan β), a in metres"),
    ("moisture", "moisture of the soil, 0 dry to 1 wet or water"),
    ("height_above_water", "height above the nearest drainage (HAND), along the flow path"),
    ("soil_depth", "depth of the soil"),
    ("fertility", "how well the soil feeds plants, 0 to 1"),
    ("slope", "steepness of the fitted surface around the cell"),
    ("aspect", "azimuth to which the ground faces, clockwise from north, 0 to 360; -1 where it is flat"),
    ("northness", "cosine of the aspect: 1 north, -1 south; 0 where the ground is flat"),
    ("eastness", "sine of the aspect: 1 east, -1 west; 0 where the ground is flat"),
    ("curvature_profile", "curvature along the line of fall, convex positive"),
    ("curvature_plan", "curvature of the contour line, convex positive"),
    ("curvature_tangential", "curvature across the line of fall, convex positive"),
    ("curvature_mean", "mean curvature, convex positive"),
    ("sunlight", "light that the ground gets in a day"),
    ("light", "share of the light of flat open ground, 0 to 1"),
    ("occlusion", "share of the half-sphere over the ground that nothing hides, 0 to 1"),
    ("sky_view", "share of the light of an even sky that falls on the ground, 0 to 1"),
    ("material", "material at the surface, counted from the bedrock as 0"),
    ("mask", "share to which the ground is selected, 0 to 1"),
    ("plants", "number of plants for an area"),
    ("grass", "sets of grass in all"),
    ("grass_ryegrass", "sets of one species; each species has a layer of its own"),
];

/// What a layer is that a step writes under this name.
pub fn meaning(layer: &str) -> Option<&'static str> {
    LAYERS.iter().find(|(name, _)| *name == layer).map(|(_, meaning)| *meaning)
}

/// A unit as people are shown it: nothing where a layer has none, and what simulations repeat is an iteration.
pub fn shown_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.replace("/step", "/iteration") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_layer_has_one_meaning() {
        for (at, (name, meaning)) in LAYERS.iter().enumerate() {
            assert!(!meaning.is_empty() && LAYERS[..at].iter().all(|(earlier, _)| earlier != name), "{name}");
        }
    }

    #[test]
    fn units_are_shown_with_iterations_and_no_one() {
        assert_eq!(["m³/step", "m", "1"].map(shown_unit), ["m³/iteration", "m", ""]);
    }
}
