// Twin of `tone.rs`: from radiance to the numbers of a picture.

// A radiance, but no more than some times what is drawn as white.
fn limited(radiance: vec3<f32>) -> vec3<f32> {
    return min(radiance, stage.gain.w / stage.gain.xyz);
}

// Linear light on the screen, 0 to 1.
fn tone_curve(radiance: vec3<f32>) -> vec3<f32> {
    let exposed = max(radiance, vec3<f32>(0.0)) * stage.gain.xyz;
    let v = vec3<f32>(
        dot(stage.into_red.xyz, exposed), dot(stage.into_green.xyz, exposed), dot(stage.into_blue.xyz, exposed),
    );
    let film = (v * (v + stage.curve.x) + stage.curve.y)
        / (v * (stage.curve.z * v + stage.curve.w) + stage.curve_last.x);
    let linear = vec3<f32>(
        dot(stage.back_red.xyz, film), dot(stage.back_green.xyz, film), dot(stage.back_blue.xyz, film),
    );
    return clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
}

// sRGB of linear light, dithered by noise that is as wide as two steps of a byte.
fn encoded(linear: vec3<f32>, pixel: vec2<u32>) -> vec3<f32> {
    let dark = 12.92 * linear;
    let light = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    let srgb = select(light, dark, linear <= vec3<f32>(0.0031308));
    let bits = grain_bits(i32(pixel.x), i32(pixel.y), 0x7019u);
    let noise = (f32(bits & 0xffffu) + f32(bits >> 16u)) / 65536.0 - 1.0;
    return srgb + noise / 255.0;
}
