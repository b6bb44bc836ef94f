
// Noise at places displaced by noise; the twin of warp.rs. The table has the octaves of the heights, then those
// of the displacements to the east, then those to the south.

struct WarpConstants {
    octaves: u32,
    bends: u32,
    rows: u32,
    middle: f32,
    scale: f32,
}

/// Sum of the octaves of a displacement in metres.
fn bend(first: u32, cell: vec2<i32>) -> f32 {
    var sum = 0.0;
    for (var octave = first; octave < first + constants.bends; octave++) {
        sum += exact(amplitude_of(octave) * octave_at(octave, cell));
    }
    return sum;
}

fn height_at(cell: vec2<i32>) -> f32 {
    let away = vec2<f32>(bend(constants.octaves, cell), bend(constants.octaves + constants.bends, cell));
    var sum = 0.0;
    for (var octave = 0u; octave < constants.octaves; octave++) {
        sum += exact(amplitude_of(octave) * displaced_octave_at(octave, cell, away));
    }
    return constants.middle + exact(constants.scale * sum);
}

@compute @workgroup_size(16, 16)
fn warp(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        height[index(cell)] = height_at(cell);
    }
}
