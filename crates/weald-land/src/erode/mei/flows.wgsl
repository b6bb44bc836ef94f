
// Outflows and velocities of a scheme with four outflows a cell; the twin of parts of kernels.rs. Vectors of outflows
// hold those to the east, west, south and north.

/// What leaves a cell.
fn sum_of(outflow: vec4<f32>) -> f32 {
    return (outflow.x + outflow.y) + (outflow.z + outflow.w);
}

/// The four outflows scaled to the water that the cell has.
fn scaled(wanted: vec4<f32>, depth: f32) -> vec4<f32> {
    let sum = sum_of(wanted);
    let available = max(depth * (1.0 - RETAINED_SHARE), 0.0);
    return wanted * select(1.0, available / sum, sum > available);
}

/// Velocity of the water that flowed; `inflow` holds what came from the east, west, south and north.
fn flow_velocity(outflow: vec4<f32>, inflow: vec4<f32>, mean_depth: f32, velocity_epsilon: f32) -> vec2<f32> {
    let per_depth = select(0.0, 0.5 / mean_depth, mean_depth > velocity_epsilon);
    let eastward = ((inflow.y - outflow.y) + (outflow.x - inflow.x)) * per_depth;
    let southward = ((inflow.w - outflow.w) + (outflow.z - inflow.z)) * per_depth;
    return vec2<f32>(eastward, southward);
}
