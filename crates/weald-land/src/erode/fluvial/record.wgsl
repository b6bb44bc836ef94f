
// Adds the fluxes through the four edges that a cell keeps to the means.

@compute @workgroup_size(16, 16)
fn record(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        means[index(cell)] += fluxes[index(cell)];
    }
}
