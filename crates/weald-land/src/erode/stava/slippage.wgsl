
// What wants to slide; the twin of slippage.rs.

/// What of a material wants to slide from a cell to the one east or south of it.
fn slides(cell: vec2<i32>, next: vec2<i32>, material: u32) -> f32 {
    let step = tops[layer_of(material, index(cell))] - tops[layer_of(material, index(next))];
    let talus = talus_between(cell, next, material);
    return exact(link(cell, next) * (constants.slippage * (step - clamp(step, -talus, talus))));
}

/// What of a material wants to slide through the eastern, western, southern and northern edge, positive to the east
/// and south.
fn sliding(cell: vec2<i32>, material: u32) -> vec4<f32> {
    return vec4<f32>(
        slides(cell, cell + EAST, material),
        slides(cell + WEST, cell, material),
        slides(cell, cell + SOUTH, material),
        slides(cell + NORTH, cell, material),
    );
}
