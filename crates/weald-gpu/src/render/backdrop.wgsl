// What lies behind the landscape: the plain on which it stands, or the haze in which all ground around it is lost; and
// the sky.

fn backdrop_direction(position: vec2<f32>) -> vec3<f32> {
    return normalize(along_at(position));
}

// The light of clouds and the share of the sky between them, in half as many columns and rows as the picture has: clouds have
// soft edges, and marching through them takes longer than all else of the sky.
@group(2) @binding(5) var cloud_light: texture_2d<f32>;

// The sky in a direction, without its clouds.
fn clear_sky(direction: vec3<f32>) -> vec3<f32> {
    return veil_before_sky(sky_radiance_with_sun(direction), frame.eye.xyz, direction);
}

// Whether the sky is seen in some pixel whose clouds are interpolated from a texel.
fn meets_sky(texel: vec2<f32>) -> bool {
    let last = vec2<i32>(textureDimensions(front_depths)) - 1;
    var farthest = 1.0;
    for (var look = 0; look < 16; look++) {
        let pixel = 2 * vec2<i32>(texel) + vec2<i32>(look % 4, look / 4) - 1;
        for (var sample = 0; sample < select(1, 4, SAMPLED); sample++) {
            farthest = min(farthest, textureLoad(front_depths, clamp(pixel, vec2<i32>(0), last), sample));
        }
    }
    return farthest <= 0.0;
}

// Whether the eye is above the base of clouds, which are then before all else; at any place of the picture.
fn is_over_clouds(position: vec2<f32>) -> bool {
    return is_above(frame.eye.z, scene.cloud_height.x, position.x);
}

@fragment
fn clouds_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    // The canvas has no clouds where none are drawn; software leaves a shader for good when it draws no pixel of a few.
    if !(is_over_clouds(position.xy) | meets_sky(position.xy)) {
        discard;
    }
    let clouds = clouds_before(frame.eye.xyz, backdrop_direction(2.0 * position.xy), frame.eye.w);
    return vec4<f32>(limited(clouds.xyz), clouds.w);
}

// The clouds at a place of the picture.
fn clouds_at(position: vec2<f32>) -> vec4<f32> {
    let place = 0.5 * position / vec2<f32>(textureDimensions(cloud_light));
    return textureSampleLevel(cloud_light, between, place, 0.0);
}

@fragment
fn sky_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    var radiance = clear_sky(backdrop_direction(position.xy));
    if CLOUDS {
        let clouds = clouds_at(position.xy);
        radiance = select(clouds.xyz + clouds.w * radiance, radiance, is_over_clouds(position.xy));
    }
    return vec4<f32>(limited(radiance), 1.0);
}

// Clouds that an eye above them sees before all that is drawn.
@fragment
fn clouds_over_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return clouds_at(position.xy);
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
