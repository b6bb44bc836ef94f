
// Ground steeper than its talus slides; the twin of thermal.rs.

// Schemes, as in Rust; the third is the symmetric one.
const AXIS: u32 = 0u;
const ISOTROPIC: u32 = 1u;

fn ground(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    return base[at] + settled[at];
}

/// What slides along an edge with step `q`.
fn along_axis(q: f32) -> f32 {
    return constants.strength * (q - clamp(q, -constants.talus, constants.talus));
}

/// The share of the steps of a triangle that slides.
fn sliding_share(step_x: f32, step_y: f32) -> f32 {
    let slope = sqrt(step_x * step_x + step_y * step_y);
    return select(0.0, constants.strength * (slope - constants.talus) / slope, slope > constants.talus);
}

/// The share that slides of the triangle of a cell with its neighbours in two directions.
fn triangle_share(cell: vec2<i32>, along: vec2<i32>, across: vec2<i32>) -> f32 {
    let here = ground(cell);
    let share = sliding_share(here - ground(cell + along), here - ground(cell + across));
    return share * (link(cell, cell + along) * link(cell, cell + across));
}

fn slide_east(cell: vec2<i32>) -> f32 {
    let next = cell + EAST;
    let step = ground(cell) - ground(next);
    if (SCHEME == AXIS) {
        return link(cell, next) * along_axis(step);
    }
    if (SCHEME == ISOTROPIC) {
        return triangle_share(cell, EAST, SOUTH) * step;
    }
    let share = triangle_share(cell, EAST, SOUTH) + triangle_share(cell, EAST, NORTH);
    let share_next = triangle_share(next, WEST, SOUTH) + triangle_share(next, WEST, NORTH);
    return step * ((share + share_next) * 0.25);
}

fn slide_south(cell: vec2<i32>) -> f32 {
    let next = cell + SOUTH;
    let step = ground(cell) - ground(next);
    if (SCHEME == AXIS) {
        return link(cell, next) * along_axis(step);
    }
    if (SCHEME == ISOTROPIC) {
        return triangle_share(cell, EAST, SOUTH) * step;
    }
    let share = triangle_share(cell, EAST, SOUTH) + triangle_share(cell, WEST, SOUTH);
    let share_next = triangle_share(next, EAST, NORTH) + triangle_share(next, WEST, NORTH);
    return step * ((share + share_next) * 0.25);
}

@compute @workgroup_size(16, 16)
fn slide(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let to_east = exact(slide_east(cell));
    let from_west = exact(slide_east(cell + WEST));
    let to_south = exact(slide_south(cell));
    let from_north = exact(slide_south(cell + NORTH));
    if (inside(cell)) {
        change[index(cell)] = settled[index(cell)] + ((from_west - to_east) + (from_north - to_south));
    }
}
