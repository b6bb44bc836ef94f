// Light of clouds that a window's picture before has, taken for the next one, as `reprojection.wgsl` takes that of the ground:
// from where the point at which a ray meets the lower part of clouds was seen then. Clouds do not move, and what is above or below
// that lies off by a pixel in the mean while the eye moves little for its distance.

@group(2) @binding(9) var clouds_light_before: texture_2d<f32>;

// What canvases of clouds have as their share of the sky where none were drawn.
const NO_CLOUDS_DRAWN = -1.0;

// One block in so many is lit anew whatever its turn: what moves across the picture as fast as turns do would never be.
const ALSO_DUE = 8u;

// The share of their height at which a ray is said to meet clouds.
const MET_AT = 0.25;

// Pixels by which their base and their tops may lie off that, by the mean of both; and the share of the height up to there by which
// the eye may have moved, since haze before them changes.
const OFF_AT_MOST = 1.0;
const SAME_EYE = 0.1;

// Whether a texel is lit anew.
fn are_clouds_due(position: vec2<f32>) -> bool {
    let block = vec2<i32>(position) / i32(BLOCK);
    let camera = bitcast<vec3<u32>>(frame.before_forward.xyz);
    let random = grain_bits(block.x, block.y, camera.x ^ (camera.y * 3u) ^ (camera.z * 5u));
    return is_due(position) | (random % ALSO_DUE == 0u);
}

// Where clouds in a direction were in the picture before, in texels; outside of it where they were not.
fn clouds_place_before(direction: vec3<f32>) -> vec2<f32> {
    let thick = CLOUDS_THICK * scene.scale.y;
    let rise = scene.cloud_height.x - frame.eye.z;
    let reach = (rise + MET_AT * thick) / max(direction.z, 1e-5);
    let relative = direction * reach + frame.before_eye.xyz;
    let before = place_before(relative, textureDimensions(clouds_light_before));
    // Base and tops are seen turned by as much as the way of the eye is of their distances.
    let off = 0.5 * length(frame.before_eye.xyz) * direction.z * thick / (max(rise, 1e-3) * (rise + thick));
    let is_near = (off <= OFF_AT_MOST * frame.eye.w) & (length(frame.before_eye.xyz) <= SAME_EYE * (rise + MET_AT * thick));
    return select(vec2<f32>(-9.0), before.xy, is_near & (before.z > frame.forward.w) & (direction.z > 1e-3));
}

// The clouds that were seen there, between four texels; none drawn where one of them was not.
fn clouds_seen_before(place: vec2<f32>) -> vec4<f32> {
    let size = textureDimensions(clouds_light_before);
    let around = between_texels(place);
    var sum = vec4<f32>(0.0);
    var is_drawn = all(around.first >= vec2<f32>(0.0)) && all(around.first + around.share <= vec2<f32>(size - 1u));
    var corner = 0;
    loop {
        let here = corner_of(around, corner, size);
        let clouds = textureLoad(clouds_light_before, here.texel, 0);
        sum += here.weight * clouds;
        is_drawn = is_drawn && (clouds.w >= 0.0 || here.weight == 0.0);
        corner++;
        if corner >= 4 {
            break;
        }
    }
    return select(vec4<f32>(0.0, 0.0, 0.0, NO_CLOUDS_DRAWN), sum, is_drawn);
}

@fragment
fn clouds_before_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if !meets_sky(position.xy) {
        discard;
    }
    let direction = backdrop_direction(2.0 * position.xy);
    var clouds = clouds_seen_before(clouds_place_before(direction));
    if clouds.w < 0.0 || are_clouds_due(position.xy) {
        let marched = clouds_before(frame.eye.xyz, direction, frame.eye.w);
        clouds = vec4<f32>(limited(marched.xyz), marched.w);
    }
    return clouds;
}
