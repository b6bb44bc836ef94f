
// Noise folded at 0, rough on top and smooth below; the twin of ridged.rs.

struct RidgedConstants {
    octaves: u32,
    rows: u32,
    sharpness: f32,
}

fn height_at(cell: vec2<i32>) -> f32 {
    var weight = 1.0;
    var sum = 0.0;
    for (var octave = 0u; octave < constants.octaves; octave++) {
        let fold = 1.0 - abs(octave_at(octave, cell));
        let crest = exact(weight * fold * fold);
        sum += exact(amplitude_of(octave) * crest);
        weight = clamp(constants.sharpness * crest, 0.0, 1.0);
    }
    return sum;
}

@compute @workgroup_size(16, 16)
fn ridged(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        height[index(cell)] = height_at(cell);
    }
}
