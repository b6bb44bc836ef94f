
// Random numbers for lattice points; the twin of hash.rs. A plane is its start and its key.

const STEP_EAST: u32 = 3242174889u;
const STEP_SOUTH: u32 = 2447445413u;

/// The number of a point, to which `STEP_EAST` and `STEP_SOUTH` may be added.
fn point_of(plane: vec2<u32>, x: i32, y: i32) -> u32 {
    return u32(x) * STEP_EAST + (u32(y) * STEP_SOUTH + plane.x);
}

/// 32 random bits for a point.
fn bits_of(plane: vec2<u32>, point: u32) -> u32 {
    var bits = point ^ (point >> 16u);
    bits = bits * 0x7feb352du;
    bits ^= (bits >> 15u) ^ plane.y;
    return bits * 0x846ca68bu;
}

/// Uniform in [-1, 1).
fn signed_of(plane: vec2<u32>, x: i32, y: i32) -> f32 {
    return f32(bitcast<i32>(bits_of(plane, point_of(plane, x, y))) >> 8u) * (1.0 / 8388608.0);
}
