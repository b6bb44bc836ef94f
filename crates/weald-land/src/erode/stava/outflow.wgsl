
// Outflows to the four neighbours, scaled to the water that the cell has; the twin of water.rs.

fn surface(cell: vec2<i32>) -> f32 {
    let level = levels[index(cell)];
    return level.x + level.y;
}

/// Layers have no start of their own, so water falls from the ground as it is.
fn edge_level(cell: vec2<i32>) -> f32 {
    return levels[index(cell)].x;
}

@compute @workgroup_size(16, 16)
fn outflow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let wanted = wanted_outflows(cell, outflows[at]);
    if (inside(cell)) {
        outflows[at] = scaled(wanted, levels[at].y);
    }
}
