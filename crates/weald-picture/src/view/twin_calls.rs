//! What functions of the view give that have a twin in its shaders. A test has a device call the twins with the same numbers.

use super::crags::crags;
use super::crown_relief::crown_height;
use super::drawn_rivers::with_banks;
use super::facets::facing_sun;
use super::fractures::{Face, Fractures, fractures};
use super::rock::{BedSpot, Beds, beds};
use super::slope_grain::on_slope;
use super::snow::{SnowSpot, snow_share};
use super::solid_grain::solid_grain;
use super::turf::turf;
use super::vector::unit;
use super::water::{breaking, ripples, shore, swash, wetted};
use super::woods::{Tree, canopy};
use weald_core::grain::Octaves;

/// Numbers that a call has, and those that it gives.
pub const INPUTS: usize = 12;
pub const OUTPUTS: usize = 4;

/// Calls of a function.
const CALLS: u32 = 4096;

/// A function and its twin.
#[derive(Clone, Debug)]
pub struct Twin {
    /// The name of the twin.
    pub name: &'static str,
    /// What a shader calls it by and gives: a body of statements over the vectors `a`, `b` and `c` of four inputs each, which
    /// returns a `vec4<f32>`.
    pub body: &'static str,
    /// Inputs of each call.
    pub inputs: Vec<[f32; INPUTS]>,
    /// What the function gives.
    pub outputs: Vec<[f32; OUTPUTS]>,
}

impl Twin {
    /// Calls with numbers spread over these ranges; inputs that have none are 0.
    fn of(
        name: &'static str,
        body: &'static str,
        ranges: &[[f32; 2]],
        function: impl Fn([f32; INPUTS]) -> [f32; OUTPUTS],
    ) -> Self {
        let inputs: Vec<_> = (0..CALLS).map(|call| spread(call, ranges)).collect();
        let outputs = inputs.iter().map(|&inputs| function(inputs)).collect();
        Self { name, body, inputs, outputs }
    }
}

/// Numbers of a call that fill their ranges evenly: shares of irrational pace, one of each power of the root of
/// `x^13 = x + 1` (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn spread(call: u32, ranges: &[[f32; 2]]) -> [f32; INPUTS] {
    const ROOT: f64 = 1.057_050_575_221_228;
    let mut pace = 1.0;
    std::array::from_fn(|place| {
        pace /= ROOT;
        let share = (0.5 + pace * f64::from(call + 1)).fract() as f32;
        ranges.get(place).map_or(0.0, |[low, high]| low + share * (high - low))
    })
}

/// Metres east and north of a place, as far as pictures of small landscapes reach.
const EAST: [f32; 2] = [0.0, 2000.0];
const NORTH: [f32; 2] = [-2000.0, 0.0];
const HEIGHT: [f32; 2] = [-50.0, 900.0];
const RISE: [f32; 2] = [-3.0, 3.0];
const SHARE: [f32; 2] = [0.0, 1.0];

/// All of them that need nothing of a scene.
pub fn twins() -> Vec<Twin> {
    [noise(), rock(), plants(), water()].concat()
}

fn noise() -> Vec<Twin> {
    let near = [0.001, 0.2];
    vec![
        Twin::of(
            "octaves_on_slope",
            "let grain = octaves_on_slope(Octaves(0.9, 4u, 0.7, 5u), a.xyz, b.xy, a.w);
             return vec4<f32>(grain.value, grain.slope, 0.0);",
            &[EAST, NORTH, HEIGHT, near, RISE, RISE],
            |[x, y, z, footprint, east, north, ..]| {
                let octaves = Octaves { wavelength: 0.9, count: 4, gain: 0.7, seed: 5 };
                let grain = on_slope(octaves, [x, y, z], [east, north], footprint);
                [grain.value, grain.slope[0], grain.slope[1], 0.0]
            },
        ),
        Twin::of(
            "solid_grain",
            "let grain = solid_grain(a.xyz, 9u); return vec4<f32>(grain.value, grain.slope);",
            &[[-90.0, 90.0]; 3],
            |[x, y, z, ..]| {
                let grain = solid_grain([x, y, z], 9);
                [grain.value, grain.slope[0], grain.slope[1], grain.slope[2]]
            },
        ),
    ]
}

