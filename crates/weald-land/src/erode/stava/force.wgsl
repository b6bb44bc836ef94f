
// Force-based erosion; the twin of force.rs.

const MIN_SLOPE: f32 = 0.1;

fn sine_towards(cell: vec2<i32>, next: vec2<i32>) -> f32 {
    return sine(levels[index(next)].x - levels[index(cell)].x, link(cell, next));
}

/// Mean sine of the slopes around a cell.
fn mean_sine(cell: vec2<i32>) -> f32 {
    let horizontal = sine_towards(cell, cell + WEST) + sine_towards(cell, cell + EAST);
    let vertical = sine_towards(cell, cell + NORTH) + sine_towards(cell, cell + SOUTH);
    return (horizontal + vertical) * neighbour_share(cell);
}

@compute @workgroup_size(16, 16)
fn erode(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let found = carried[at].y;
    let depth = without_negligible(flowed_depth(cell));
    let velocity = wearing_velocity(cell);
    let speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    let room = (constants.capacity * max(mean_sine(cell), MIN_SLOPE) * speed - found) * erodible(cell);
    var sediment = 0.0;
    if (inside(cell)) {
        sediment = dig(at, room, found, 0u, constants.deposition);
    }
    var kept = 1.0;
    if (OPEN) {
        kept = valid(cell);
        tally(WATER_OUT, cell, depth * (1.0 - kept));
        tally(SEDIMENT_OUT, cell, sediment * (1.0 - kept));
    }
    if (inside(cell)) {
        carried[at] = vec2<f32>(depth * kept, sediment * kept);
        store_transport_input(at, velocity, sediment * kept);
    }
}
