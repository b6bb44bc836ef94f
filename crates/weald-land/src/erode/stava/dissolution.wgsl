
// Ground under standing water turns into regolith; the twin of dissolution.rs.

@compute @workgroup_size(16, 16)
fn dissolve(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    if (!inside(cell)) {
        return;
    }
    let found = regolith[at];
    let room = (min(standing(at), constants.regolith_most) - found) * erodible(cell);
    let after = dig(at, room, found, 1u, 1.0);
    regolith[at] = after;
    solid[at] = pile(at) + after;
}
