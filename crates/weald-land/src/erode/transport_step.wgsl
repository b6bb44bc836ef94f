
/// Constants of the transport; the twin of `CarryConstants`.
struct CarryConstants {
    epsilon: f32,
}
