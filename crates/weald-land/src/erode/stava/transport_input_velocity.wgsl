
// What advection needs of the erosion.

fn store_transport_input(at: u32, velocity: vec2<f32>, sediment: f32) {
    velocities[at] = velocity;
}
