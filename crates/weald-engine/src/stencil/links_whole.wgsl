
// A world in which every cell holds data.

/// 1 where the cell holds data, else 0.
fn valid(cell: vec2<i32>) -> f32 {
    return select(0.0, 1.0, inside(cell));
}

/// 1 where water may change the ground.
fn erodible(cell: vec2<i32>) -> f32 {
    return valid(cell);
}
