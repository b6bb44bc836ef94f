
// The axis scheme: each edge for itself.

/// What slides along an edge with step `q`.
fn along_axis(q: f32) -> f32 {
    return constants.strength * (q - clamp(q, -constants.talus, constants.talus));
}

fn slide_east(cell: vec2<i32>) -> f32 {
    return link(cell, cell + EAST) * along_axis(ground(cell) - ground(cell + EAST));
}

fn slide_south(cell: vec2<i32>) -> f32 {
    return link(cell, cell + SOUTH) * along_axis(ground(cell) - ground(cell + SOUTH));
}
