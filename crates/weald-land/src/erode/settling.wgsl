
// How fast water runs, and what it takes from or gives to the ground; the twin of settling.rs.

/// Velocity through a face between two cells, in cells per step.
fn face_velocity(flux: f32, depth: f32, depth_next: f32, velocity_epsilon: f32) -> f32 {
    return flux / ((max(depth, 0.0) + max(depth_next, 0.0)) * 0.5 + velocity_epsilon);
}

/// Cell velocity from its eastern, western, southern and northern face.
fn cell_velocity(faces: vec4<f32>) -> vec2<f32> {
    return vec2<f32>((faces.y + faces.x) * 0.5, (faces.w + faces.z) * 0.5);
}

/// Change of the ground, sediment in the water, and the part of the deposit that shrinking takes out.
struct Settled {
    change: f32,
    sediment: f32,
    lost: f32,
}

/// Takes sediment from the ground, or gives it back where `taken` is negative.
fn settle_taken(found: f32, taken: f32, change: f32, ratio: f32) -> Settled {
    if (taken > 0.0) {
        let eroded = exact(change - max(taken, 0.0));
        return Settled(eroded, found + (change - eroded), 0.0);
    }
    let deposit = max(-taken, 0.0);
    return Settled(change + ratio * deposit, found - deposit, (1.0 - ratio) * deposit);
}
