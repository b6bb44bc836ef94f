
// A sweep of the diffusion of the velocity; the twin of viscosity.rs.

fn difference(cell: vec2<i32>, next: vec2<i32>, here: vec2<f32>) -> vec2<f32> {
    return link(cell, next) * (velocity_before(next) - here);
}

fn diffused(cell: vec2<i32>) -> vec2<f32> {
    let here = velocity_before(cell);
    let across = difference(cell, cell + WEST, here) + difference(cell, cell + EAST, here);
    let along = difference(cell, cell + NORTH, here) + difference(cell, cell + SOUTH, here);
    return here + constants.viscosity * (across + along);
}
