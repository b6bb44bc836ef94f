
// The symmetric scheme: each edge by the mean of the triangles at its two ends.

fn slide_east(cell: vec2<i32>) -> f32 {
    let next = cell + EAST;
    let share = triangle_share(cell, EAST, SOUTH) + triangle_share(cell, EAST, NORTH);
    let share_next = triangle_share(next, WEST, SOUTH) + triangle_share(next, WEST, NORTH);
    return (ground(cell) - ground(next)) * ((share + share_next) * 0.25);
}

fn slide_south(cell: vec2<i32>) -> f32 {
    let next = cell + SOUTH;
    let share = triangle_share(cell, EAST, SOUTH) + triangle_share(cell, WEST, SOUTH);
    let share_next = triangle_share(next, EAST, NORTH) + triangle_share(next, WEST, NORTH);
    return (ground(cell) - ground(next)) * ((share + share_next) * 0.25);
}
