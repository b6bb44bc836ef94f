
/// Shares of rain and evaporation, and what springs.
fn painted_of(at: u32) -> vec3<f32> {
    return vec3<f32>(1.0, 1.0, 0.0);
}

/// No drain takes any.
fn drain_sediment(cell: vec2<i32>, wet: f32, source: f32) {}
