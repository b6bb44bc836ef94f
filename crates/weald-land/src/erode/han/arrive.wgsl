
fn arrive(cell: vec2<i32>, amount: f32) {
    sediment[index(cell)] = amount;
}
