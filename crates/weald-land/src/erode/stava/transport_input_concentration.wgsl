
// What upwind transport needs of the erosion.

fn store_transport_input(at: u32, velocity: vec2<f32>, sediment: f32) {
    concentration[at] = sediment / (max(levels[at].y, 0.0) + constants.epsilon);
}
