// Twin of `clouds.rs`: one layer of clouds, and its shadows. Where there are none, `CLOUDS` leaves all of it out.

const CLOUDS_APART = 2600.0;
const CLOUDS_THICK = 380.0;
const CLOUDS_LOST = 28000.0;
const CLOUDS_SHADOW = 0.78;
const CLOUDS_SOFT = 160.0;

fn cloud_density(at: vec2<f32>, footprint: f32) -> f32 {
    let noise = octaves_at(Octaves(CLOUDS_APART, 7u, 0.56, 0x71u), at, footprint).value;
    let least = 0.44 - 0.95 * scene.clouds.w;
    return smoothstep(least, least + 0.34, noise);
}

// The radiance of the sky in a direction, with the clouds before it.
fn with_clouds(start: vec3<f32>, direction: vec3<f32>, radiance: vec3<f32>) -> vec3<f32> {
    if !CLOUDS || direction.z < 0.01 || start.z >= scene.cloud_height.x {
        return radiance;
    }
    let reach = (scene.cloud_height.x - start.z) / direction.z;
    let at = start.xy + direction.xy * reach;
    let footprint = 0.002 * reach;
    let density = cloud_density(at, footprint);
    let nearer = at + scene.sun.xy / max(scene.sun.z, 0.3) * CLOUDS_THICK;
    let through = exp(-2.4 * cloud_density(nearer, footprint) * density);
    let towards = max(dot(direction, scene.sun.xyz), 0.0);
    let glow = 0.3 * (1.0 - density) * pow(towards, 12.0);
    let lit = scene.sunlight.xyz * (0.06 + 0.15 * through + glow) + scene.clouds.xyz * ((1.0 - 0.45 * density) / PI);
    return mix(radiance, lit, density * exp(-reach / CLOUDS_LOST));
}

// Share of the sunlight that comes through them to a point.
fn through_clouds(point: vec3<f32>) -> f32 {
    if !CLOUDS {
        return 1.0;
    }
    let reach = max(scene.cloud_height.x - point.z, 0.0) / max(scene.sun.z, 0.05);
    let density = cloud_density(point.xy + scene.sun.xy * reach, CLOUDS_SOFT);
    return select(1.0, 1.0 - CLOUDS_SHADOW * density, scene.clouds.w > 0.0);
}
