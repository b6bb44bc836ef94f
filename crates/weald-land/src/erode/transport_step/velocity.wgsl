
fn velocity(cell: vec2<i32>) -> vec2<f32> {
    return flows[index(cell)];
}
