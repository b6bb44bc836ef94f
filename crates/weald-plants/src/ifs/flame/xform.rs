//! An `xform` as an affine map, or why it is none.

use super::super::map::Map;
use super::element::{Element, shown};
use weald_io::Fault;

/// A map and how often it is taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Xform {
    pub(super) map: Map,
    /// Above 0, in any unit.
    pub(super) weight: f64,
}

/// Attributes that leave points where they are, or are read elsewhere.
const OTHERS: &[&str] = &[
    "weight",
    "coefs",
    "post",
    "chaos",
    "opacity",
    "plotmode",
    "var",
    "var1",
    "color",
    "color_speed",
    "symmetry",
    "animate",
    "var_color",
    "name",
    "material",
    "material_speed",
];

/// Beginnings of such attributes.
const OTHER_BEGINNINGS: &[&str] = &["mod_", "motion_", "color_"];

/// Attributes of relatives that turn a map out of the plane, where they are not the identity.
const SPATIAL: &[&str] = &["yzCoefs", "zxCoefs", "yzPost", "zxPost"];

const IDENTITY: [f64; 6] = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];

/// Variations of flam3 3.1.1 in the order of their numbers.
#[rustfmt::skip] // a line for each would be a page
const VARIATIONS: &[&str] = &[
    "linear", "sinusoidal", "spherical", "swirl", "horseshoe", "polar", "handkerchief", "heart", "disc",
    "spiral", "hyperbolic", "diamond", "ex", "julia", "bent", "waves", "fisheye", "popcorn", "exponential",
    "power", "cosine", "rings", "fan", "blob", "pdj", "fan2", "rings2", "eyefish", "bubble", "cylinder",
    "perspective", "noise", "julian", "juliascope", "blur", "gaussian_blur", "radial_blur", "pie", "ngon",
    "curl", "rectangles", "arch", "tangent", "square", "rays", "blade", "secant2", "twintrian", "cross",
    "disc2", "super_shape", "flower", "conic", "parabola", "bent2", "bipolar", "boarders", "butterfly",
    "cell", "cpow", "curve", "edisc", "elliptic", "escher", "foci", "lazysusan", "loonie", "pre_blur",
    "modulus", "oscilloscope", "polar2", "popcorn2", "scry", "separation", "split", "splits", "stripes",
    "wedge", "wedge_julia", "wedge_sph", "whorl", "waves2", "exp", "log", "sin", "cos", "tan", "sec", "csc",
    "cot", "sinh", "cosh", "tanh", "sech", "csch", "coth", "auger", "flux", "mobius",
];

/// The map `post (weight coefs)`, with `y` upwards.
pub(super) fn map(element: Element<'_>) -> Result<Map, Fault> {
    check_drawn(element)?;
    let weight = linear_weight(element)?;
    let coefs = element.six("coefs")?.unwrap_or(IDENTITY).map(|number| weight * number);
    let post = element.six("post")?.unwrap_or(IDENTITY);
    Ok(upright(post).after(&upright(coefs)))
}

/// A map in the numbers of a file, seen with `y` upwards.
fn upright([a, d, b, e, c, f]: [f64; 6]) -> Map {
    // A zero stays a plus zero.
    Map::planar([a, -b, -d, e, c, -f].map(|number| number + 0.0))
}

/// The numbers of a file for a map of the plane.
pub(super) fn numbers(map: &Map) -> [f64; 6] {
    let [[a, b, _], [c, d, _], _] = map.linear;
    [a, -c, -b, d, map.offset[0], -map.offset[1]].map(|number| number + 0.0)
}

/// The map that undoes a map of the plane.
pub(super) fn inverse(map: &Map) -> Option<Map> {
    let [[a, b, _], [c, d, _], _] = map.linear;
    let determinant = map.determinant();
    let turned = Map::planar([d, -b, -c, a, 0.0, 0.0].map(|number| number / determinant));
    let [x, y, _] = turned.turn(map.offset);
    let back = Map { offset: [-x, -y, 0.0], ..turned };
    (determinant != 0.0 && back.is_finite()).then_some(back)
}

