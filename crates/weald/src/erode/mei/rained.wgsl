
/// Depth after rain.
fn rained(cell: vec2<i32>) -> f32 {
    return carried[index(cell)].x + weather.rain * land(cell);
}
