
// Ground after creep and slides: along each edge by the mean unrest of its two cells.

/// What comes over an edge from another cell.
fn from_cell(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    let share = 0.5 * (unrest[index(cell)] + unrest[index(next)]) * valid(next);
    return exact(share * (ground(next) - ground(cell)));
}

@compute @workgroup_size(16, 16)
fn slide(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let axes = (from_cell(cell, cell + EAST) + from_cell(cell, cell + WEST))
        + (from_cell(cell, cell + SOUTH) + from_cell(cell, cell + NORTH));
    let diagonals = (from_cell(cell, cell + SOUTH_EAST) + from_cell(cell, cell + NORTH_WEST))
        + (from_cell(cell, cell + SOUTH_WEST) + from_cell(cell, cell + NORTH_EAST));
    if (inside(cell)) {
        change[at] = settled[at] + (AXIS * axes + DIAGONAL * diagonals) * valid(cell);
    }
}
