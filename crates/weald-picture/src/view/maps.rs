//! The fields of a scene, as textures that shaders see under the same names.

use super::drawn_rivers::Rivers;
use super::flow::Flow;
use super::lit_scene::LitScene;
use super::side::Strata;
use super::skylight::Skylight;
use super::surface::Surface;
use weald_core::material::MAX_MATERIALS;

/// How the numbers of a map are kept, and looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureKind {
    /// Control points of a surface, 32 bits each, loaded one by one.
    Exact,
    /// Four numbers of 16 bits, mixed between the centres of cells.
    Smooth,
    /// A share from 0 to 1 in eight bits, mixed as well.
    Share,
}

impl TextureKind {
    /// Numbers that a texel holds.
    pub fn channels(self) -> usize {
        match self {
            Self::Exact | Self::Share => 1,
            Self::Smooth => 4,
        }
    }
}

/// A map.
#[derive(Clone, Debug)]
pub struct SceneTexture {
    /// Its name in shaders.
    pub name: &'static str,
    /// How it is kept.
    pub kind: TextureKind,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Layers, one behind the other; more than one, or an array by its nature.
    pub layers: usize,
    /// All numbers: layer by layer, row by row, channel by channel.
    pub values: Vec<f32>,
}

/// Declared once: names and kinds, and whether a map is an array of layers.
const MAPS: [(&str, TextureKind, bool); 11] = [
    ("top", TextureKind::Exact, false),
    ("bed", TextureKind::Exact, false),
    ("level", TextureKind::Exact, false),
    ("land", TextureKind::Exact, false),
    ("site", TextureKind::Smooth, false),
    ("materials", TextureKind::Smooth, false),
    ("skylight", TextureKind::Smooth, true),
    ("plain_light", TextureKind::Smooth, true),
    ("strata", TextureKind::Smooth, true),
    ("rivers", TextureKind::Share, false),
    ("flow", TextureKind::Smooth, false),
];

/// Channel of the strata that no material above the bedrock needs.
const FLOOR: usize = MAX_MATERIALS - 1;

/// Layers in which the light of the sky is kept: twelve numbers by four.
const SKYLIGHT_LAYERS: usize = 3;

impl LitScene {
    /// Names, kinds, and whether they are arrays, of the maps in the order of [`LitScene::textures`].
    pub fn texture_kinds() -> impl Iterator<Item = (&'static str, TextureKind, bool)> {
        MAPS.into_iter()
    }

    /// All maps. What a landscape does not have is a single zero.
    pub fn textures(&self) -> Vec<SceneTexture> {
        let terrain = &self.setting.terrain;
        let sites = &self.cover.sites;
        let materials = sites.materials.as_ref().map(|channels| channels.each_ref().map(Some));
        let [red, green, blue] = materials.unwrap_or_default();
        let values = [
            exact(Some(&terrain.top)),
            exact(Some(&self.setting.bed)),
            exact(self.setting.level.as_ref()),
            exact(terrain.land.as_ref()),
            smooth([Some(&sites.moisture), Some(&sites.soil), None, Some(&sites.fallen)]),
            smooth([red, green, blue, None]),
            of_sky(&self.skylight),
            of_sky(&self.plain_light),
            of_strata(&self.setting.strata),
            of_rivers(self.setting.rivers.as_ref()),
            of_flow(self.setting.flow.as_ref()),
        ];
        let named = MAPS.into_iter().zip(values).map(|((name, kind, is_array), (size, values))| {
            let layers = if is_array { values.len() / (size[0] * size[1] * kind.channels()) } else { 1 };
            SceneTexture { name, kind, size, layers, values }
        });
        named.collect()
    }
}

/// Columns and rows, and all numbers.
type Values = ([usize; 2], Vec<f32>);

fn exact(surface: Option<&Surface>) -> Values {
    surface.map_or(([1, 1], vec![0.0]), |surface| (surface.controls(), surface.control.clone()))
}

/// Up to four surfaces of one size in one map of their control points.
fn smooth(channels: [Option<&Surface>; 4]) -> Values {
    let Some(first) = channels.iter().flatten().next() else { return ([1, 1], vec![0.0; 4]) };
    let points = 0..first.control.len();
    let of = |point: usize| channels.map(|surface| surface.map_or(0.0, |surface| surface.control[point]));
    (first.controls(), points.flat_map(of).collect())
}

/// The light of the sky, red, green, blue and even, in three layers of four.
fn of_sky(light: &Skylight) -> Values {
    let layer = |layer: usize| {
        light.seen.iter().flat_map(move |seen| {
            let numbers = seen.as_flattened();
            [0, 1, 2, 3].map(|channel| numbers[4 * layer + channel])
        })
    };
    ([light.size.columns, light.size.rows], (0..SKYLIGHT_LAYERS).flat_map(layer).collect())
}

/// Thickness of the materials above the bedrock, lowest first, in two layers of four, of which the last is the height of the bedrock.
fn of_strata(strata: &Strata) -> Values {
    let mut values = Vec::new();
    let mut size = [1, 1];
    for layer in 0..MAX_MATERIALS.div_ceil(4) {
        let channel = |channel: usize| match 4 * layer + channel {
            FLOOR => strata.floor.as_ref(),
            material => strata.materials.get(material).map(|(thickness, _)| thickness),
        };
        let first = smooth([0, 1, 2, 3].map(channel));
        if layer == 0 {
            size = first.0;
        }
        values.extend(if first.0 == size { first.1 } else { vec![0.0; 4 * size[0] * size[1]] });
    }
    (size, values)
}

fn of_flow(flow: Option<&Flow>) -> Values {
    let [east, north] = flow.map(|flow| flow.velocity.each_ref().map(Some)).unwrap_or_default();
    smooth([east, north, flow.map(|flow| &flow.lost), None])
}

fn of_rivers(rivers: Option<&Rivers>) -> Values {
    let Some(rivers) = rivers else { return ([1, 1], vec![0.0]) };
    let rows = (0..rivers.height).flat_map(|row| rivers.strokes.row(row));
    ([rivers.width, rivers.height], rows.copied().collect())
}
