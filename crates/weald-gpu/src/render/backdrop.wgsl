// What lies behind the landscape: the plain on which it stands, or the haze in which all ground around it is lost; and
// the sky.

fn backdrop_direction(position: vec2<f32>) -> vec3<f32> {
    return normalize(along_at(position));
}

@fragment
fn sky_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let direction = backdrop_direction(position.xy);
    let radiance = veil_before_sky(sky_radiance_with_sun(direction), frame.eye.xyz, direction);
    return vec4<f32>(limited(with_clouds(frame.eye.xyz, direction, radiance, frame.eye.w)), 1.0);
}

@fragment
fn plain_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let direction = backdrop_direction(position.xy);
    if HORIZON {
        return vec4<f32>(farthest_radiance(direction), 1.0);
    }
    let ray_length = max((scene.plain.w - frame.eye.z) / direction.z, 0.0);
    let point = frame.eye.xyz + direction * ray_length;
    let sun = sun_seen(point, vec3<f32>(0.0, 0.0, 1.0));
    return vec4<f32>(limited(plain_radiance(frame.eye.xyz, direction, ray_length, sun)), 1.0);
}
