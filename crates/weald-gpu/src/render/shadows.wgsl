// The share of the sun's disc that is seen from a point.

fn sun_seen(point: vec3<f32>, normal: vec3<f32>) -> f32 {
    return 1.0;
}
