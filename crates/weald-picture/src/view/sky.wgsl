// Twin of `sky.rs`: the sky as seen from the ground.

const PI = 3.14159265358979;

// How strongly haze scatters forward: the glow around the sun.
const FORWARD = 0.76;

// Sine of the elevation below which the sky is all alike.
const LOWEST = 0.006;

fn rayleigh_phase(cosine: f32) -> f32 {
    return 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
}

fn mie_phase(cosine: f32) -> f32 {
    let g2 = FORWARD * FORWARD;
    let spread = max(1.0 + g2 - 2.0 * FORWARD * cosine, 1e-4);
    let factor = 3.0 / (8.0 * PI) * (1.0 - g2) / (2.0 + g2);
    return factor * (1.0 + cosine * cosine) / (spread * sqrt(spread));
}

// Radiance of a direction without the sun's disc; below the horizon that of the horizon.
fn sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    let place = sqrt(clamp(direction.z, LOWEST, 1.0)) * f32(SKY_PIECES);
    let piece = min(i32(place), SKY_PIECES - 1);
    let share = place - f32(piece);
    let cosine = dot(direction, scene.sun.xyz);
    let rayleigh = mix(scene.sky_table[3 * piece], scene.sky_table[3 * piece + 3], share).xyz;
    let mie = mix(scene.sky_table[3 * piece + 1], scene.sky_table[3 * piece + 4], share).xyz;
    let multiple = mix(scene.sky_table[3 * piece + 2], scene.sky_table[3 * piece + 5], share).xyz;
    return rayleigh * rayleigh_phase(cosine) + mie * mie_phase(cosine) + multiple;
}

// The same with the sun's disc, which darkens to its limb.
fn sky_radiance_with_sun(direction: vec3<f32>) -> vec3<f32> {
    let radiance = sky_radiance(direction);
    let radius = scene.sun.w;
    // 1 - cos of the angle from the middle, without its loss of digits.
    let aside = direction - scene.sun.xyz;
    let outside = 0.5 * dot(aside, aside) / (1.0 - cos(radius));
    if outside >= 1.0 || direction.z <= 0.0 {
        return radiance;
    }
    let limb = 0.4 + 0.6 * sqrt(1.0 - outside);
    return radiance + scene.sunlight.xyz * (limb / (PI * radius * radius));
}
