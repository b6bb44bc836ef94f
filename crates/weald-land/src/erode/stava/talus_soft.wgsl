
/// The talus of a material between two cells.
fn talus_between(cell: vec2<i32>, next: vec2<i32>, material: u32) -> f32 {
    let here = softened_talus[layer_of(material, index(cell))];
    return (here + softened_talus[layer_of(material, index(next))]) * 0.5;
}
