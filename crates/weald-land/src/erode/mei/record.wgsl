
// Adds the fluxes through the eastern and southern edge to the means: what a cell gives, less what its
// neighbour gives back.

@compute @workgroup_size(16, 16)
fn record(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let given = outflow_of(cell);
    let back = vec2<f32>(outflow_of(cell + EAST).y, outflow_of(cell + SOUTH).w);
    if (inside(cell)) {
        means[index(cell)] = (means[index(cell)] + given.xz) - back;
    }
}
