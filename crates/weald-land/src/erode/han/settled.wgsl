
/// Sediment as the exchange with the ground left it.
fn settled_sediment(cell: vec2<i32>) -> f32 {
    return sediment_next[index(cell)];
}
