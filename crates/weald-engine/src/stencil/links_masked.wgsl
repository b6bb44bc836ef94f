
// A world in which the mask says which cells hold data, and where water may change the ground.

/// 1 where the cell holds data, else 0.
fn valid(cell: vec2<i32>) -> f32 {
    return select(0.0, mask[index(cell)].x, inside(cell));
}

/// 1 where water may change the ground.
fn erodible(cell: vec2<i32>) -> f32 {
    return select(0.0, mask[index(cell)].y, inside(cell));
}
