
fn outflow_of(cell: vec2<i32>) -> vec4<f32> {
    return select(vec4<f32>(0.0), outflows[index(cell)], inside(cell));
}

/// What comes to a cell from the east, west, south and north.
fn inflows_of(cell: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(
        outflow_of(cell + EAST).y, outflow_of(cell + WEST).x, outflow_of(cell + SOUTH).w, outflow_of(cell + NORTH).z,
    );
}
