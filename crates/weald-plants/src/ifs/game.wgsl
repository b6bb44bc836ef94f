// Random iteration, a segment of the steps of a lane an invocation: the twin of lanes.rs, with the same draws.

const LANES: u32 = 64u;
const STEPS: u32 = 4096u;

struct Rules {
    root: vec4<f32>,
    // Bits of a code that count.
    kept: vec4<u32>,
    maps: u32,
    bits: u32,
    // Steps of a chunk before its first point.
    history: u32,
    // Steps after which it no longer matters where a lane began.
    forgotten: u32,
    // Points of a segment.
    segment: u32,
    coded: u32,
}

struct DispatchRange {
    // Workgroup with which the dispatch begins.
    first: u32,
    points: u32,
}

@group(0) @binding(0) var<uniform> rules: Rules;
@group(0) @binding(1) var<uniform> range: DispatchRange;
@group(0) @binding(2) var<storage, read> maps: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> bounds: array<u32>;
@group(0) @binding(4) var<storage, read> keys: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> rests: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> codes: array<vec4<u32>>;

@compute @workgroup_size(64)
fn play(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first_row = (range.first + group.x) * rules.segment;
    let key = keys[first_row / STEPS * LANES + lane];
    let begin = rules.history + first_row % STEPS;
    var at = rules.root.xyz;
    var code = vec4<u32>(0u);
    for (var step = begin - min(begin, rules.forgotten); step < begin + rules.segment; step++) {
        let digit = digit_of(draw(key, step));
        at = image(digit, at);
        code = pushed(code, digit);
        let point = (first_row + step - begin) * LANES + lane;
        if step >= begin && point < range.points {
            rests[point] = vec4<f32>(at, 0.0);
            if rules.coded != 0u {
                codes[point] = code & rules.kept;
            }
        }
    }
}

// 16 random bits for a step of a lane.
fn draw(key: vec2<u32>, step: u32) -> u32 {
    var bits = (step >> 1u) * 0x9e3779b9u + key.x;
    bits = (bits ^ (bits >> 16u)) * 0x7feb352du;
    bits = ((bits ^ (bits >> 15u)) + key.y) * 0x846ca68bu;
    bits ^= bits >> 16u;
    return select(bits & 0xffffu, bits >> 16u, (step & 1u) == 0u);
}

// The map whose bounds a draw lies between.
fn digit_of(draw: u32) -> u32 {
    var digit = 0u;
    var above = rules.maps;
    while above - digit > 1u {
        let middle = (digit + above) / 2u;
        if draw >= bounds[middle] {
            digit = middle;
        } else {
            above = middle;
        }
    }
    return digit;
}

// For a map of the plane what is added of z is nothing, and z stays 0.
fn image(digit: u32, at: vec3<f32>) -> vec3<f32> {
    let x = maps[3u * digit];
    let y = maps[3u * digit + 1u];
    let z = maps[3u * digit + 2u];
    return vec3<f32>(
        x.x * at.x + x.y * at.y + x.z * at.z + x.w,
        y.x * at.x + y.y * at.y + y.z * at.z + y.w,
        z.x * at.x + z.y * at.y + z.z * at.z + z.w,
    );
}

// The newest digit is the coarsest: all others move towards the fine end.
fn pushed(code: vec4<u32>, digit: u32) -> vec4<u32> {
    let rest = 32u - rules.bits;
    return (code >> vec4<u32>(rules.bits)) | (vec4<u32>(digit, code.xyz) << vec4<u32>(rest));
}
