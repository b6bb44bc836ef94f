
// What carries sediment with the fluxes of the water.

fn face_east(cell: vec2<i32>) -> f32 {
    return fluxes[index(cell)].x;
}

fn face_south(cell: vec2<i32>) -> f32 {
    return fluxes[index(cell)].y;
}

fn water_before(cell: vec2<i32>) -> f32 {
    return depth[index(cell)];
}
