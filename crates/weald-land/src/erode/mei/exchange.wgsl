
// Depth after the fluxes and evaporation, the velocity of the water, and what it takes from or gives to the
// ground.

/// Rise of the ground along an axis, the mean of those to both neighbours or of the one that there is.
fn rise_along(cell: vec2<i32>, before: vec2<i32>, next: vec2<i32>) -> f32 {
    let here = ground_before(cell);
    let to_next = link(cell, next) * (ground_before(next) - here);
    let from_before = link(cell, before) * (here - ground_before(before));
    return (to_next + from_before) / max(link(cell, next) + link(cell, before), 1.0);
}

/// Sine of the slope that counts.
fn tilt(cell: vec2<i32>) -> f32 {
    if (CENTRAL) {
        let across = rise_along(cell, cell + WEST, cell + EAST);
        let along = rise_along(cell, cell + NORTH, cell + SOUTH);
        let squared = across * across + along * along;
        return sqrt(squared / (1.0 + squared));
    }
    return mean_sine(cell);
}

@compute @workgroup_size(16, 16)
fn exchange(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let before = rained(cell);
    let found = carried[at].y;
    let flowing = outflow_of(cell);
    let inflow = inflows_of(cell);
    let flowed = exact(before + (((inflow.y + inflow.x) + (inflow.w + inflow.z)) - sum_of(flowing)));
    let velocity = flow_velocity(flowing, inflow, (before + flowed) * 0.5, constants.velocity_epsilon);
    let depth = exact(without_negligible(flowed * (1.0 - weather.evaporation * valid(cell))));
    let speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    let capacity = constants.capacity * max(tilt(cell), MIN_SINE) * speed;
    let room = (capacity - found) * erodible(cell);
    let result = exchange_for(room, found, change[at]);
    if (weather.evaporation > 0.0) {
        tally(EVAPORATED, cell, depth - flowed);
    }
    if (SHRINKS) {
        tally(SHRUNK, cell, result.lost);
    }
    var kept = 1.0;
    if (OPEN) {
        kept = valid(cell);
        tally(WATER_OUT, cell, depth * (1.0 - kept));
        tally(SEDIMENT_OUT, cell, result.sediment * (1.0 - kept));
    }
    if (inside(cell)) {
        settled[at] = result.change;
        carried[at] = vec2<f32>(depth * kept, result.sediment * kept);
        store_transport_input(at, velocity, result.sediment * kept, before);
    }
}
