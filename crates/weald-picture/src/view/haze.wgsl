// Twin of `haze.rs`: what lies far away pales into the colour of the horizon.

// Length of the air at the lowest ground that would veil as much, in no longer a way than up to the horizon.
fn haze_column(from_height: f32, rise: f32, ray_length: f32) -> f32 {
    let start = exp(-max(from_height, 0.0) / scene.haze.y);
    let climb = rise * ray_length / scene.haze.y;
    var mean = 1.0 - 0.5 * climb;
    if abs(climb) >= 1e-3 {
        mean = (1.0 - exp(-climb)) / climb;
    }
    return start * mean * min(ray_length, scene.haze.w);
}

// The light that arrives at `eye`, of `radiance` that starts `ray_length` metres along a direction.
fn veil(radiance: vec3<f32>, eye: vec3<f32>, direction: vec3<f32>, ray_length: f32) -> vec3<f32> {
    let depth = scene.haze.x * haze_column(eye.z, direction.z, ray_length);
    let through = exp(-scene.haze_tint.xyz * depth);
    let horizon = sky_radiance(vec3<f32>(direction.xy, 0.0));
    return radiance * through + horizon * (1.0 - through);
}
