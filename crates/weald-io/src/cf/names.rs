//! What a layer is called: by Weald, by CF, by landlab.

/// Whose names the variables of a file have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Names {
    /// Those of the layers.
    #[default]
    Weald,
    /// Those of landlab's standard names, where it has one; rows begin in the south, as landlab's nodes do.
    Landlab,
}

/// What others call a layer.
#[derive(Debug)]
pub(super) struct Known {
    layer: &'static str,
    /// Name in the CF standard name table.
    pub(super) standard: Option<&'static str>,
    /// Name in landlab.
    pub(super) landlab: Option<&'static str>,
}

#[rustfmt::skip] // a table
const KNOWN: &[Known] = &[
    known("height", Some("surface_altitude"), Some("topographic__elevation")),
    known("bedrock", Some("bedrock_altitude"), Some("bedrock__elevation")),
    known("soil", None, Some("soil__depth")),
    known("water", None, Some("surface_water__depth")),
    known("slope", None, Some("topographic__slope")),
    known("accumulation", None, Some("drainage_area")),
    known("discharge", None, Some("surface_water__discharge")),
];

const fn known(layer: &'static str, standard: Option<&'static str>, landlab: Option<&'static str>) -> Known {
    Known { layer, standard, landlab }
}

/// What is known of the layer of that name.
pub(super) fn of_layer(layer: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|known| known.layer == layer)
}

/// Whether a variable of that name holds heights: a layer `height`, or what others call it.
pub(super) fn means_height(variable: &str) -> bool {
    let landlab = |known: &Known| known.landlab == Some(variable);
    variable == "height" || of_layer("height").is_some_and(landlab)
}

impl Names {
    /// Names of variables for layers, legal in CF, each once and none of `taken`.
    pub(super) fn of_variables(self, layers: &[&str], taken: &[&str]) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for layer in layers {
            let landlab = of_layer(layer).and_then(|known| known.landlab);
            let wanted =
                landlab.filter(|_| self == Self::Landlab).map_or_else(|| legal(layer), str::to_owned);
            let is_free = |name: &String| !names.contains(name) && !taken.contains(&name.as_str());
            let numbered = (2..).map(|number| format!("{wanted}_{number}"));
            let free = std::iter::once(wanted.clone()).chain(numbered).find(is_free);
            names.push(free.expect("numbers do not run out"));
        }
        names
    }
}

/// The name in letters, digits and underscores, a letter first.
fn legal(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("layer_{name}") }
}

/// The unit as UDUNITS spells it. An iteration is a count there, which has no unit.
pub(super) fn udunits(unit: &str) -> String {
    let spelled = unit.replace('²', "2").replace('³', "3").replace('°', "degree").replace('·', " ");
    let per_iteration = spelled.strip_suffix("/step").unwrap_or(&spelled);
    per_iteration.strip_prefix("1/").map_or_else(|| per_iteration.to_owned(), |below| format!("{below}-1"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_have_legal_names_that_occur_once() {
        let layers = ["a-b", "a_b", "1st", "x", "height", "water"];
        assert_eq!(
            Names::Weald.of_variables(&layers, &["x", "y"]),
            ["a_b", "a_b_2", "layer_1st", "x_2", "height", "water"]
        );
        let landlab = Names::Landlab.of_variables(&layers, &[]);
        assert_eq!(landlab[4..], ["topographic__elevation", "surface_water__depth"]);
        assert!(means_height("height") && means_height("topographic__elevation"));
        assert!(!means_height("bedrock__elevation"));
    }

    #[test]
    fn units_are_spelled_for_udunits() {
        for (unit, spelled) in
            [("m", "m"), ("m³/step", "m3"), ("m³/s", "m3/s"), ("1/m", "m-1"), ("1", "1"), ("°", "degree")]
        {
            assert_eq!(udunits(unit), spelled);
        }
    }
}