/// Whether its points are drawn, and it may follow every xform.
fn check_drawn(element: Element<'_>) -> Result<(), Fault> {
    if element.text("plotmode") == Some("off")
        || element.number("opacity")?.is_some_and(|opacity| opacity <= 0.0)
    {
        return Err(element
            .fault("it is hidden, by `plotmode` or `opacity`; a fractal shows what all of its maps draw"));
    }
    let chaos = element.text("chaos").map(|text| element.list("chaos", text)).transpose()?;
    if chaos.is_some_and(|shares| shares.iter().any(|share| *share != 1.0)) {
        return Err(element.fault(
            "its `chaos` makes what follows depend on it; each map of a fractal follows all others: \
             take `chaos` out, or make all its numbers 1",
        ));
    }
    SPATIAL.iter().try_for_each(|attribute| match element.six(attribute)? {
        Some(numbers) if numbers != IDENTITY => {
            Err(element.fault(&format!("`{attribute}` turns it out of the plane; only 2D maps are read")))
        }
        _ => Ok(()),
    })
}

/// The weights of `linear` and `linear3D`; no other variation may have one.
fn linear_weight(element: Element<'_>) -> Result<f64, Fault> {
    let mut weight = numbered_weight(element)?;
    for (attribute, value) in element.attributes().filter(|(attribute, _)| is_shaping(attribute)) {
        let number = value.trim().parse::<f64>().unwrap_or(0.0);
        if matches!(attribute, "linear" | "linear3D") {
            *weight.get_or_insert(0.0) += element.number(attribute)?.unwrap_or(0.0);
        } else if number != 0.0 {
            return Err(refused(element, attribute, value));
        }
    }
    weight.ok_or_else(|| element.fault("it names no variation; write linear=\"1\""))
}

/// Whether an attribute may be a variation.
fn is_shaping(attribute: &str) -> bool {
    let is_known = VARIATIONS.contains(&attribute);
    // A parameter does nothing without its variation, which is refused by itself.
    let is_parameter =
        |variation: &&str| attribute.strip_prefix(*variation).is_some_and(|rest| rest.starts_with('_'));
    let is_other = OTHERS.contains(&attribute)
        || SPATIAL.contains(&attribute)
        || OTHER_BEGINNINGS.iter().any(|beginning| attribute.starts_with(beginning));
    is_known || !(is_other || is_parameters_of_mobius(attribute) || VARIATIONS.iter().any(is_parameter))
}

fn is_parameters_of_mobius(attribute: &str) -> bool {
    let name = attribute.strip_prefix("Re_").or_else(|| attribute.strip_prefix("Im_"));
    name.is_some_and(|name| matches!(name, "A" | "B" | "C" | "D"))
}

/// The weight of `linear` in the older spellings: a list of all weights, or the number of the only variation.
fn numbered_weight(element: Element<'_>) -> Result<Option<f64>, Fault> {
    if let Some(number) = element.number("var1")? {
        return if number == 0.0 {
            Ok(Some(1.0))
        } else {
            Err(refused(element, &numbered(number as usize), "1"))
        };
    }
    let Some(text) = element.text("var") else { return Ok(None) };
    let weights = element.list("var", text)?;
    match weights.iter().skip(1).position(|weight| *weight != 0.0) {
        Some(place) => Err(refused(element, &numbered(place + 1), &weights[place + 1].to_string())),
        None => Ok(weights.first().copied()),
    }
}

fn numbered(variation: usize) -> String {
    VARIATIONS.get(variation).map_or_else(|| format!("variation {variation}"), |name| (*name).to_owned())
}

fn refused(element: Element<'_>, variation: &str, weight: &str) -> Fault {
    let what = if VARIATIONS.contains(&variation) { "the variation" } else { "what is no known attribute," };
    element.fault(&format!(
        "it has {what} `{}` with weight {}, and only `linear` makes an affine map; choose a flame with linear xforms alone",
        shown(variation),
        shown(weight),
    ))
}
