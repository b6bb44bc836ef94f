
/// Shares of rain and evaporation, and what springs.
fn painted_of(at: u32) -> vec3<f32> {
    return vec3<f32>(painted[layer_of(0u, at)], painted[layer_of(1u, at)], painted[layer_of(2u, at)]);
}

/// A drain takes the sediment of the water that it takes; the twin of `Drained` in weather.rs.
fn drain_sediment(cell: vec2<i32>, wet: f32, source: f32) {
    let at = index(cell);
    let drained = min(max(-source, 0.0) * valid(cell), wet);
    let found = carried[at].y;
    let kept = exact(found - found * (drained / (wet + constants.epsilon)));
    tally(SEDIMENT_OUT, cell, found - kept);
    if (inside(cell)) {
        carried[at] = vec2<f32>(carried[at].x, kept);
    }
}
