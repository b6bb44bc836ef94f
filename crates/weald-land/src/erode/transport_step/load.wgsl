
fn settled_sediment(cell: vec2<i32>) -> f32 {
    return load[index(cell)];
}
