// Twin of `solid_grain.rs`: noise in space and its slope.

struct SolidGrain {
    value: f32,
    slope: vec3<f32>,
}

fn solid_gradient(at: vec3<i32>, seed: u32) -> vec3<f32> {
    let hash = grain_bits(at.x, at.y, seed ^ (bitcast<u32>(at.z) * 0x85ebca6bu));
    return vec3<f32>(f32(hash & 0xffu), f32((hash >> 8u) & 0xffu), f32((hash >> 16u) & 0xffu)) * (1.0 / 127.5) - 1.0;
}

// Noise in space at a place that is counted in wavelengths.
fn solid_grain(place: vec3<f32>, seed: u32) -> SolidGrain {
    let corner = floor(place);
    let t = place - corner;
    let ease = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let ease_slope = 30.0 * t * t * (t * (t - 2.0) + 1.0);
    var sum = SolidGrain(0.0, vec3<f32>(0.0));
    var at = 0;
    loop {
        let side = vec3<i32>(at & 1, (at >> 1u) & 1, at >> 2u);
        let gradient = solid_gradient(vec3<i32>(corner) + side, seed);
        let far = vec3<f32>(side);
        let near = mix(1.0 - ease, ease, far);
        let nearer = ease_slope * (2.0 * far - 1.0);
        let plane = dot(gradient, t - far);
        let weight = near.x * near.y * near.z;
        sum.value += weight * plane;
        sum.slope += weight * gradient + nearer * near.yzx * near.zxy * plane;
        at++;
        if at >= 8 {
            break;
        }
    }
    return sum;
}
