
/// Constants of the sliding; the twin of `SlideConstants`.
struct SlideConstants {
    talus: f32,
    strength: f32,
}
