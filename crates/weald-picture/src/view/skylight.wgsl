// Twin of `skylight.rs`: light of the sky on the ground, with what mountains hide of it.

struct Seen {
    red: vec3<f32>,
    green: vec3<f32>,
    blue: vec3<f32>,
    even: vec3<f32>,
}

// Visible sky at a place that is counted in shares of the map.
fn seen_at(light: texture_2d_array<f32>, share: vec2<f32>) -> Seen {
    let a = textureSampleLevel(light, between, share, 0, 0.0);
    let b = textureSampleLevel(light, between, share, 1, 0.0);
    let c = textureSampleLevel(light, between, share, 2, 0.0);
    return Seen(a.xyz, vec3<f32>(a.w, b.xy), vec3<f32>(b.zw, c.x), c.yzw);
}

fn open_sky() -> Seen {
    return Seen(scene.open_red.xyz, scene.open_green.xyz, scene.open_blue.xyz, scene.open_even.xyz);
}

// What falls on a normal: light of the visible sky, and what the hidden part of it sends back.
fn skylight_on(seen: Seen, normal: vec3<f32>) -> vec3<f32> {
    let hidden = PI - clamp(dot(normal, seen.even), 0.0, PI);
    let direct = vec3<f32>(dot(normal, seen.red), dot(normal, seen.green), dot(normal, seen.blue));
    return max(direct, vec3<f32>(0.0)) + hidden * scene.bounce.xyz;
}
