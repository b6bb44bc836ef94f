// Twin of `water.rs`: how water looks from any side.

// The normal of rippled water at a point, for a pixel of that footprint; waves are `length` metres long.
fn ripples(point: vec2<f32>, wave: f32, footprint: f32) -> vec3<f32> {
    let calm = octaves_at(Octaves(30.0 * wave, 2u, 0.5, 0x51u), point, 0.0).value;
    let waves = octaves_at(Octaves(wave, 3u, 0.55, 0x52u), point, footprint);
    let strength = 0.035 * wave * (1.0 + 0.9 * calm);
    return normalize(vec3<f32>(-strength * waves.slope, 1.0));
}

// Share of light that is mirrored where a ray meets the surface at an angle of that cosine.
fn mirrored_share(cosine: f32) -> f32 {
    let grazing = 1.0 - clamp(cosine, 0.0, 1.0);
    let square = grazing * grazing;
    let fresnel = scene.water.x + (1.0 - scene.water.x) * square * square * grazing;
    return fresnel / (1.0 + 9.0 * sqrt(scene.water.y) * square * square);
}

// The direction of the sky that ripples too small to be seen mirror, in place of that which even water would.
fn rippled_upward(direction: vec3<f32>) -> vec3<f32> {
    return normalize(vec3<f32>(direction.xy, max(direction.z, 0.5 * direction.z + 0.12)));
}

// Radiance of the sun in ripples, over the sunlight.
fn glint(towards_eye: vec3<f32>, normal: vec3<f32>, sun: vec3<f32>) -> f32 {
    let half = normalize(towards_eye + sun);
    let cosine = max(dot(half, normal), 0.05);
    let slope2 = (1.0 - cosine * cosine) / (cosine * cosine);
    let facing = cosine * cosine * cosine * cosine;
    let density = exp(-slope2 / scene.water.y) / (PI * scene.water.y * facing);
    return density * mirrored_share(dot(half, towards_eye)) / (4.0 * max(dot(towards_eye, normal), 0.08));
}

// How much more turbid lakes and rivers are than the sea, whose beaches are higher.
const TURBID = 3.0;
const BEACH = vec2<f32>(0.1, 3.0);

fn turbidity(level: f32) -> f32 {
    return select(TURBID, 1.0, abs(level - scene.swash.z) < 0.5);
}

// Height above the water, in metres, up to which waves throw sand and stones at a level.
fn beach_height(level: f32) -> f32 {
    return select(BEACH.x, BEACH.y, abs(level - scene.swash.z) < 0.5);
}

// Light that comes out of water of a depth over a bed, so much more turbid than the sea, for the light that falls on it.
fn water_body(bed_albedo: vec3<f32>, depth: f32, turbid: f32, light: vec3<f32>) -> vec3<f32> {
    let through = exp(-2.0 * scene.water_swallowed.xyz * turbid * depth);
    let shallow = 0.7 * bed_albedo * through;
    let deep = scene.water_body.xyz * (1.5 / (0.5 + turbid)) * (1.0 - through);
    return (shallow + deep) * light / PI;
}

// Share of the light that gravel sends back dry which it sends back wet.
const BED_WET = 0.45;

// The bed below water of a depth: sand, stones, and what grows on it in patches, blurred by the ripples above.
fn bed_albedo(point: vec2<f32>, depth: f32, footprint: f32) -> vec3<f32> {
    let blurred = footprint + 0.05 * depth;
    let patches = octaves_at(Octaves(9.0, 7u, 0.66, 0x5bu), point, blurred).value;
    let grains = octaves_at(Octaves(0.55, 5u, 0.72, 0x5cu), point, blurred).value;
    let tone = 1.0 + 0.35 * patches + 0.9 * grains;
    let grown = 0.8 * ramp(patches + 0.3 * grains + 0.1 * min(depth, 5.0), 0.22, 0.36);
    return mix(scene.gravel.xyz * (BED_WET * max(tone, 0.2)), scene.weed.xyz, grown);
}

const RIVER_SHARPEST = 0.05;
const RIVER_BANK = 0.3;
const BANK_RAGGED = 0.35;
const BANK_LENGTH = 1.6;
const BANK_HEIGHT = 3.0;
const BANK_RISE = 3.0;
const STONES_STAND = vec2<f32>(0.07, 0.03);
const STONES_LENGTH = vec2<f32>(2.0, 1.2);

