// Twin of `sway.rs`: limbs that turn about their joints, from the finest to the coarsest. It comes after
// `wind.wgsl`.

const AT_JOINT: f32 = 0.7;
const MAX_PUSH: f32 = 0.9;
const LEANS = vec4<f32>(1.1, 0.45, 0.25, 0.1);
const SWINGS = vec4<f32>(0.16, 0.22, 0.22, 0.16);
const FREQUENCIES = vec4<f32>(0.45, 1.0, 2.1, 3.4);
const NO_PARENT = 0xfffffu;

struct Limb {
    joint: vec3<f32>,
    along: f32,
    direction: vec3<f32>,
    // Parent in 20 bits, order in 2, phase in 10.
    tie: u32,
}

struct LocalWind {
    push: f32,
    wind: vec3<f32>,
    across: vec3<f32>,
    seconds: f32,
    phase: f32,
}

// A point, and a direction there.
struct Bent {
    point: vec3<f32>,
    normal: vec3<f32>,
}

// The breeze of a push along x and z of the plant, upright.
fn wind_on(push: vec2<f32>, seconds: f32, phase: f32) -> LocalWind {
    let strength = sqrt(push.x * push.x + push.y * push.y);
    let longer = 1.0 / max(strength, 1e-20);
    let wind = vec3<f32>(push.x * longer, 0.0, push.y * longer);
    return LocalWind(min(strength, MAX_PUSH), wind, vec3<f32>(-wind.z, 0.0, wind.x), seconds, phase);
}

// Half of the vector about which, and by which, a place along a limb turns.
fn half_turn(limb: Limb, along: f32, breeze: LocalWind) -> vec3<f32> {
    let order = (limb.tie >> 20u) & 3u;
    let ratio = sqrt(breeze.push / (1.0 - breeze.push));
    let breezy = 2.0 * ratio / (2.0 * ratio + 1.0);
    let lean = LEANS[order] * breeze.push;
    let phase = f32(limb.tie >> 22u) * (1.0 / 1024.0);
    let swing = SWINGS[order] * breezy * wind_wave(FREQUENCIES[order] * breeze.seconds + phase + breeze.phase);
    let at_joint = select(AT_JOINT, 0.0, (limb.tie & NO_PARENT) == NO_PARENT);
    return 0.5 * (at_joint + along) * (lean * cross(limb.direction, breeze.wind) + swing * breeze.across);
}

fn rotated(turn: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let once = 2.0 * cross(turn.xyz, v);
    return v + turn.w * once + cross(turn.xyz, once);
}
