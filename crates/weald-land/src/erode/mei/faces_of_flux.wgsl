
// What carries sediment with the fluxes of the water.

fn face_east(cell: vec2<i32>) -> f32 {
    return outflow_of(cell).x - outflow_of(cell + EAST).y;
}

fn face_south(cell: vec2<i32>) -> f32 {
    return outflow_of(cell).z - outflow_of(cell + SOUTH).w;
}