// Metres of water in the middle of a river that is drawn as a line.
const RIVER_DEPTH = 1.2;

// What a river that is drawn as a line is at a place: share of water, depth, and height of the ground above it.
struct RiverSpot {
    share: f32,
    depth: f32,
    above: f32,
}

// The river where the map, whose pixels are so many metres wide, says such a share, for a pixel of that footprint.
fn with_banks(mapped: f32, point: vec2<f32>, pixel: f32, footprint: f32) -> RiverSpot {
    if mapped <= 0.0 {
        return RiverSpot(0.0, 0.0, 1e9);
    }
    let ragged = octaves_at(Octaves(BANK_LENGTH * pixel, 6u, 0.6, 0x66u), point, footprint).value;
    let share = clamp(mapped + BANK_RAGGED * 4.0 * mapped * (1.0 - mapped) * ragged, 0.0, 1.0);
    let softness = clamp(footprint / pixel, RIVER_SHARPEST, 1.0);
    let bank = mix(RIVER_BANK, 0.5, (softness - RIVER_SHARPEST) / (1.0 - RIVER_SHARPEST));
    let out = clamp(BANK_RISE * (1.0 - share / bank), 0.0, 1.0);
    return RiverSpot(clamp((share - bank) / softness + 0.5, 0.0, 1.0), RIVER_DEPTH * share, BANK_HEIGHT * out * out);
}

// Share of water at a point of a lake or the sea of a depth, whose bed rises so and whose waves run up a width.
fn shore(point: vec2<f32>, depth: f32, slope: f32, width: f32, footprint: f32) -> f32 {
    let stands = STONES_STAND.x + STONES_STAND.y * width;
    if depth > stands {
        return 1.0;
    }
    let wavelength = STONES_LENGTH.x + STONES_LENGTH.y * width;
    let stones = octaves_at(Octaves(wavelength, 7u, 0.62, 0x67u), point, footprint).value;
    let over = depth - stands * clamp(0.3 + stones, 0.0, 0.9);
    return clamp(over / max(footprint * slope, 0.004) + 0.5, 0.0, 1.0);
}

// Share of the waves' foam over a bed of a slope: over flats they have broken far out.
fn breaking(slope: f32) -> f32 {
    return ramp(slope, 0.004, 0.02);
}

// How far waves run up and down a shore in metres: at a lake, and at the sea.
fn swash_width(level: f32) -> f32 {
    return select(scene.swash.x, scene.swash.y, abs(level - scene.swash.z) < 0.5);
}

// Share of foam on water at so many metres from its edge, where waves run up and down over a width.
fn swash(point: vec2<f32>, away: f32, width: f32, seconds: f32, footprint: f32) -> f32 {
    let seen = 1.0 - ramp(footprint / width, 0.5, 2.0);
    let along = octaves_at(Octaves(6.0 * width, 2u, 0.5, 0x5du), point, 0.0).value;
    let lace = octaves_at(Octaves(0.2 * width, 4u, 0.65, 0x5eu), point, footprint).value;
    let stretch = octaves_at(Octaves(35.0 * width, 2u, 0.6, 0x5fu), point, 0.0).value;
    let open = ramp(stretch, -0.2, 0.4);
    let strength = clamp(0.25 * width, 0.0, 1.0) * (0.2 + 0.8 * open);
    let turn = seconds / (2.0 * sqrt(width) + 2.0) + 1.5 * along;
    let front = 0.42 + 0.36 * sin(2.0 * PI * turn) + 0.12 * lace;
    let behind = front - away / (width * (0.35 + 0.65 * open));
    let line = exp(-90.0 * behind * behind) * (0.6 + 0.9 * lace);
    let left = ramp(behind, 0.0, 0.1) * ramp(lace, 0.05, 0.35);
    return seen * strength * clamp(line + 0.6 * left, 0.0, 0.9);
}

// The colour of ground at a water's edge: where waves reach, to a height that is drawn so, wet ground is darker.
fn wetted(albedo: vec3<f32>, above: f32, reach: f32) -> vec3<f32> {
    return mix(albedo, 0.5 * albedo, 1.0 - ramp(above / reach, 0.25, 1.0));
}

// Height above the water, drawn, up to which ground of a slope is wet.
fn wet_reach(width: f32, slope: f32) -> f32 {
    return clamp(1.3 * width * slope, 0.008 * scene.scale.w, 0.06 * scene.scale.w);
}
