// What is seen at places of a picture: a point of the ground or of the water on it, of a cut side, or nothing of the land.

// Places in pixels from the upper left corner; beyond it where nothing is asked.
@group(2) @binding(2) var<storage, read> asked: array<vec2<f32>>;
// Points, and what they belong to.
@group(2) @binding(3) var<storage, read_write> answered: array<vec4<f32>>;

const NOTHING = 0.0;
const GROUND = 1.0;
const SIDE = 2.0;

// Pixels by which triangles may lie below the smooth ground, and rounds in which a ray finds it from there.
const BELOW_GROUND = 1.5;
const ROUNDS = 4;

// Where in a pixel its samples lie.
const SPOTS = array<vec2<f32>, 4>(
    vec2<f32>(0.375, 0.125), vec2<f32>(0.875, 0.375), vec2<f32>(0.125, 0.625), vec2<f32>(0.625, 0.875),
);

// The sample of its pixel that lies nearest to a place, and where that is.
struct NearestSample {
    number: i32,
    spot: vec2<f32>,
}

fn nearest_sample(position: vec2<f32>) -> NearestSample {
    let pixel = floor(position);
    if !SAMPLED {
        return NearestSample(0, pixel + 0.5);
    }
    let spots = SPOTS;
    var nearest = NearestSample(0, pixel + spots[0]);
    for (var number = 1; number < 4; number++) {
        let spot = pixel + spots[number];
        if distance(spot, position) < distance(nearest.spot, position) {
            nearest = NearestSample(number, spot);
        }
    }
    return nearest;
}

// How far along a ray, in lengths of `along`, the smooth ground is: from planes that touch it, where those lead there.
fn length_to_ground(along: vec3<f32>, start: f32) -> f32 {
    var ray_length = start;
    for (var round = 0; round < ROUNDS; round++) {
        let point = frame.eye.xyz + ray_length * along;
        let surface = spline_with_slope(top, place_of(point));
        let normal = normal_of(surface.yz);
        let fall = dot(normal, along);
        if abs(fall) < 1e-4 {
            return start;
        }
        ray_length += normal.z * (surface.x - point.z) / fall;
        if abs(ray_length - start) > 0.25 * start {
            return start;
        }
    }
    return ray_length;
}

fn picked(position: vec2<f32>) -> vec4<f32> {
    let nearest = nearest_sample(position);
    let depth = textureLoad(ground_depths, vec2<i32>(nearest.spot), nearest.number);
    if depth <= 0.0 {
        return vec4<f32>(vec3<f32>(0.0), NOTHING);
    }
    let point = point_at(nearest.spot, depth);
    let start = frame.forward.w / depth;
    let pixel = start * frame.eye.w;
    let surface = spline_at(top, place_of(point));
    if surface - point.z > BELOW_GROUND * pixel {
        return vec4<f32>(point, SIDE);
    }
    let along = along_at(position);
    let found = frame.eye.xyz + length_to_ground(along, start) * along;
    let place = place_of(found);
    let off = abs(found.z - spline_at(top, place));
    let answer = select(frame.eye.xyz + start * along, found, off < pixel);
    let inside = all(place >= vec2<f32>(0.5)) && all(place <= scene.grid.xy + 0.5);
    return vec4<f32>(answer, select(SIDE, GROUND, inside));
}

@compute @workgroup_size(64)
fn pick(@builtin(global_invocation_id) at: vec3<u32>) {
    if at.x >= arrayLength(&asked) {
        return;
    }
    let position = asked[at.x];
    let size = vec2<f32>(textureDimensions(ground_depths));
    if any(position < vec2<f32>(0.0)) || any(position >= size) {
        answered[at.x] = vec4<f32>(vec3<f32>(0.0), NOTHING);
    } else {
        answered[at.x] = picked(position);
    }
}
