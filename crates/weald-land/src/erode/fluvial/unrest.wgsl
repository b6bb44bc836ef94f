
// Share of each step of the ground that creeps, and slides where the slope exceeds the talus.

fn square(here: f32, next: vec2<i32>) -> f32 {
    let step = ground(next) - here;
    return step * step * valid(next);
}

@compute @workgroup_size(16, 16)
fn find_unrest(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let here = ground(cell);
    let axes = (square(here, cell + EAST) + square(here, cell + WEST))
        + (square(here, cell + SOUTH) + square(here, cell + NORTH));
    let diagonals = (square(here, cell + SOUTH_EAST) + square(here, cell + NORTH_WEST))
        + (square(here, cell + SOUTH_WEST) + square(here, cell + NORTH_EAST));
    let slope = sqrt(0.5 * (AXIS * axes + DIAGONAL * diagonals));
    let stratum = stratum_of(cell);
    let rests = constants.talus * stratum.y;
    let slides = select(0.0, constants.slide * (slope - rests) / slope, slope > rests);
    if (inside(cell)) {
        unrest[index(cell)] = constants.creep * stratum.z + slides;
    }
}
