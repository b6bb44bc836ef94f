
// Takes sediment by the speed of the water and by the share of its unused transport capacity, and settles what the
// water cannot carry.

@compute @workgroup_size(16, 16)
fn settle(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let found = sediment_next[at];
    let velocity = cell_velocity(faces(cell));
    let speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    let most = constants.capacity * speed * mean_sine(cell) * max(depth_at(cell), 0.0);
    let uptake = constants.uptake_by_speed * speed + constants.uptake_by_capacity * max(most - found, 0.0);
    let taken = exact((min(found + uptake, most) - found) * erodible(cell));
    let result = settle_taken(found, taken, change[at], constants.deposit_ratio);
    tally(SHRUNK, cell, result.lost);
    if (inside(cell)) {
        settled[at] = result.change;
        sediment_next[at] = result.sediment;
    }
}
