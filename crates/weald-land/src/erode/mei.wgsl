
/// Constants of the method, in cells and steps, and those of the sliding; the twin of `MeiConstants`.
struct MeiConstants {
    flow_rate: f32,
    capacity: f32,
    erosion: f32,
    deposition: f32,
    deposit_ratio: f32,
    epsilon: f32,
    velocity_epsilon: f32,
    talus: f32,
    strength: f32,
}
