// Twin of `tone.rs`: from radiance to the numbers of a picture.

// A radiance, but no more than some times what is drawn as white.
fn limited(radiance: vec3<f32>) -> vec3<f32> {
    return min(radiance, scene.gain.w / scene.gain.xyz);
}

// Linear light on the screen, 0 to 1.
fn tone_curve(radiance: vec3<f32>) -> vec3<f32> {
    let exposed = max(radiance, vec3<f32>(0.0)) * scene.gain.xyz;
    let v = vec3<f32>(
        dot(scene.into_red.xyz, exposed), dot(scene.into_green.xyz, exposed), dot(scene.into_blue.xyz, exposed),
    );
    let film = (v * (v + scene.curve.x) + scene.curve.y)
        / (v * (scene.curve.z * v + scene.curve.w) + scene.curve_last.x);
    let linear = vec3<f32>(
        dot(scene.back_red.xyz, film), dot(scene.back_green.xyz, film), dot(scene.back_blue.xyz, film),
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