fn rock() -> Vec<Twin> {
    vec![
        Twin::of(
            "crags_at",
            "let crags = crags_at(a.xyz, b.xy, a.w, b.z); return vec4<f32>(crags.height, crags.slope, 0.0);",
            &[EAST, NORTH, HEIGHT, [1.0, 30.0], RISE, RISE, [0.1, 20.0]],
            |[x, y, z, cell, east, north, footprint, ..]| {
                let crags = crags([x, y, z], [east, north], cell, footprint);
                [crags.height, crags.slope[0], crags.slope[1], 0.0]
            },
        ),
        Twin::of(
            "beds_at",
            "let beds = beds_at(BedSpot(a.xyz, a.w, b.x, b.y), b.z > 0.5, 7u);
             return vec4<f32>(beds.tone, beds.joint, beds.ledge, 0.0);",
            &[EAST, NORTH, HEIGHT, [-1.0, 1.0], [2.0, 30.0], [0.02, 8.0], SHARE],
            |[x, y, z, fold, thickness, footprint, dips, ..]| {
                let spot = BedSpot { point: [x, y, z], fold, thickness, footprint };
                let Beds { tone, joint, ledge } = beds(&spot, dips > 0.5, 7);
                [tone, joint, ledge, 0.0]
            },
        ),
        Twin::of(
            "fractures_at",
            "let blocks = fractures_at(Face(a.xy, a.z, normalize(b.xyz), a.w, b.w));
             return vec4<f32>(blocks.tone, blocks.crack, blocks.facet.x, blocks.ledge);",
            &[EAST, NORTH, HEIGHT, [2.0, 30.0], [-1.0, 1.0], [-1.0, 1.0], [0.05, 1.0], [0.02, 8.0]],
            |[x, y, level, thickness, east, north, up, footprint, ..]| {
                let normal = unit([east, north, up]);
                let face = Face { place: [x, y], level, normal, thickness, footprint };
                let Fractures { tone, crack, facet, ledge } = fractures(&face);
                [tone, crack, facet[0], ledge]
            },
        ),
        Twin::of(
            "facing_sun",
            "let at = facing_sun(normalize(a.xyz), normalize(b.xyz), normalize(vec3<f32>(a.w, b.w, 0.5)), c.x);
             return vec4<f32>(at, 0.0, 0.0, 0.0);",
            &[
                [-1.0, 1.0],
                [-1.0, 1.0],
                [0.1, 1.0],
                [-1.0, 1.0],
                [-1.0, 1.0],
                [-1.0, 1.0],
                [0.1, 1.0],
                [-1.0, 1.0],
                [0.0, 3.0],
            ],
            |[a, b, c, east, d, e, f, north, slope, ..]| {
                let [even, facet, sun] = [[a, b, c], [d, e, f], [east, north, 0.5]].map(unit);
                [facing_sun([even, facet, sun], slope), 0.0, 0.0, 0.0]
            },
        ),
        Twin::of(
            "snow_share",
            "return vec4<f32>(snow_share(SnowSpot(a.x, a.y, a.z, b.xy, a.w, c.xyz, b.z)), 0.0, 0.0, 0.0);",
            &[
                [-0.5, 0.5],
                [0.0, 1.5],
                [0.0, 1.8],
                [-0.5, 0.5],
                [-0.7, 0.7],
                [-0.7, 0.7],
                [0.0, 1.0],
                [0.0, 0.0],
                [-0.5, 0.5],
                [-0.5, 0.5],
                [-0.5, 0.5],
            ],
            |[above, slope, steepness, hollow, east, north, wooded, _, broad, fine, gully, _]| {
                let fall = [east, north];
                let noise = [broad, fine, gully];
                let spot = SnowSpot { above, slope, steepness, fall, hollow, noise, wooded };
                [snow_share(&spot), 0.0, 0.0, 0.0]
            },
        ),
    ]
}

