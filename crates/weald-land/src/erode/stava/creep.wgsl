
// Outflows of regolith to the four neighbours, scaled to what there is; the twin of `Creep` in dissolution.rs.

fn creep_towards(old: f32, cell: vec2<i32>, next: vec2<i32>) -> f32 {
    let drop = solid[index(cell)] - solid[index(next)];
    return max(constants.regolith_kept * old + constants.regolith_flow_rate * drop, 0.0) * link(cell, next);
}

@compute @workgroup_size(16, 16)
fn creep(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let old = creeping[at];
    let wanted = vec4<f32>(
        creep_towards(old.x, cell, cell + EAST),
        creep_towards(old.y, cell, cell + WEST),
        creep_towards(old.z, cell, cell + SOUTH),
        creep_towards(old.w, cell, cell + NORTH),
    );
    if (inside(cell)) {
        creeping[at] = scaled(wanted, regolith[at]);
    }
}
