// Water where the ground is looked at: what it mirrors, and what comes out of it.

fn water_radiance(
    place: vec2<f32>,
    point: vec3<f32>,
    direction: vec3<f32>,
    way: f32,
    depth: f32,
    sun: f32,
) -> vec3<f32> {
    let back = -direction;
    let footprint = way * frame.eye.w / sqrt(max(back.z, 0.05));
    let normal = ripples(point.xy, min(0.25 * stage.scale.w, 6.0), footprint);
    let seen = seen_at(skylight, share_of(place));
    let share = mirrored_share(dot(back, normal));
    var away = reflect(direction, normal);
    away.z = max(away.z, 0.01);
    let reflection = sky_radiance(normalize(away));
    let light = stage.sunlight.xyz * (sun * stage.sun.z) + skylight_on(seen, vec3<f32>(0.0, 0.0, 1.0));
    let below = water_body(stage.gravel.xyz, depth, light);
    return mix(below, reflection, share) + stage.sunlight.xyz * (sun * glint(back, normal, stage.sun.xyz));
}
