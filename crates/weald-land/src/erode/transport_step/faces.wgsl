
fn face_east(cell: vec2<i32>) -> f32 {
    return flows[index(cell)].x;
}

fn face_south(cell: vec2<i32>) -> f32 {
    return flows[index(cell)].y;
}

fn water_before(cell: vec2<i32>) -> f32 {
    return water[index(cell)];
}
