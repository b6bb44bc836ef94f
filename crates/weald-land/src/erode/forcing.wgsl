
/// Rain and evaporation of one step, in cells.
struct Forcing {
    rain: f32,
    evaporation: f32,
}
