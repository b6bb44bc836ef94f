// Grass as a whole: what of its light gets through to blades and soil, and what it looks like where its blades are too far
// away to be drawn. Its leaf area index and the share of light that goes through are those of `canopy.rs`.

// For each cell the mean colour of leaves, and the leaf area index.
@group(0) @binding(3) var leaves: texture_2d<f32>;

// Least cosine at which leaves are looked through: no ground is so even that one looks through more.
const FLATTEST = 0.12;

// Of the light of the sun on leaves that face all ways, what they send back and let through towards an eye, as a share of
// what they would face to face; leaves stand, and so see half of the sky and each other.
const OF_THE_SUN = 0.42;
const OF_THE_SKY = 0.55;

fn leaves_at(place: vec2<f32>) -> vec4<f32> {
    return textureSampleLevel(leaves, between, share_of(place), 0.0);
}

// Share of light that goes through so many leaves at an angle whose cosine with the upright is so.
fn through_leaves(index: f32, cosine: f32) -> f32 {
    return exp(-0.5 * index / max(cosine, FLATTEST));
}

// Share of the light of the sky that goes through so many leaves.
fn sky_through_leaves(index: f32) -> f32 {
    return exp(-0.7 * index);
}

// Leaves that are drawn as blades at a distance, as a share of all.
fn drawn_as_blades(distance: f32) -> f32 {
    let standing = share(distance);
    return min(standing * broader(standing), 1.0);
}

// Tone of grass that is seen as a whole: tufts and patches, and how they catch the light.
fn tufts(point: vec2<f32>, footprint: f32) -> Grain {
    return octaves_at(Octaves(7.0, 10u, 0.68, 0x3bu), point, footprint);
}

// Share of the tone of tufts that is left for a gaze along the ground, and cosines of the angle to its normal between which that grows to
// all: tops hide the gaps behind them, and a tone that lay flat would be drawn out in streaks.
const TUFTS_STAND = 0.3;
const TUFTS_FROM = vec2<f32>(0.06, 0.45);

fn tufts_seen(cosine: f32) -> f32 {
    return mix(TUFTS_STAND, 1.0, smoothstep(TUFTS_FROM.x, TUFTS_FROM.y, cosine));
}

// The light of grass that is seen as a whole, at an angle to the ground's normal of that cosine.
fn canopy_radiance(colour: vec3<f32>, point: vec3<f32>, normal: vec3<f32>, view: ViewRay, seen: Seen, sun: f32) -> vec3<f32> {
    let shown = tufts_seen(abs(dot(view.direction, normal)));
    let whole = tufts(point.xy, view.footprint);
    let tuft = Grain(shown * whole.value, shown * whole.slope);
    let bumpy = normalize(vec3<f32>(normal.xy - 0.20 * tuft.slope, normal.z));
    // Blades stand up: even where the ground turns away from the sun some of them catch it.
    let facing = 0.3 + 0.7 * max(dot(bumpy, scene.sun.xyz), 0.0);
    let light = scene.sunlight.xyz * (OF_THE_SUN * facing * sun) + OF_THE_SKY * skylight_on(seen, bumpy);
    let dry = 0.5 * octaves_at(Octaves(38.0, 4u, 0.6, 0x3cu), point.xy, view.footprint).value + 0.25 * tuft.value;
    let warm = vec3<f32>(1.0 + 0.5 * dry, 1.0 + 0.15 * dry, 1.0 - 0.25 * dry);
    return colour * warm * max(1.0 + 0.55 * tuft.value, 0.3) * light / PI;
}

// The light of soil with grass on it, of which the light of the soil alone is known as from the sun and from the sky.
fn with_canopy(
    soil_in_sun: vec3<f32>,
    soil_under_sky: vec3<f32>,
    lawn: vec4<f32>,
    point: vec3<f32>,
    normal: vec3<f32>,
    view: ViewRay,
    seen: Seen,
    sun: f32,
) -> vec3<f32> {
    let soil = soil_in_sun * through_leaves(lawn.w, scene.sun.z) + soil_under_sky * sky_through_leaves(lawn.w);
    let undrawn = lawn.w * (1.0 - drawn_as_blades(view.ray_length));
    let bare = through_leaves(undrawn, abs(dot(view.direction, normal)));
    if bare > 0.999 {
        return soil;
    }
    return mix(canopy_radiance(lawn.xyz, point, normal, view, seen, sun), soil, bare);
}

// From where a point is looked at: along a direction, from so far away, with so wide a pixel.
struct ViewRay {
    direction: vec3<f32>,
    ray_length: f32,
    footprint: f32,
}
