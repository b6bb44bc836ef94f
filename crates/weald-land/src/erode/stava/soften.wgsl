
// The talus of each material where it lies rough; the twin of `Softened` in slippage.rs.

fn rise(cell: vec2<i32>, next: vec2<i32>, material: u32) -> f32 {
    let here = tops[layer_of(material, index(cell))];
    return link(cell, next) * (tops[layer_of(material, index(next))] - here);
}

@compute @workgroup_size(16, 16)
fn soften(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (!inside(cell)) {
        return;
    }
    for (var material = 0u; material < MATERIALS; material++) {
        let across = rise(cell, cell + WEST, material) + rise(cell, cell + EAST, material);
        let along = rise(cell, cell + NORTH, material) + rise(cell, cell + SOUTH, material);
        let rough = abs((across + along) * neighbour_share(cell));
        let talus = constants.materials[material].z;
        let softened = max(talus - 10.0 * max(rough - 0.01 * talus, 0.0), 0.0);
        softened_talus[layer_of(material, index(cell))] = softened;
    }
}
