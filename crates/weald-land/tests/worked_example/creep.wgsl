
// Soil creeps down every slope; the twin of creep.rs.

fn ground(cell: vec2<i32>) -> f32 {
    return base[index(cell)] + change[index(cell)];
}

/// What creeps from a cell to the one east or south of it.
fn creeping(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    return exact(link(cell, next) * (constants.rate * (ground(cell) - ground(next))));
}

@compute @workgroup_size(16, 16)
fn creep(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        let along = creeping(cell + WEST, cell) - creeping(cell, cell + EAST);
        let across = creeping(cell + NORTH, cell) - creeping(cell, cell + SOUTH);
        changed[index(cell)] = change[index(cell)] + (along + across);
    }
}
