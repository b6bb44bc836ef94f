
// What the advection reads and writes.

fn velocity(cell: vec2<i32>) -> vec2<f32> {
    return cell_velocity(faces(cell));
}

fn settled_sediment(cell: vec2<i32>) -> f32 {
    return sediment_next[index(cell)];
}
