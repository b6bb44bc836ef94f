
/// The share of the steps of a triangle that slides.
fn sliding_share(step_x: f32, step_y: f32) -> f32 {
    let slope = sqrt(step_x * step_x + step_y * step_y);
    return select(0.0, constants.strength * (slope - constants.talus) / slope, slope > constants.talus);
}

/// The share that slides of the triangle of a cell with its neighbours in two directions.
fn triangle_share(cell: vec2<i32>, along: vec2<i32>, across: vec2<i32>) -> f32 {
    let here = ground(cell);
    let share = sliding_share(here - ground(cell + along), here - ground(cell + across));
    return share * (link(cell, cell + along) * link(cell, cell + across));
}
