
// Sediment after the outflows, each with the concentration of the cell that it leaves.

fn concentration_of(cell: vec2<i32>) -> f32 {
    return concentration[index(cell)];
}

@compute @workgroup_size(16, 16)
fn carry(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let went = sum_of(outflow_of(cell)) * concentration_of(cell);
    let come = came_to(cell);
    let came = (come.y * concentration_of(cell + WEST) + come.x * concentration_of(cell + EAST))
        + (come.w * concentration_of(cell + NORTH) + come.z * concentration_of(cell + SOUTH));
    if (inside(cell)) {
        carried[at] = vec2<f32>(carried[at].x, worth_counting(carried[at].y + (came - went)));
    }
}
