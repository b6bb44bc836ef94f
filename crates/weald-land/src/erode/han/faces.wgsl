
fn depth_at(cell: vec2<i32>) -> f32 {
    return depth_next[index(cell)];
}

fn flux_at(cell: vec2<i32>) -> vec2<f32> {
    return select(vec2<f32>(0.0), fluxes[index(cell)], inside(cell));
}

/// Velocities through the eastern, western, southern and northern face of a cell.
fn faces(cell: vec2<i32>) -> vec4<f32> {
    let here = depth_at(cell);
    let flux = flux_at(cell);
    let epsilon = constants.velocity_epsilon;
    return vec4<f32>(
        face_velocity(flux.x, here, depth_at(cell + EAST), epsilon),
        face_velocity(flux_at(cell + WEST).x, depth_at(cell + WEST), here, epsilon),
        face_velocity(flux.y, here, depth_at(cell + SOUTH), epsilon),
        face_velocity(flux_at(cell + NORTH).y, depth_at(cell + NORTH), here, epsilon),
    );
}