fn plants() -> Vec<Twin> {
    vec![
        Twin::of(
            "turf_at",
            "let turf = turf_at(a.xyz, b.xy, a.w, vec3<f32>(0.1, 0.2, 0.05), vec3<f32>(0.25, 0.2, 0.1));
             return vec4<f32>(turf.albedo.xy, turf.slope);",
            &[EAST, NORTH, HEIGHT, [0.001, 0.2], RISE, RISE],
            |[x, y, z, footprint, east, north, ..]| {
                let turf = turf([x, y, z], [east, north], footprint, [[0.1, 0.2, 0.05], [0.25, 0.2, 0.1]]);
                [turf.albedo[0], turf.albedo[1], turf.slope[0], turf.slope[1]]
            },
        ),
        Twin::of(
            "tree_of",
            "let tree = tree_of(vec2<i32>(floor(a.xy))); return vec4<f32>(tree.place, tree.size, tree.turn);",
            &[EAST, NORTH],
            |[x, y, ..]| {
                let tree = Tree::of([x.floor() as i32, y.floor() as i32]);
                [tree.place[0], tree.place[1], tree.size, tree.turn]
            },
        ),
        Twin::of(
            "canopy_of",
            "let wood = canopy_of(a.xy, a.z, a.w, normalize(b.xyz));
             return vec4<f32>(wood.share, wood.share * wood.tone, wood.share * wood.slope.x, wood.open);",
            &[EAST, NORTH, [0.02, 1.0], [0.05, 12.0], [-1.0, 1.0], [-1.0, 1.0], [0.1, 1.0]],
            |[x, y, density, footprint, east, north, up, ..]| {
                let wood = canopy([x, y], density, footprint, unit([east, north, up]));
                // What shares nothing has no looks, and a device does not find them.
                [wood.share, wood.share * wood.tone, wood.share * wood.slope[0], wood.open]
            },
        ),
        Twin::of(
            "crown_height",
            "return vec4<f32>(crown_height(a.xy, a.z, a.w), 0.0, 0.0, 0.0);",
            &[EAST, NORTH, SHARE, [0.05, 30.0]],
            |[x, y, density, footprint, ..]| [crown_height([x, y], density, footprint), 0.0, 0.0, 0.0],
        ),
    ]
}

fn water() -> Vec<Twin> {
    vec![
        Twin::of(
            "ripples",
            "return vec4<f32>(ripples(a.xy, a.z, a.w), breaking(b.x));",
            &[EAST, NORTH, [0.5, 20.0], [0.01, 5.0], [0.0, 0.03]],
            |[x, y, wave, footprint, slope, ..]| {
                let [east, north, up] = ripples([x, y, 0.0], wave, footprint);
                [east, north, up, breaking(slope)]
            },
        ),
        Twin::of(
            "shore",
            "let banks = with_banks(a.w, a.xy, b.x, b.y);
             return vec4<f32>(shore(a.xy, a.z, b.z, b.w, b.y), banks.share, banks.depth, min(banks.above, 9.0));",
            &[EAST, NORTH, [0.0, 0.8], SHARE, [0.5, 10.0], [0.01, 3.0], [0.005, 0.3], [0.5, 12.0]],
            |[x, y, depth, mapped, pixel, footprint, slope, width, ..]| {
                let point = [x, y, 0.0];
                let banks = with_banks(mapped, point, [pixel, footprint]);
                let share = shore(point, depth, slope, [width, footprint]);
                [share, banks.share, banks.depth, banks.above.min(9.0)]
            },
        ),
        Twin::of(
            "swash",
            "return vec4<f32>(swash(a.xy, a.z, a.w, b.x, b.y), wetted(c.xyz, b.z, b.w));",
            &[
                EAST,
                NORTH,
                [0.0, 12.0],
                [0.5, 12.0],
                [0.0, 30.0],
                [0.01, 5.0],
                [0.0, 2.0],
                [0.1, 2.0],
                SHARE,
                SHARE,
                SHARE,
            ],
            |[x, y, away, width, seconds, footprint, above, reach, red, green, blue, _]| {
                let foam = swash([x, y, 0.0], away, width, [seconds, footprint]);
                let [red, green, blue] = wetted([red, green, blue], above, reach);
                [foam, red, green, blue]
            },
        ),
    ]
}
