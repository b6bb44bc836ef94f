
// Ground after creep, slides and the wear of banks: along each edge by the mean of its two cells.

/// Ground of a cell, what levels across channels in it, and depth of its water.
fn bank_at(cell: vec2<i32>) -> vec3<f32> {
    let there = carried[index(cell)];
    return vec3<f32>(ground(cell), there.w, there.z);
}

/// What comes over an edge from another cell.
fn from_cell(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    let share = 0.5 * (unrest[index(cell)] + unrest[index(next)]);
    let slides = exact(share * (ground(next) - ground(cell)));
    let movable = may_change(cell) * may_change(next);
    return exact(slides * valid(next) + washed(bank_at(cell), bank_at(next)) * movable);
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
