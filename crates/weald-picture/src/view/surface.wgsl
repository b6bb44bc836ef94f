// Twin of `surface.rs`: the cubic B-spline of a map's control points, at any place.

fn spline_weights(t: f32) -> vec4<f32> {
    let s = 1.0 - t;
    let sixth = 1.0 / 6.0;
    return vec4<f32>(
        s * s * s * sixth,
        ((3.0 * t - 6.0) * t * t + 4.0) * sixth,
        (((3.0 - 3.0 * t) * t + 3.0) * t + 1.0) * sixth,
        t * t * t * sixth,
    );
}

fn spline_slopes(t: f32) -> vec4<f32> {
    let s = 1.0 - t;
    return vec4<f32>(-0.5 * s * s, (1.5 * t - 2.0) * t, (1.0 - 1.5 * t) * t + 0.5, 0.5 * t * t);
}

// Whether a number that all pixels share is above another. Software (lavapipe) copies the whole shader at each draw in which a
// condition hangs on such numbers alone, to work it out beforehand: one that is never negative keeps it from that.
fn is_above(number: f32, bound: f32, never_negative: f32) -> bool {
    return number + min(never_negative, 0.0) > bound;
}

// Cells from which no place is as far.
const FAR_AWAY = 1e30;

// The patch of a place, and where in it the place lies.
fn spline_patch(place: vec2<f32>) -> vec2<f32> {
    return min(floor(max(place, vec2<f32>(0.0))), scene.grid.xy);
}

fn control_row(controls: texture_2d<f32>, patch_of: vec2<i32>, row: i32) -> vec4<f32> {
    let at = patch_of + vec2<i32>(0, row);
    return vec4<f32>(
        textureLoad(controls, at, 0).x,
        textureLoad(controls, at + vec2<i32>(1, 0), 0).x,
        textureLoad(controls, at + vec2<i32>(2, 0), 0).x,
        textureLoad(controls, at + vec2<i32>(3, 0), 0).x,
    );
}

// The value at a place and its rise by the cell eastward and southward.
fn spline_with_slope(controls: texture_2d<f32>, place: vec2<f32>) -> vec3<f32> {
    let first = spline_patch(place);
    let within = clamp(place - first, vec2<f32>(0.0), vec2<f32>(1.0));
    let across = spline_weights(within.x);
    let along = spline_slopes(within.x);
    let corner = vec2<i32>(first);
    let a = control_row(controls, corner, 0);
    let b = control_row(controls, corner, 1);
    let c = control_row(controls, corner, 2);
    let d = control_row(controls, corner, 3);
    let rows = vec4<f32>(dot(across, a), dot(across, b), dot(across, c), dot(across, d));
    let rise = vec4<f32>(dot(along, a), dot(along, b), dot(along, c), dot(along, d));
    let down = spline_weights(within.y);
    return vec3<f32>(dot(down, rows), dot(down, rise), dot(spline_slopes(within.y), rows));
}

// The value at a place; beyond the landscape that of its border.
fn spline_at(controls: texture_2d<f32>, place: vec2<f32>) -> f32 {
    let first = spline_patch(place);
    let within = clamp(place - first, vec2<f32>(0.0), vec2<f32>(1.0));
    let across = spline_weights(within.x);
    let corner = vec2<i32>(first);
    let rows = vec4<f32>(
        dot(across, control_row(controls, corner, 0)),
        dot(across, control_row(controls, corner, 1)),
        dot(across, control_row(controls, corner, 2)),
        dot(across, control_row(controls, corner, 3)),
    );
    return dot(spline_weights(within.y), rows);
}

// Texture coordinates and weights of the four looks between control points that give the spline of a map: Sigg and
// Hadwiger 2005, GPU Gems 2, chapter 20.
struct SplineLooks {
    low: vec2<f32>,
    high: vec2<f32>,
    share: vec2<f32>,
}

fn spline_looks(scene_place: vec2<f32>, controls: vec2<f32>) -> SplineLooks {
    // The ground may be drawn on finer cells than the map has.
    let cells = max(controls - 4.0, vec2<f32>(1.0));
    let place = 0.5 + (scene_place - 0.5) * (cells / scene.grid.xy);
    let first = min(floor(max(place, vec2<f32>(0.0))), cells);
    let within = clamp(place - first, vec2<f32>(0.0), vec2<f32>(1.0));
    let x = spline_weights(within.x);
    let y = spline_weights(within.y);
    let low = vec2<f32>(x.x + x.y, y.x + y.y);
    let high = vec2<f32>(x.z + x.w, y.z + y.w);
    var looks: SplineLooks;
    looks.low = (first + 0.5 + vec2<f32>(x.y, y.y) / low) / controls;
    looks.high = (first + 2.5 + vec2<f32>(x.w, y.w) / high) / controls;
    looks.share = high;
    return looks;
}

fn smooth_at(controls: texture_2d<f32>, place: vec2<f32>) -> vec4<f32> {
    let looks = spline_looks(place, vec2<f32>(textureDimensions(controls)));
    let above = mix(
        textureSampleLevel(controls, between, looks.low, 0.0),
        textureSampleLevel(controls, between, vec2<f32>(looks.high.x, looks.low.y), 0.0),
        looks.share.x,
    );
    let below = mix(
        textureSampleLevel(controls, between, vec2<f32>(looks.low.x, looks.high.y), 0.0),
        textureSampleLevel(controls, between, looks.high, 0.0),
        looks.share.x,
    );
    return mix(above, below, looks.share.y);
}

// The point of a place at a height, and back.
fn point_of(place: vec2<f32>, height: f32) -> vec3<f32> {
    return vec3<f32>((place.x - 0.5) * scene.grid.z, (0.5 - place.y) * scene.grid.w, height);
}

fn place_of(point: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(0.5 + point.x / scene.grid.z, 0.5 - point.y / scene.grid.w);
}

// A place in shares of the landscape.
fn share_of(place: vec2<f32>) -> vec2<f32> {
    return (place - 0.5) / scene.grid.xy;
}

// The upward normal of a surface that rises so many metres a cell.
fn normal_of(rise: vec2<f32>) -> vec3<f32> {
    return normalize(vec3<f32>(-rise.x / scene.grid.z, rise.y / scene.grid.w, 1.0));
}
