
/// Ground before the exchange.
fn ground_before(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    return base[at] + change[at];
}

fn sine_towards(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    return sine(ground_before(next) - ground_before(cell), link(cell, next));
}

/// Mean sine of the slopes around a cell.
fn mean_sine(cell: vec2<i32>) -> f32 {
    let horizontal = sine_towards(cell, cell + WEST) + sine_towards(cell, cell + EAST);
    let vertical = sine_towards(cell, cell + NORTH) + sine_towards(cell, cell + SOUTH);
    return (horizontal + vertical) * neighbour_share(cell);
}
