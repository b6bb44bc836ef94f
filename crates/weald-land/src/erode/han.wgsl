
/// Constants of the method, in cells and steps, and those of the sliding; the twin of `HanConstants`.
struct HanConstants {
    flow_rate: f32,
    capacity: f32,
    uptake_by_speed: f32,
    uptake_by_capacity: f32,
    deposit_ratio: f32,
    epsilon: f32,
    velocity_epsilon: f32,
    talus: f32,
    strength: f32,
}
