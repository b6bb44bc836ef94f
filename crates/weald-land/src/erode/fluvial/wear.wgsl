
// What the water takes from or gives to the ground.

@compute @workgroup_size(16, 16)
fn wear(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let before = change[at];
    let found = carried[at].x;
    let left = (found + carried[at].y) / (1.0 + constants.settling / (carried[at].z + constants.thin));
    let changed = exact(before - (left - found) * may_change(cell));
    let taken = exact(before - changed);
    let there = found + taken >= 0.0;
    if (inside(cell)) {
        depth[at] = carried[at].z;
        settled[at] = select(before, changed, there);
        sediment[at] = select(found, found + taken, there);
    }
}
