
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
    let outgoing = carried_by(sum_of(outflow_of(cell)), cell);
    let inflows = inflows_of(cell);
    let inflow = (carried_by(inflows.y, cell + WEST) + carried_by(inflows.x, cell + EAST))
        + (carried_by(inflows.w, cell + NORTH) + carried_by(inflows.z, cell + SOUTH));
    if (inside(cell)) {
        carried[at] = vec2<f32>(carried[at].x, without_negligible(carried[at].y + (inflow - outgoing)));
    }
}
