
// Water after the outflows, and its velocity; the twin of `Moved` in water.rs.

/// Depth after the outflows.
fn flowed_depth(cell: vec2<i32>) -> f32 {
    let inflow = inflows_of(cell);
    return levels[index(cell)].y + (((inflow.y + inflow.x) + (inflow.w + inflow.z)) - sum_of(outflow_of(cell)));
}

/// Flux differences over the mean depth.
fn velocity_of_flow(cell: vec2<i32>) -> vec2<f32> {
    let mean_depth = (levels[index(cell)].y + flowed_depth(cell)) * 0.5;
    return flow_velocity(outflow_of(cell), inflows_of(cell), mean_depth, constants.velocity_epsilon);
}
