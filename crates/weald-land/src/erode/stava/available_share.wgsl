
// What share of what wants to slide off a cell there is.

@compute @workgroup_size(16, 16)
fn available_share(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (!inside(cell)) {
        return;
    }
    for (var material = 1u; material < MATERIALS; material++) {
        let place = layer_of(material, index(cell));
        let flow = sliding(cell, material);
        let wanted = outflow_by(flow.x, flow.y, flow.z, flow.w);
        let most = column[place] * (1.0 - RETAINED_SHARE);
        affordable[place] = select(1.0, most / wanted, wanted > most);
    }
}
