
// What the advection reads and writes.

fn velocity(cell: vec2<i32>) -> vec2<f32> {
    return velocities[index(cell)];
}

fn settled_sediment(cell: vec2<i32>) -> f32 {
    return carried[index(cell)].y;
}
