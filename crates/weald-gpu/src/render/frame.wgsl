// What one picture is drawn from, and where points of the scene lie in it.

struct Frame {
    // The eye, and the angle of a pixel.
    eye: vec4<f32>,
    // Directions of the camera; with the nearest distance that is drawn, and the tangents of half its angles.
    forward: vec4<f32>,
    right: vec4<f32>,
    up: vec4<f32>,
    // Place of the eye, its height above all ground, and 1 where water is left out so that it can be timed.
    stand: vec4<f32>,
    // Seconds since the beginning, and the point from which detail is chosen: the eye.
    moment: vec4<f32>,
    // Distances between which the vertices of each level slide.
    slides: array<vec4<f32>, 26>,
    // Directions across the sun's rays; with the height from which depths count, and their range.
    sun_right: vec4<f32>,
    sun_up: vec4<f32>,
    // Middle and half the sides of each cascade, along those directions.
    cascades: array<vec4<f32>, 4>,
    // From where is chosen what all cascades but the last hold; with how far the eye is from there at most.
    detail_points: array<vec4<f32>, 3>,
    // How far trees of woods are drawn one by one, in metres; 0 where none are.
    woods: vec4<f32>,
    // How much of each cascade counts.
    cascade_shares: vec4<f32>,
    // 1 for each cascade that is drawn anew.
    stale: vec4<f32>,
    // Where this eye is from that of the picture before, and the directions of its camera; with the number of turns in which
    // pixels are lit anew, the turn, and the tangents of half its angles.
    before_eye: vec4<f32>,
    before_forward: vec4<f32>,
    before_right: vec4<f32>,
    before_up: vec4<f32>,
    // What a pixel spans across and down, at a distance of 1; how many times as far as in a moving picture blades of grass reach,
    // and metres up to which all of them stand where they reach no farther.
    pixel: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// The share of the trees of woods that are drawn one by one around a point: the others are on its ground alone.
fn drawn_as_trees(point: vec3<f32>) -> f32 {
    return drawn_as_trees_at(length(point - frame.moment.yzw));
}

// The same at a distance.
fn drawn_as_trees_at(distance: f32) -> f32 {
    let reach = frame.woods.x;
    return clamp((reach - distance) / max(0.4 * reach, 1e-3), 0.0, 1.0);
}

// What the light of ground has as its opacity, and that of all that stands before it: only the former is taken for the next
// picture (`reprojection.wgsl`).
const GROUND_LIGHT = 1.0;
const OTHER_LIGHT = 0.0;

// Depth is 1 at the nearest distance and 0 infinitely far, which is what keeps all digits of floating point.
fn projected(point: vec3<f32>) -> vec4<f32> {
    let relative = point - frame.eye.xyz;
    return vec4<f32>(
        dot(relative, frame.right.xyz) / frame.right.w,
        dot(relative, frame.up.xyz) / frame.up.w,
        frame.forward.w,
        dot(relative, frame.forward.xyz),
    );
}

// The direction in which a place of the picture looks, as long as makes it 1 forward.
fn along_at(position: vec2<f32>) -> vec3<f32> {
    let at = frame.pixel.xy * position - vec2<f32>(frame.right.w, frame.up.w);
    return frame.forward.xyz + at.x * frame.right.xyz - at.y * frame.up.xyz;
}

// The point of the picture at such a depth.
fn point_at(position: vec2<f32>, depth: f32) -> vec3<f32> {
    return frame.eye.xyz + along_at(position) * (frame.forward.w / depth);
}

// Whether a ball of a radius around a point, seen from the eye, may be in the picture.
fn is_in_sight(away: vec3<f32>, radius: f32) -> bool {
    let depth = dot(away, frame.forward.xyz);
    let aside = vec2<f32>(dot(away, frame.right.xyz), dot(away, frame.up.xyz));
    let half = vec2<f32>(frame.right.w, frame.up.w);
    return depth > -radius && all(abs(aside) <= depth * half + radius * sqrt(1.0 + half * half));
}
