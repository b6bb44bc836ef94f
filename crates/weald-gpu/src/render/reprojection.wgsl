// Light of the ground that the picture before has: it depends little on where the eye is, so that it is taken from the place
// at which its point was seen then, and made anew for one pixel in eight and wherever it was not seen (`reprojection.rs`).

@group(2) @binding(6) var light_before: texture_2d<f32>;
@group(2) @binding(7) var depths_before: texture_depth_2d;

// What the light of ground has as its opacity: 1 where it was made anew, less by AGE for each picture that took it, in the mean of the
// pixels that it was taken from, and nothing where something else than ground is seen. A block in whose middle it is as old as OLDEST is lit anew as a whole, for
// which software takes as long as for one of its pixels; what is in the mean as old as LAST elsewhere is not taken either.
const AGE = 0.0625;
const OLDEST = 0.5;
const LAST = 0.3;

// Pixels along the side of a block: software lights four by four at once. One block in so many is due in each picture.
const BLOCK = 4u;
const TURNS = 8u;

// By which share the depth of the same point may differ: between depths it is interpolated, which is exact on planes.
const SAME_POINT = 0.01;

// The same of a point beside one that was hidden, and how many texels away it may lie.
const NEAR_POINT = 0.03;
const AROUND_HIDDEN = 2;

// How far off the middle of a pixel counts as there, in pixels: what is rounded does not blur a camera that stands still.
const AT_REST = 0.015625;

// By which share a point may be nearer or farther than before: haze and detail go by it.
const SAME_DISTANCE = 0.06;

// Least share of the texels around a place that must show ground.
const SEEN_BEFORE = 0.5;

// Whether a pixel is lit anew by its turn: turns return sooner where the camera stands still.
fn is_due(position: vec2<f32>) -> bool {
    let block = vec2<u32>(position) / BLOCK;
    return (block.x + 3u * block.y) % TURNS % u32(frame.before_eye.w) == u32(frame.before_forward.w);
}

// Where a point relative to the eye of the picture before was in that, in texels of a canvas of such a size, and how far ahead.
fn place_before(relative: vec3<f32>, size: vec2<u32>) -> vec3<f32> {
    let ahead = dot(relative, frame.before_forward.xyz);
    let aside = vec2<f32>(dot(relative, frame.before_right.xyz), -dot(relative, frame.before_up.xyz));
    let half = vec2<f32>(frame.before_right.w, frame.before_up.w);
    return vec3<f32>((0.5 + 0.5 * aside / (half * max(ahead, frame.forward.w))) * vec2<f32>(size), ahead);
}

// The first of the four texels around a place, and how far it is on the way to the others.
struct Between {
    first: vec2<f32>,
    share: vec2<f32>,
}

fn between_texels(place: vec2<f32>) -> Between {
    let nearest = round(place - 0.5);
    let middle = select(place - 0.5, nearest, abs(place - 0.5 - nearest) < vec2<f32>(AT_REST));
    let first = floor(middle);
    return Between(first, middle - first);
}

// A corner of the four: its texel, within the canvas, and its weight.
struct Corner {
    texel: vec2<i32>,
    weight: f32,
}

fn corner_of(around: Between, corner: i32, size: vec2<u32>) -> Corner {
    let aside = vec2<i32>(corner & 1, corner >> 1u);
    let weights = select(1.0 - around.share, around.share, aside == vec2<i32>(1));
    let texel = clamp(vec2<i32>(around.first) + aside, vec2<i32>(0), vec2<i32>(size) - 1);
    return Corner(texel, weights.x * weights.y);
}

// Where a point of this picture was in the one before, in pixels, and how deep; 0 where its light would be another one now.
fn seen_before(position: vec2<f32>, depth: f32) -> vec3<f32> {
    let here = along_at(position) * (frame.forward.w / depth);
    let relative = here + frame.before_eye.xyz;
    let before = place_before(relative, textureDimensions(light_before));
    let ahead = before.z;
    let distance = length(here);
    let is_alike = abs(length(relative) - distance) <= SAME_DISTANCE * distance;
    return vec3<f32>(before.xy, select(0.0, frame.forward.w / ahead, is_alike && ahead > frame.forward.w));
}

