
/// Depth after rain.
fn rained(cell: vec2<i32>) -> f32 {
    return exact(carried[index(cell)].x + weather.rain * valid(cell));
}
