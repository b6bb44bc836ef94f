
// What outflows come from in a scheme with four of them a cell; the twin of four_outflows.rs. A model says how high its
// water stands, surface(cell), and from where it falls over an open edge, edge_level(cell).

fn outflow_towards(old: f32, cell: vec2<i32>, next: vec2<i32>) -> f32 {
    if (OPEN) {
        let level = select(edge_level(cell), surface(next), link(cell, next) > 0.0);
        return max(old + constants.flow_rate * (surface(cell) - level), 0.0) * valid(cell);
    }
    return max(old + constants.flow_rate * (surface(cell) - surface(next)), 0.0) * link(cell, next);
}

/// What the slopes around a cell make of its outflows, before they are scaled to what it has.
fn wanted_outflows(cell: vec2<i32>, old: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        outflow_towards(old.x, cell, cell + EAST),
        outflow_towards(old.y, cell, cell + WEST),
        outflow_towards(old.z, cell, cell + SOUTH),
        outflow_towards(old.w, cell, cell + NORTH),
    );
}
