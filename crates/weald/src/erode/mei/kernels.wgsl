
// What one cell becomes in a step of Mei et al. 2007; the twin of kernels.rs. Vectors of outflows hold those to
// the east, west, south and north.

const LEAST_SINE: f32 = 0.05;

/// What leaves a cell.
fn sum_of(outflow: vec4<f32>) -> f32 {
    return (outflow.x + outflow.y) + (outflow.z + outflow.w);
}

/// The four outflows scaled to the water that the cell has.
fn scaled(wanted: vec4<f32>, depth: f32) -> vec4<f32> {
    let sum = sum_of(wanted);
    let afford = max(depth * (1.0 - KEPT), 0.0);
    return wanted * select(1.0, afford / sum, sum > afford);
}

/// Velocity of the water that flowed; `came` holds what came from the east, west, south and north.
fn flow_velocity(outflow: vec4<f32>, came: vec4<f32>, mean_depth: f32, velocity_epsilon: f32) -> vec2<f32> {
    let per_depth = select(0.0, 0.5 / mean_depth, mean_depth > velocity_epsilon);
    let eastward = ((came.y - outflow.y) + (outflow.x - came.x)) * per_depth;
    let southward = ((came.w - outflow.w) + (outflow.z - came.z)) * per_depth;
    return vec2<f32>(eastward, southward);
}

/// Change of the ground, sediment in the water, and the part of the deposit that shrinking takes out.
struct Exchanged {
    change: f32,
    sediment: f32,
    lost: f32,
}

/// What water with `room` for sediment takes from the ground, or gives to it where room is negative.
fn exchange_for(room: f32, found: f32, change_before: f32) -> Exchanged {
    if (room > 0.0) {
        let eroded = exact(change_before - constants.erosion * max(room, 0.0));
        return Exchanged(eroded, found + (change_before - eroded), 0.0);
    }
    let deposit = constants.deposition * max(-room, 0.0);
    let ratio = constants.deposit_ratio;
    return Exchanged(change_before + ratio * deposit, found - deposit, (1.0 - ratio) * deposit);
}

/// Sediment in a unit of water.
fn load(sediment: f32, depth: f32, outflow: vec4<f32>, epsilon: f32) -> f32 {
    let most = max(depth, 0.0) + epsilon;
    return sediment / select(max(most, sum_of(outflow)), most, LIMITER);
}
