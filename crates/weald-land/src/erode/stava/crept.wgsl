
// Regolith after its outflows; the twin of `Crept` in dissolution.rs.

fn creeping_of(cell: vec2<i32>) -> vec4<f32> {
    return select(vec4<f32>(0.0), creeping[index(cell)], inside(cell));
}

@compute @workgroup_size(16, 16)
fn crept(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let inflow = (creeping_of(cell + WEST).x + creeping_of(cell + EAST).y)
        + (creeping_of(cell + NORTH).z + creeping_of(cell + SOUTH).w);
    if (inside(cell)) {
        regolith[at] = without_negligible(regolith[at] + (inflow - sum_of(creeping_of(cell))));
    }
}
