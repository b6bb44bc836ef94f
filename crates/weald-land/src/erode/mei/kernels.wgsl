
// What one cell becomes in a step of Mei et al. 2007; the twin of kernels.rs.

const MIN_SINE: f32 = 0.05;

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
    let deposit = exact(constants.deposition * max(-room, 0.0));
    let ratio = constants.deposit_ratio;
    return Exchanged(change_before + ratio * deposit, found - deposit, (1.0 - ratio) * deposit);
}

/// Sediment in a unit of water.
fn load(sediment: f32, depth: f32, outflow: vec4<f32>, epsilon: f32) -> f32 {
    let most = max(depth, 0.0) + epsilon;
    return sediment / select(max(most, sum_of(outflow)), most, LIMITER);
}
