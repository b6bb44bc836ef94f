
// The isotropic scheme: each edge by the triangle east and south of a cell.

fn slide_east(cell: vec2<i32>) -> f32 {
    return triangle_share(cell, EAST, SOUTH) * (ground(cell) - ground(cell + EAST));
}

fn slide_south(cell: vec2<i32>) -> f32 {
    return triangle_share(cell, EAST, SOUTH) * (ground(cell) - ground(cell + SOUTH));
}
