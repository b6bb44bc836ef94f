
// What upwind transport needs of the erosion.

fn hand_on(at: u32, velocity: vec2<f32>, sediment: f32) {
    concentration[at] = sediment / (max(levels[at].y, 0.0) + constants.epsilon);
}
