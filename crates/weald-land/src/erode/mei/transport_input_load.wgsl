
// What upwind transport needs of the exchange.

fn store_transport_input(at: u32, speed: vec2<f32>, sediment: f32, depth: f32) {
    concentration[at] = load(sediment, depth, outflows[at], constants.epsilon);
}
