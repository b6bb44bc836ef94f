//! The uniforms of a scene, as shaders see them: one list gives the struct's text and its bytes, so neither can
//! disagree with the other, and no constant of the view is written a second time.

use std::fmt::Write;

use super::border::DIRECTIONS;
use super::ground_kinds::Palette;
use super::haze::{self, Haze};
use super::lit_scene::{CUT_WATER, LitScene};
use super::side::NORMALS;
use super::sky::PIECES;
use super::surroundings::{BEND, JOIN, LEFT_OUT, LOST, REACH, TURN, TURNED_TO};
use super::tone::{self, Tone};
use super::vector::Vector;
use super::water;
use crate::colour::linear_of_hex;
use weald_core::material::MAX_MATERIALS;

/// Bytes of a vector of four.
const BYTES: usize = 16;

/// A limit of heights that is never reached, in place of infinity, which shaders may not know.
const UNREACHABLE_HEIGHT: f32 = 1e30;

/// Vectors of four with their names, in the order of the struct.
type Named = Vec<(&'static str, [f32; 4])>;

/// Vectors in the tables behind the named numbers: three for each piece of the sky, one for each side's normal.
const SKY_TABLE: usize = 3 * (PIECES + 1);

impl LitScene {
    /// The numbers of the scene, laid out as `LitScene::declaration` says.
    pub fn uniforms(&self) -> Vec<u8> {
        let named = self.named().into_iter().map(|(_, values)| values);
        let sky = self.sky.table.iter().flat_map(|part| [part.rayleigh, part.mie, part.multiple]);
        let colours = self.setting.strata.materials.iter().map(|&(_, colour)| colour);
        let colours = colours.chain(std::iter::repeat([0.0; 3])).take(MAX_MATERIALS);
        let far = self.setting.around.as_ref().map_or([[0.0; 2]; DIRECTIONS], |around| around.far);
        let far = far.map(|[height, uneven]| [height, uneven, 0.0]);
        let tables = sky.chain(self.sides.light).chain(colours).chain(far).map(|rgb| with(rgb, 0.0));
        let mut bytes = Vec::with_capacity(BYTES * (SKY_TABLE + 120));
        for vector in named.chain(tables) {
            bytes.extend(vector.into_iter().flat_map(f32::to_le_bytes));
        }
        bytes
    }

    /// The struct of [`LitScene::numbers`] in WGSL.
    pub(super) fn declaration(&self) -> String {
        let named = self.named();
        let fields = named.iter().fold(String::new(), |mut fields, (name, _)| {
            let _ = writeln!(fields, "    {name}: vec4<f32>,");
            fields
        });
        format!(
            "const SKY_PIECES = {PIECES};\nconst SIDE_NORMALS = {NORMALS};\nconst FAR_DIRECTIONS = {DIRECTIONS};\nconst CLOUDS = {};\n\
             struct LitScene {{\n{fields}    \
             sky_table: array<vec4<f32>, {SKY_TABLE}>,\n    side_light: array<vec4<f32>, {NORMALS}>,\n    \
             strata_colours: array<vec4<f32>, {MAX_MATERIALS}>,\n    far_ground: array<vec4<f32>, {DIRECTIONS}>,\n}}\n",
            self.clouds.is_some()
        )
    }

    fn named(&self) -> Named {
        let mut named = self.of_light();
        named.extend(self.of_ground());
        named.extend(of_palette(self.cover.palette()));
        named.extend(of_tone(&self.tone));
        named
    }

    fn of_light(&self) -> Named {
        let Haze { extinction, scale_height, reach } = self.haze;
        let [x, y] = water::OPTICS;
        let clouds = self.clouds.as_ref();
        vec![
            ("sun", with(self.sky.sun, self.sky.sun_radius)),
            ("sunlight", with(self.sky.sunlight, 0.0)),
            ("bounce", with(self.bounce, 0.0)),
            ("plain", with(self.plain, self.setting.terrain.base)),
            ("open_red", with(self.open[0], 0.0)),
            ("open_green", with(self.open[1], 0.0)),
            ("open_blue", with(self.open[2], 0.0)),
            ("open_even", with(self.open[3], 0.0)),
            ("haze", [extinction, scale_height, self.plain_reach(), reach.min(UNREACHABLE_HEIGHT)]),
            ("haze_tint", with(haze::TINT, 0.0)),
            ("water", [x, y, 0.0, 0.0]),
            (
                "clouds",
                with(
                    clouds.map_or([0.0; 3], |clouds| clouds.skylight),
                    clouds.map_or(0.0, |clouds| clouds.share),
                ),
            ),
            ("cloud_height", [clouds.map_or(0.0, |clouds| clouds.height), 0.0, 0.0, 0.0]),
            ("water_body", with(water::BODY, 0.0)),
            ("weed", with(water::WEED, water::FOAM)),
            ("swash", [water::SWASH[0], water::SWASH[1], self.sea().unwrap_or(-UNREACHABLE_HEIGHT), 0.0]),
            ("water_swallowed", with(water::ABSORPTION, 0.0)),
            ("cut_water", with(linear_of_hex(CUT_WATER), 0.0)),
        ]
    }

    fn of_ground(&self) -> Named {
        let (setting, terrain) = (&self.setting, &self.setting.terrain);
        let (size, limits, strata) = (terrain.top.size(), &setting.limits, &setting.strata);
        let flag = f32::from;
        vec![
            ("grid", [size.columns as f32, size.rows as f32, terrain.spacing[0], terrain.spacing[1]]),
            ("limits", [limits.rock, limits.trees, limits.snow.min(UNREACHABLE_HEIGHT), limits.relief]),
            ("woods", [limits.woods, 0.0, 0.0, 0.0]),
            ("scale", [limits.cell, setting.exaggeration, terrain.highest(), terrain.cell()]),
            (
                "has",
                [
                    flag(setting.level.is_some()),
                    flag(terrain.land.is_some()),
                    flag(self.cover.sites.shows_materials()) + flag(self.cover.sites.is_draped()),
                    flag(setting.rivers.is_some()),
                ],
            ),
            ("strata", [strata.bed, strata.soil_thickness, strata.materials.len() as f32, 0.0]),
            ("strata_bedrock", with(strata.bedrock, 0.0)),
            ("strata_soil", with(strata.soil, 0.0)),
            ("around", self.of_surroundings()),
            ("far_highest", [setting.around.as_ref().map_or(1.0, |around| around.highest), 0.0, 0.0, 0.0]),
            ("turned", [TURN[0], TURN[1], TURNED_TO[0], TURNED_TO[1]]),
            ("bend", [BEND[0], BEND[1], LEFT_OUT, REACH]),
        ]
    }
}

impl LitScene {
    /// Where the ground beyond the border is lost in the haze, the height of the sea, where the border is left behind, and
    /// the mean ground.
    fn of_surroundings(&self) -> [f32; 4] {
        let around = self.setting.around.as_ref();
        let sea = self.sea().unwrap_or(-UNREACHABLE_HEIGHT);
        [LOST, sea, JOIN, around.map_or(0.0, |around| around.mean)]
    }
}

fn of_palette(palette: &Palette) -> Named {
    vec![
        ("lush", with(palette.lush, 0.0)),
        ("meadow", with(palette.meadow, 0.0)),
        ("dry", with(palette.dry, 0.0)),
        ("alpine", with(palette.alpine, 0.0)),
        ("forest_dark", with(palette.forest[0], 0.0)),
        ("forest_light", with(palette.forest[1], 0.0)),
        ("rock_grey", with(palette.rock[0], 0.0)),
        ("rock_dark", with(palette.rock[1], 0.0)),
        ("rock_warm", with(palette.rock[2], 0.0)),
        ("scree", with(palette.scree, 0.0)),
        ("gravel", with(palette.gravel, 0.0)),
        ("snow", with(palette.snow, 0.0)),
    ]
}

fn of_tone(tone: &Tone) -> Named {
    let [a, b, c, d, e] = tone::CURVE;
    let mut named = vec![("gain", with(tone.gain(), tone::BRIGHTEST)), ("curve", [a, b, c, d])];
    named.push(("curve_last", [e, 0.0, 0.0, 0.0]));
    let names = ["into_red", "into_green", "into_blue", "back_red", "back_green", "back_blue"];
    let rows = tone::INTO.into_iter().chain(tone::BACK);
    named.extend(names.into_iter().zip(rows.map(|row| with(row, 0.0))));
    named
}

fn with([x, y, z]: Vector, w: f32) -> [f32; 4] {
    [x, y, z, w]
}
