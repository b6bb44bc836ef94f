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

// Radiance of the sun in ripples, over the sunlight.
fn glint(towards_eye: vec3<f32>, normal: vec3<f32>, sun: vec3<f32>) -> f32 {
    let half = normalize(towards_eye + sun);
    let cosine = max(dot(half, normal), 0.05);
    let slope2 = (1.0 - cosine * cosine) / (cosine * cosine);
    let facing = cosine * cosine * cosine * cosine;
    let density = exp(-slope2 / scene.water.y) / (PI * scene.water.y * facing);
    return density * mirrored_share(dot(half, towards_eye)) / (4.0 * max(dot(towards_eye, normal), 0.08));
}

// Light that comes out of water of a depth over a bed, for the light that falls on it.
fn water_body(bed_albedo: vec3<f32>, depth: f32, light: vec3<f32>) -> vec3<f32> {
    let through = exp(-2.0 * scene.water_swallowed.xyz * depth);
    let shallow = 0.7 * bed_albedo * through;
    let deep = scene.water_body.xyz * (1.0 - through);
    return (shallow + deep) * light / PI;
}

// The colour of ground at a water's edge: wet ground is darker.
fn wetted(albedo: vec3<f32>, above: f32) -> vec3<f32> {
    let wet = clamp(1.0 - above / (0.06 * scene.scale.w), 0.0, 1.0);
    return mix(albedo, 0.55 * albedo, wet);
}
