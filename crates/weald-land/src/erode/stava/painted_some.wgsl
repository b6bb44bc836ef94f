
/// Shares of rain and evaporation, and what springs.
fn painted_of(at: u32) -> vec3<f32> {
    return vec3<f32>(painted[layer_of(0u, at)], painted[layer_of(1u, at)], painted[layer_of(2u, at)]);
}
