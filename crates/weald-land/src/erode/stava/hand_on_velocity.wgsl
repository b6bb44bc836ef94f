
// What advection needs of the erosion.

fn hand_on(at: u32, velocity: vec2<f32>, sediment: f32) {
    velocities[at] = velocity;
}
