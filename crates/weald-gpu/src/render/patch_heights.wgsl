// Heights of the vertices of patches, which pictures and shadows have in common.

const PATCH_VERTICES = (QUADS + 1u) * (QUADS + 1u);

// A patch whose heights are to be worked out, and where they go.
struct AskedPatch {
    corner: vec2<f32>,
    spacing: f32,
    slot: u32,
}

@group(2) @binding(6) var<storage, read> asked_patches: array<AskedPatch>;
@group(2) @binding(7) var<storage, read_write> filled_heights: array<vec2<f32>>;

// The height of the ground at a place.
fn height_at_place(place: vec2<f32>) -> f32 {
    if HORIZON && is_beyond(place) {
        let beyond = ground_beyond(place);
        return max(beyond.surface.x, level_beyond(place, beyond));
    }
    return spline_at(top, min(place, scene.grid.xy + 0.5));
}

// A vertex of a patch, in quads from its corner, and how far its even neighbour is.
fn vertex_of_patch(index: u32) -> vec2<f32> {
    return vec2<f32>(f32(index % (QUADS + 1u)), f32(index / (QUADS + 1u)));
}

fn onto_neighbour(at: vec2<f32>) -> vec2<f32> {
    return -2.0 * fract(at * 0.5);
}

// The heights at a vertex, and half of its way onto its even neighbour.
fn heights_at_vertex(asked_patch: AskedPatch, vertex: u32) -> vec2<f32> {
    let at = vertex_of_patch(vertex);
    let midway = asked_patch.corner + (at + 0.5 * onto_neighbour(at)) * asked_patch.spacing;
    return vec2<f32>(height_at_place(asked_patch.corner + at * asked_patch.spacing), height_at_place(midway));
}

@compute @workgroup_size(64)
fn fill_heights(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) within: u32,
) {
    let number = (group.y * groups.x + group.x) * 64u + within;
    let asked_patch = number / PATCH_VERTICES;
    if asked_patch >= arrayLength(&asked_patches) {
        return;
    }
    let vertex = number % PATCH_VERTICES;
    let here = asked_patches[asked_patch];
    filled_heights[here.slot * PATCH_VERTICES + vertex] = heights_at_vertex(here, vertex);
}
