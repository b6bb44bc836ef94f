//! The shaders of a scene: the uniforms and textures of it that they see, and the twins of its functions.

use std::fmt::Write;

use super::lit_scene::LitScene;
use super::maps::TextureKind;

/// The twins of place, light and air, each after those that it calls.
const LIGHT: [&str; 9] = [
    include_str!("surface.wgsl"),
    weald_core::grain::SHADER,
    include_str!("solid_grain.wgsl"),
    include_str!("sky.wgsl"),
    include_str!("clouds.wgsl"),
    include_str!("clouds/mirrored.wgsl"),
    include_str!("haze.wgsl"),
    include_str!("tone.wgsl"),
    include_str!("skylight.wgsl"),
];

/// Those of ground and water, which call them.
const GROUND: [&str; 15] = [
    include_str!("crags.wgsl"),
    include_str!("rock.wgsl"),
    include_str!("fractures.wgsl"),
    include_str!("snow.wgsl"),
    include_str!("woods.wgsl"),
    include_str!("crown_relief.wgsl"),
    include_str!("slope_grain.wgsl"),
    include_str!("turf.wgsl"),
    include_str!("cover.wgsl"),
    include_str!("materials.wgsl"),
    include_str!("water.wgsl"),
    include_str!("side.wgsl"),
    include_str!("scene.wgsl"),
    include_str!("surroundings.wgsl"),
    include_str!("trees.wgsl"),
];

impl LitScene {
    /// What a shader that draws the scene begins with: its uniforms at binding 0 of a group, a sampler `between` at 1,
    /// the textures of [`LitScene::texture_kinds`] from 2 on, and the functions of the view.
    pub fn shader(&self, group: u32) -> String {
        GROUND.iter().fold(self.shader_of_light(group), |text, twin| text + "\n" + twin)
    }

    /// The same with the functions of place, light and air alone, for what stands on the ground.
    pub fn shader_of_light(&self, group: u32) -> String {
        let mut text = self.declaration();
        let _ = writeln!(text, "@group({group}) @binding(0) var<uniform> scene: LitScene;");
        let _ = writeln!(text, "@group({group}) @binding(1) var between: sampler;");
        for (binding, (name, kind, is_array)) in (2..).zip(Self::texture_kinds()) {
            let shape = if is_array { "texture_2d_array<f32>" } else { "texture_2d<f32>" };
            debug_assert!(!is_array || kind == TextureKind::Smooth, "{name}: only smooth maps have layers");
            let _ = writeln!(text, "@group({group}) @binding({binding}) var {name}: {shape};");
        }
        LIGHT.iter().fold(text, |text, twin| text + "\n" + twin)
    }
}
