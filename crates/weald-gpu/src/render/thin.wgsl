// The light of what is thin and green, from either side: it sends light back, and some shines through, yellower.

// The light of a leaf at a point, which sees shares of the sun and of the sky, lets a share of light through, and looks
// to the sky so much more than its side does.
fn leaf_light(
    colour: vec3<f32>,
    point: vec3<f32>,
    side: vec3<f32>,
    light: vec2<f32>,
    through: f32,
    skyward: f32,
) -> vec4<f32> {
    let relative = point - frame.eye.xyz;
    let ray_length = length(relative);
    let direction = relative / ray_length;
    var normal = normalize(side);
    if dot(normal, direction) > 0.0 {
        normal = -normal;
    }
    let facing = dot(normal, scene.sun.xyz);
    let shining = through * max(-facing, 0.0) * vec3<f32>(1.15, 1.05, 0.55);
    let sun = scene.sunlight.xyz * light.x * (max(facing, 0.0) + shining);
    let up = normalize(normal + vec3<f32>(0.0, 0.0, skyward));
    let sky = skylight_on(seen_at(skylight, share_of(place_of(point))), up) * light.y;
    let radiance = colour * (sun + sky) / PI;
    return vec4<f32>(limited(veil(radiance, frame.eye.xyz, direction, ray_length)), OTHER_LIGHT);
}
