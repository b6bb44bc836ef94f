
fn arrive(cell: vec2<i32>, amount: f32) {
    load_next[index(cell)] = amount;
}
