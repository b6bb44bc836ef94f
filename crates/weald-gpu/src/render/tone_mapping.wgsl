// From light to the numbers of a picture.

@group(2) @binding(0) var light: texture_2d<f32>;

struct WholePicture {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) adapted: f32,
}

@vertex
fn tone_mapping_vertex(@builtin(vertex_index) index: u32) -> WholePicture {
    let place = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return WholePicture(vec4<f32>(place, 0.0, 1.0), adaptation());
}

@fragment
fn tone_mapping_fragment(in: WholePicture) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(in.position.xy);
    let radiance = in.adapted * textureLoad(light, pixel, 0).xyz;
    return vec4<f32>(encoded(tone_curve(radiance), pixel), 1.0);
}
