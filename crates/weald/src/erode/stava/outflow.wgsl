
// Outflows to the four neighbours, scaled to the water that the cell has; the twin of water.rs.

fn surface(cell: vec2<i32>) -> f32 {
    let level = levels[index(cell)];
    return level.x + level.y;
}

fn outflow_towards(old: f32, cell: vec2<i32>, next: vec2<i32>) -> f32 {
    if (OPEN) {
        let level = select(levels[index(cell)].x, surface(next), link(cell, next) > 0.0);
        return max(old + constants.flow_rate * (surface(cell) - level), 0.0) * land(cell);
    }
    return max(old + constants.flow_rate * (surface(cell) - surface(next)), 0.0) * link(cell, next);
}

@compute @workgroup_size(16, 16)
fn outflow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let old = outflows[at];
    let wanted = vec4<f32>(
        outflow_towards(old.x, cell, cell + EAST),
        outflow_towards(old.y, cell, cell + WEST),
        outflow_towards(old.z, cell, cell + SOUTH),
        outflow_towards(old.w, cell, cell + NORTH),
    );
    if (inside(cell)) {
        outflows[at] = scaled(wanted, levels[at].y);
    }
}
