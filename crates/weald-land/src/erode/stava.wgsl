
/// Numbers of the method, in cells and steps; the twin of `StavaNumbers`.
struct StavaNumbers {
    // For each material, bedrock first: share of the room that erosion takes, share that dissolution takes, talus.
    materials: array<vec4<f32>, 8>,
    flow_rate: f32,
    capacity: f32,
    epsilon: f32,
    velocity_epsilon: f32,
    // Share of the surplus that settles.
    deposition: f32,
    // What each neighbour counts in a sweep of the viscosity.
    viscosity: f32,
    regolith_most: f32,
    regolith_kept: f32,
    regolith_flow_rate: f32,
    slippage: f32,
    padding_a: f32,
    padding_b: f32,
}
