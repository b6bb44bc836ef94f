
// Depth after the fluxes and evaporation, the velocity of the water, and what it takes from or gives to the
// ground.

@compute @workgroup_size(16, 16)
fn exchange(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let before = rained(cell);
    let found = carried[at].y;
    let flowing = outflow_of(cell);
    let came = came_to(cell);
    let flowed = exact(before + (((came.y + came.x) + (came.w + came.z)) - sum_of(flowing)));
    let velocity = flow_velocity(flowing, came, (before + flowed) * 0.5, constants.velocity_epsilon);
    let depth = exact(worth_counting(flowed * (1.0 - weather.evaporation)));
    let speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    let capacity = constants.capacity * max(mean_sine(cell), LEAST_SINE) * speed;
    let room = (capacity - found) * yields(cell);
    let result = exchange_for(room, found, change[at]);
    if (weather.evaporation > 0.0) {
        tally(EVAPORATED, cell, depth - flowed);
    }
    if (SHRINKS) {
        tally(SHRUNK, cell, result.lost);
    }
    var kept = 1.0;
    if (OPEN) {
        kept = land(cell);
        tally(WATER_OUT, cell, depth * (1.0 - kept));
        tally(SEDIMENT_OUT, cell, result.sediment * (1.0 - kept));
    }
    if (inside(cell)) {
        settled[at] = result.change;
        carried[at] = vec2<f32>(depth * kept, result.sediment * kept);
        hand_on(at, velocity, result.sediment * kept, before);
    }
}
