// The rock's top, and how soft the ground is and how steeply it rests, by its cover and the stratum under it; the twin of
// strata.rs.

@compute @workgroup_size(16, 16)
fn expose(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let top = min(rock[at], change[at]);
    let worn = -top;
    var found = constants.materials[0];
    for (var stratum = 0u; stratum < STRATA; stratum++) {
        if (worn < bottoms[stratum * (grid.columns * grid.rows) + at]) {
            found = constants.materials[1u + stratum];
        }
    }
    let thickness = change[at] - top;
    let share = thickness / (thickness + constants.half);
    if (inside(cell)) {
        rock[at] = top;
        strength[at] = found + share * (constants.materials[1u + STRATA] - found);
    }
}
