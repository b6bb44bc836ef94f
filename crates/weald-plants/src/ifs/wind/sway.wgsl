// Where a pose of the wind puts points: the twin of sway.rs, with the same names and the same order of operations.

const ORDERS: u32 = 4u;
const PHASES: u32 = 64u;
const AT_JOINT: f32 = 0.7;
const LAG: u32 = 3u;
const SPREAD: u32 = 0x9e3779b1u;
const STEM: f32 = 0.0;
const BRANCH: f32 = 2.0;

struct Plant {
    root: vec4<f32>,
    bends: array<vec4<f32>, 6>,
    depth: u32,
    bits: u32,
}

struct Pose {
    wind: vec4<f32>,
    across: vec4<f32>,
    lean: vec4<f32>,
    swing: array<vec4<f32>, 64>,
}

struct DispatchRange {
    // Workgroup with which the dispatch begins.
    first: u32,
    points: u32,
}

struct Motion {
    turn: vec4<f32>,
    shift: vec3<f32>,
}

@group(0) @binding(0) var<uniform> plant: Plant;
@group(0) @binding(1) var<uniform> pose: Pose;
@group(0) @binding(2) var<uniform> range: DispatchRange;
@group(0) @binding(3) var<storage, read> rows: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> rests: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> codes: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read_write> swayed: array<vec4<f32>>;

@compute @workgroup_size(256)
fn sway(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) place: u32) {
    let point = (range.first + group.x) * 256u + place;
    if point >= range.points {
        return;
    }
    let motion = descend(codes[point]);
    swayed[point] = vec4<f32>(carried(motion, rests[point].xyz), 0.0);
}

fn descend(code: vec4<u32>) -> Motion {
    var part = array<vec4<f32>, 3>(vec4(1.0, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0), vec4(0.0, 0.0, 1.0, 0.0));
    var motion = Motion(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec3<f32>(0.0));
    var order = 0u;
    var along = 0u;
    var hash = 0u;
    var phase = 0u;
    for (var place = 0u; place < plant.depth; place++) {
        let digit = digit_of(code, place);
        let role = rows[4u * digit + 3u].x;
        if role == STEM {
            break;
        }
        part = after(part, digit);
        hash = (hash ^ (digit + 1u)) * SPREAD;
        hash ^= hash >> 15u;
        var share = AT_JOINT;
        if role == BRANCH {
            order = min(order + 1u, ORDERS - 1u);
            along = 0u;
            phase = (hash >> 28u) + LAG * place;
        } else {
            along += 1u;
            share = plant.bends[(along - 1u) / 4u][(along - 1u) % 4u];
        }
        let joint = at(part, plant.root.xyz);
        let number = order * PHASES + (phase + PHASES - along) % PHASES;
        let swing = pose.swing[number / 4u][number % 4u];
        motion = turned(motion, joint, turn_of(direction(part), pose.lean[order], swing, share));
    }
    return motion;
}

fn digit_of(code: vec4<u32>, place: u32) -> u32 {
    let start = place * plant.bits;
    let shift = 32u - plant.bits - start % 32u;
    return (code[start / 32u] >> shift) & ((1u << plant.bits) - 1u);
}

fn turn_of(direction: vec3<f32>, lean: f32, swing: f32, share: f32) -> vec3<f32> {
    let out = cross(direction, pose.wind.xyz);
    let half = 0.5 * share;
    return half * (lean * out + swing * pose.across.xyz);
}

fn direction(part: array<vec4<f32>, 3>) -> vec3<f32> {
    let axis = vec3<f32>(part[0].y, part[1].y, part[2].y);
    let length = sqrt(dot(axis, axis));
    return axis * (1.0 / max(length, 1e-20));
}

fn turned(motion: Motion, rest: vec3<f32>, half: vec3<f32>) -> Motion {
    let joint = carried(motion, rest);
    let scale = 1.0 / sqrt(1.0 + dot(half, half));
    let turn = vec4<f32>(half * scale, scale);
    let arm = rotated(turn, motion.shift - joint);
    return Motion(product(turn, motion.turn), joint + arm);
}

fn carried(motion: Motion, point: vec3<f32>) -> vec3<f32> {
    return rotated(motion.turn, point) + motion.shift;
}

fn rotated(turn: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let once = 2.0 * cross(turn.xyz, v);
    let again = cross(turn.xyz, once);
    return v + turn.w * once + again;
}

fn product(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    );
}

fn after(outer: array<vec4<f32>, 3>, digit: u32) -> array<vec4<f32>, 3> {
    var composed: array<vec4<f32>, 3>;
    let inner = array<vec4<f32>, 3>(rows[4u * digit], rows[4u * digit + 1u], rows[4u * digit + 2u]);
    for (var i = 0u; i < 3u; i++) {
        let row = outer[i];
        let sum = row.x * inner[0] + row.y * inner[1] + row.z * inner[2];
        composed[i] = vec4<f32>(sum.xyz, sum.w + row.w);
    }
    return composed;
}

fn at(map: array<vec4<f32>, 3>, point: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(map[0].xyz, point) + map[0].w,
        dot(map[1].xyz, point) + map[1].w,
        dot(map[2].xyz, point) + map[2].w,
    );
}
