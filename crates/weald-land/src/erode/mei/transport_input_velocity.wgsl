
// What advection needs of the exchange.

fn store_transport_input(at: u32, speed: vec2<f32>, sediment: f32, depth: f32) {
    velocities[at] = speed;
}
