
// Transport finds all that it needs of the erosion where it is.

fn store_transport_input(at: u32, velocity: vec2<f32>, sediment: f32) {}
