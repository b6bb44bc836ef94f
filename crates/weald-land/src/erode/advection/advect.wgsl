
@compute @workgroup_size(16, 16)
fn advect(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let arrived = departure(sediment_around(cell), velocity(cell), links_of(cell));
    if (inside(cell)) {
        arrive(cell, arrived);
    }
}
