
// Noise at shrinking wavelengths, added; the twin of fbm.rs.

struct FbmConstants {
    octaves: u32,
    rows: u32,
    middle: f32,
    scale: f32,
}

fn height_at(cell: vec2<i32>) -> f32 {
    var sum = 0.0;
    for (var octave = 0u; octave < constants.octaves; octave++) {
        sum += exact(amplitude_of(octave) * octave_at(octave, cell));
    }
    return constants.middle + exact(constants.scale * sum);
}

@compute @workgroup_size(16, 16)
fn fbm(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        height[index(cell)] = height_at(cell);
    }
}
