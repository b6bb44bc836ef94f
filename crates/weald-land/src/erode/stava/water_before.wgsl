
fn water_before(cell: vec2<i32>) -> f32 {
    return levels[index(cell)].y;
}
