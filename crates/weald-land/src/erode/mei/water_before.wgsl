
fn water_before(cell: vec2<i32>) -> f32 {
    return rained_depth[index(cell)];
}
