// Twin of `turf.rs`: short grass as it looks from so near that its tufts are seen.

const TURF_TUFTS = 0.24;
const TURF_OCTAVES = 6u;
const TURF_GAIN = 0.95;
const TURF_SEED = 0x15u;
const TURF_SHADE = 0.7;
const TURF_LIGHT = vec2<f32>(0.4, 1.7);
const TURF_WITHERED = vec2<f32>(0.2, 0.8);
const TURF_MOST_WITHERED = 0.55;
const TURF_HIGH = 0.008;

struct Turf {
    albedo: vec3<f32>,
    slope: vec2<f32>,
}

// Turf of a mean colour, and one of withered grass, on ground that rises so.
fn turf_at(point: vec3<f32>, rise: vec2<f32>, footprint: f32, mean: vec3<f32>, withered: vec3<f32>) -> Turf {
    let noise = octaves_on_slope(Octaves(TURF_TUFTS, TURF_OCTAVES, TURF_GAIN, TURF_SEED), point, rise, footprint);
    let light = clamp(1.0 + TURF_SHADE * noise.value, TURF_LIGHT.x, TURF_LIGHT.y);
    let share = TURF_MOST_WITHERED * ramp(noise.value, TURF_WITHERED.x, TURF_WITHERED.y);
    return Turf(light * mix(mean, withered, share), TURF_HIGH * noise.slope);
}
