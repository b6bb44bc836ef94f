//! Landscapes that tests of pictures look at, and from where.

#![allow(dead_code, reason = "each test file uses a part")]

use weald::picture::{Camera, LitScene, View};
use weald::recipe::{Overrides, Recipe};
use weald::{Field, Landscape};
use weald_gpu::RenderOptions;

pub(crate) const SIZE: [u32; 2] = [320, 180];

/// Mountains of 20 m cells with a lake in their lowest third, and the sun high enough for short shadows.
pub(crate) fn mountains() -> Landscape {
    let text = "[landscape]\nsize = 160\ncell = 20.0\nseed = 5\n[[step]]\ndo = \"diamond-square\"\nrelief = 700.0\n\
                roughness = 0.9\n[[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n";
    let recipe = Recipe::parse("mountains.toml", text, &Overrides::default()).expect("a recipe");
    recipe.landscape().expect("ground")
}

pub(crate) fn view() -> View {
    let [width, height] = SIZE;
    View { width, height, field_of_view_deg: 50.0, ..View::default() }
}

/// The view without woods.
pub(crate) fn treeless() -> View {
    View { tree_line: Some(-1000.0), ..view() }
}

pub(crate) fn options(samples: u32) -> RenderOptions {
    RenderOptions { size: SIZE, samples }
}

/// A camera so many metres above the ground of a place, looking down by an angle, northward and turned.
pub(crate) fn above(
    scene: &LitScene,
    [east, south]: [f64; 2],
    metres: f32,
    down_deg: f32,
    turn_deg: f32,
) -> Camera {
    let ground = scene.top_at([east, south]).expect("on the land");
    let (down, turn) = (down_deg.to_radians(), turn_deg.to_radians());
    let forward = [down.cos() * turn.sin(), down.cos() * turn.cos(), -down.sin()];
    let eye = [east as f32, -south as f32, ground + metres];
    Camera::looking(eye, forward, scene.camera().half)
}

/// The mountains with water up to a third of their height, which flows eastward.
pub(crate) fn lakes() -> Landscape {
    let mut landscape = mountains();
    let height = landscape.field("height").expect("there").clone();
    let (low, high) = height.range(None).expect("cells");
    let level = low + 0.35 * (high - low);
    let water = height.values().iter().map(|height| (level - height).max(0.0)).collect();
    landscape.insert("water", "m", Field::from_values(height.size(), water));
    landscape.insert("flux_x", "m³/step", Field::filled(height.size(), 2.0));
    landscape.insert("flux_y", "m³/step", Field::filled(height.size(), 0.0));
    landscape
}

/// A gentle meadow, 120 m wide.
pub(crate) fn meadow() -> Landscape {
    meadow_with("relief = 6.0")
}

/// The same on hills of which these keys of `fbm` tell.
pub(crate) fn meadow_with(hills: &str) -> Landscape {
    let constant = |layer: &str, value: f64| {
        format!("[[step]]\ndo = \"constant\"\nheight = {value}\ninto = \"{layer}\"\n")
    };
    let maps: String = [("fertility", 0.8), ("light", 0.7), ("moisture", 0.6)]
        .iter()
        .map(|&(layer, value)| constant(layer, value))
        .collect::<Vec<_>>()
        .concat();
    let text = format!(
        "[landscape]\nsize = 60\ncell = 2.0\nseed = 5\n[[step]]\ndo = \"fbm\"\n{hills}\n{maps}\
         [[step]]\ndo = \"grass\"\nsets = 20.0\n[[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n"
    );
    let recipe = Recipe::parse("meadow.toml", &text, &Overrides::default()).expect("a recipe");
    recipe.landscape().expect("a meadow")
}
