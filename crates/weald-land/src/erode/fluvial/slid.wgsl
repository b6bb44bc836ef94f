
// Ground after creep, slides and the wear of banks: along each edge by the mean of its two cells.

/// What comes over an edge from another cell. Water wears a bank no higher than it stands.
fn from_cell(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    let here = carried[index(cell)];
    let there = carried[index(next)];
    let step = ground(next) - ground(cell);
    let deep = max(here.z, there.z);
    let washed = max(-deep, min(step, deep));
    let slides = exact(0.5 * (unrest[index(cell)] + unrest[index(next)]) * step);
    return exact((slides + 0.5 * (here.w + there.w) * washed) * valid(next));
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