// The light of ground at such a place and depth, with its age; none where it is too old, or was not seen.
fn light_seen_before(place: vec3<f32>) -> vec4<f32> {
    let size = textureDimensions(light_before);
    let around = between_texels(place.xy);
    var sum = vec3<f32>(0.0);
    var depth = 0.0;
    var seen = 0.0;
    var youth = 0.0;
    var corner = 0;
    loop {
        let here = corner_of(around, corner, size);
        let light = textureLoad(light_before, here.texel, 0);
        let lit = select(0.0, here.weight, light.w > 0.0);
        sum += lit * light.xyz;
        depth += here.weight * textureLoad(depths_before, here.texel, 0);
        seen += lit;
        youth += lit * light.w;
        corner++;
        if corner >= 4 {
            break;
        }
    }
    let is_within = all(place.xy >= vec2<f32>(0.0)) && all(place.xy <= vec2<f32>(size));
    let is_same = is_within && place.z > 0.0 && abs(depth - place.z) <= SAME_POINT * place.z;
    if is_same && seen <= SEEN_BEFORE {
        let near = light_near(vec2<i32>(round(place.xy - 0.5)), place.z);
        return select(vec4<f32>(0.0), vec4<f32>(near.xyz, near.w - AGE), near.w > LAST);
    }
    // Of what is between pixels the age is between theirs: by the oldest of them ages would spread.
    let mean = vec4<f32>(sum, youth) / max(seen, 1e-6);
    let is_known = is_same && mean.w > LAST;
    return select(vec4<f32>(0.0), vec4<f32>(mean.xyz, mean.w - AGE), is_known);
}

// The light of the ground nearest to a texel that something hid, with its age: where blades sway before ground, or move across
// it as the eye does, most of it is hidden by turns. None where nothing of the same depth was seen around.
fn light_near(texel: vec2<i32>, depth: f32) -> vec4<f32> {
    let last = vec2<i32>(textureDimensions(light_before)) - 1;
    var found = vec4<f32>(0.0);
    var step = 0;
    loop {
        // Rightward and leftward, then down and up: along a row ground is as far.
        let away = 1 + step / 4;
        let side = select(-away, away, (step & 1) == 0);
        let at = clamp(texel + select(vec2<i32>(0, side), vec2<i32>(side, 0), (step & 2) == 0), vec2<i32>(0), last);
        let light = textureLoad(light_before, at, 0);
        let is_near = abs(textureLoad(depths_before, at, 0) - depth) <= NEAR_POINT * depth;
        if light.w > 0.0 && is_near {
            found = light;
        }
        step++;
        if step >= 4 * AROUND_HIDDEN || found.w > 0.0 {
            break;
        }
    }
    return found;
}

// Whether the light in the middle of a pixel's block is so old that all of the block is lit anew.
fn is_block_old(position: vec2<f32>) -> bool {
    let end = vec2<f32>(textureDimensions(ground_depths)) - 0.5;
    let middle = min(floor(position / f32(BLOCK)) * f32(BLOCK) + vec2<f32>(2.5), end);
    let depth = textureLoad(ground_depths, vec2<i32>(middle), 0);
    let place = seen_before(middle, max(depth, 1e-9)).xy;
    let last = vec2<i32>(textureDimensions(light_before)) - 1;
    let light = textureLoad(light_before, clamp(vec2<i32>(place), vec2<i32>(0), last), 0);
    return depth > 0.0 && light.w > 0.0 && light.w <= OLDEST;
}

@fragment
fn reprojected_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let depth = textureLoad(ground_depths, vec2<i32>(position.xy), 0);
    if (depth <= 0.0) | is_hidden(position.xy, 0) | is_due(position.xy) | is_block_old(position.xy) {
        discard;
    }
    let light = light_seen_before(seen_before(position.xy, depth));
    if light.w <= 0.0 {
        discard;
    }
    return light;
}
