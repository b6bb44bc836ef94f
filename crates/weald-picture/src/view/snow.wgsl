// Twin of `snow.rs`: how much snow lies at a point.

const SNOW_SCALE = 0.16;
const SNOW_SUN = 0.8;
const SNOW_WIND = 0.35;
const SNOW_WOODS = vec2<f32>(0.1, 0.6);

struct SnowSpot {
    above: f32,
    slope: f32,
    steepness: f32,
    fall: vec2<f32>,
    hollow: f32,
    noise: vec3<f32>,
    wooded: f32,
}

// Share of the ground that snow hides.
fn snow_share(spot: SnowSpot) -> f32 {
    let open = 1.0 - ramp(spot.wooded, SNOW_WOODS.x, SNOW_WOODS.y);
    let sloping = ramp(spot.slope, 0.1, 0.6);
    let aspect = sloping * (SNOW_SUN * spot.fall.y + SNOW_WIND * spot.fall.x);
    let hold = min(1.3 - spot.steepness, 0.6);
    let score = spot.above / SNOW_SCALE + min(aspect, open * aspect) + 1.6 * hold + 1.3 * open * spot.hollow;
    let whole = ramp(score, -0.2, 2.0);
    let patches = 4.0 * open * whole * (1.0 - whole) * dot(vec3<f32>(0.6, 0.4, 1.4), spot.noise);
    let dusting = 0.25 * open * ramp(score, -0.2, 1.2) * clamp(0.6 + spot.noise.y, 0.0, 1.0);
    return max(ramp(whole + patches, 0.38, 0.62), dusting);
}
