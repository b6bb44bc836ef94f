
/// Rain and evaporation of one step, in cells.
struct Sky {
    rain: f32,
    evaporation: f32,
}
