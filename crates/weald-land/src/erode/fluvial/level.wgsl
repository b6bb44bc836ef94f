
// Heights of water and ground after rain and evaporation, the depth, and what would fall over an open edge.

@compute @workgroup_size(16, 16)
fn level_of_water(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let ground = base[at] + change[at];
    let wet = exact(depth[at] + weather.rain * inflow_of(cell));
    let rained = dried(wet, cell);
    let shallow = min(rained, constants.deepest);
    tally(RAINED, cell, wet - depth[at]);
    if (inside(cell)) {
        level[at] = vec4<f32>(ground + rained, ground, rained, shallow * sqrt(constants.flow_rate * shallow));
    }
}
