
// What carries sediment by the velocity of its cell.

fn velocity(cell: vec2<i32>) -> vec2<f32> {
    return velocities[index(cell)];
}
