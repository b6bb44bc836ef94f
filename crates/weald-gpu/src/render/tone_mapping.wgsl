// From light to the numbers of a picture.

@group(0) @binding(0) var light: texture_2d<f32>;

@vertex
fn tone_mapping_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn tone_mapping_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(position.xy);
    let radiance = textureLoad(light, pixel, 0).xyz;
    return vec4<f32>(encoded(tone_curve(radiance), pixel), 1.0);
}
