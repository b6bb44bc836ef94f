
fn arrive(cell: vec2<i32>, amount: f32) {
    carried_next[index(cell)] = vec2<f32>(carried[index(cell)].x, amount);
}
