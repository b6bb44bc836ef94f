// Twin of `haze.rs`: what lies far away pales into the colour of the horizon.

// Scale heights above which there is no haze to speak of.
const HAZE_HEIGHTS = 6.0;

// -ln 0.02: what is left of the contrast at the visibility; and metres through which one sees at least in the haze before the
// sky.
const CONTRAST = 3.912;
const HAZE_ABOVE = 80000.0;

// By how much the haze before ground beyond the horizon grows with the logarithm of its distance.
const HAZE_BEYOND = 0.5;

// Length of the air at the lowest ground that would veil as much; beyond the horizon it grows with its logarithm.
fn haze_column(from_height: f32, rise: f32, ray_length: f32) -> f32 {
    let start = exp(-max(from_height, 0.0) / scene.haze.y);
    let climb = rise * ray_length / scene.haze.y;
    var mean = 1.0 - 0.5 * climb;
    if abs(climb) >= 1e-3 {
        mean = (1.0 - exp(-climb)) / climb;
    }
    let beyond = max(ray_length / scene.haze.w, 1.0);
    return start * mean * min(ray_length, scene.haze.w) * (1.0 + HAZE_BEYOND * log(beyond));
}

// The light that arrives at `eye`, of `radiance` that starts `ray_length` metres along a direction.
fn veil(radiance: vec3<f32>, eye: vec3<f32>, direction: vec3<f32>, ray_length: f32) -> vec3<f32> {
    return veiled(radiance, direction, scene.haze.x * haze_column(eye.z, direction.z, ray_length));
}

// The light along a direction that has such an optical depth of haze before it.
fn veiled(radiance: vec3<f32>, direction: vec3<f32>, depth: f32) -> vec3<f32> {
    let through = exp(-scene.haze_tint.xyz * depth);
    let horizon = sky_radiance(vec3<f32>(direction.xy, 0.0));
    return radiance * through + horizon * (1.0 - through);
}

// The light that arrives at `eye` along a direction into the open sky, of `radiance` beyond the haze.
fn veil_before_sky(radiance: vec3<f32>, eye: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let rise = max(direction.z, LOWEST);
    let column = haze_column(eye.z, rise, HAZE_HEIGHTS * scene.haze.y / rise);
    return veiled(radiance, direction, min(scene.haze.x, CONTRAST / HAZE_ABOVE) * column);
}
