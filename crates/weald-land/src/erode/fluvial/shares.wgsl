
// What share of its outflow a cell can give, how much sediment a unit of it carries, the sediment itself, and how soft
// the ground is.

@compute @workgroup_size(16, 16)
fn share_out(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let here = wanted_at(cell);
    let axes = vec4<f32>(here.x, wanted_at(cell + WEST).x, here.y, wanted_at(cell + NORTH).y);
    let diagonals = vec4<f32>(here.z, wanted_at(cell + NORTH_WEST).z, here.w, wanted_at(cell + NORTH_EAST).w);
    let out = outflow(axes, diagonals);
    let rained = level[at].z;
    let available = rained * (1.0 - RETAINED_SHARE);
    let share = select(1.0, available / out, out > available);
    if (inside(cell)) {
        limits[at] = vec4<f32>(share, sediment[at] / (rained + constants.thin), sediment[at], softness_of(cell));
    }
}
