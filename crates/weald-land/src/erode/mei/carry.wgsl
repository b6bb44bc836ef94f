
// Sediment after the outflows, each with the concentration of the cell that it leaves.

fn concentration_of(cell: vec2<i32>) -> f32 {
    return concentration[index(cell)];
}

/// What an outflow of a cell carries.
fn carried_by(outflow: f32, cell: vec2<i32>) -> f32 {
    return exact(outflow * concentration_of(cell));
}

@compute @workgroup_size(16, 16)
fn carry(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let went = carried_by(sum_of(outflow_of(cell)), cell);
    let come = came_to(cell);
    let came = (carried_by(come.y, cell + WEST) + carried_by(come.x, cell + EAST))
        + (carried_by(come.w, cell + NORTH) + carried_by(come.z, cell + SOUTH));
    if (inside(cell)) {
        carried[at] = vec2<f32>(carried[at].x, worth_counting(carried[at].y + (came - went)));
    }
}
