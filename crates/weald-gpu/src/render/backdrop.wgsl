// What lies behind the landscape: the plain on which it stands, and the sky.

struct BackdropVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) direction: vec3<f32>,
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> BackdropVertex {
    let at = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    let direction = frame.forward.xyz + at.x * frame.right.w * frame.right.xyz + at.y * frame.up.w * frame.up.xyz;
    return BackdropVertex(vec4<f32>(at, 0.0, 1.0), direction);
}

@fragment
fn backdrop_fragment(in: BackdropVertex) -> @location(0) vec4<f32> {
    let direction = normalize(in.direction);
    if direction.z >= 0.0 {
        return vec4<f32>(limited(sky_radiance_with_sun(direction)), 1.0);
    }
    let ray_length = max((scene.plain.w - frame.eye.z) / direction.z, 0.0);
    let point = frame.eye.xyz + direction * ray_length;
    let sun = sun_seen(point, vec3<f32>(0.0, 0.0, 1.0));
    return vec4<f32>(limited(plain_radiance(frame.eye.xyz, direction, ray_length, sun)), 1.0);
}
