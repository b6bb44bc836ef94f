
// Materials after what came and went, each by the share of the cell that gives it; bedrock has no end.

fn share(cell: vec2<i32>, material: u32) -> f32 {
    return affordable[layer_of(material, index(cell))];
}

/// Thickness of a material after the slide.
fn slid_thickness(cell: vec2<i32>, material: u32) -> f32 {
    let wanted = sliding(cell, material);
    let here = share(cell, material);
    let east = exact(wanted.x * select(share(cell + EAST, material), here, wanted.x > 0.0));
    let west = exact(wanted.y * select(here, share(cell + WEST, material), wanted.y > 0.0));
    let south = exact(wanted.z * select(share(cell + SOUTH, material), here, wanted.z > 0.0));
    let north = exact(wanted.w * select(here, share(cell + NORTH, material), wanted.w > 0.0));
    let before = column[layer_of(material, index(cell))];
    return without_negligible(before + ((west - east) + (north - south)));
}

@compute @workgroup_size(16, 16)
fn slip(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    if (!inside(cell)) {
        return;
    }
    let bedrock = sliding(cell, 0u);
    column[at] = column[at] + ((bedrock.y - bedrock.x) + (bedrock.w - bedrock.z));
    for (var material = 1u; material < MATERIALS; material++) {
        column[layer_of(material, at)] = slid_thickness(cell, material);
    }
}
