
/// Velocity that wears the ground.
fn wearing_velocity(cell: vec2<i32>) -> vec2<f32> {
    return velocities[index(cell)];
}
