// How the limbs on which a limb hangs carry it in the wind. A leaf that went down all of them by itself would pay for each
// again; of the plants that are seen largest, each limb is carried once.

// Plants of a view that have a seat: the first in its lists, of which the first few hold plants with many leaves.
const SEATS = array<u32, VIEWS>(96u, 48u, 48u, 0u, 0u);
const FIRST_SEATS = array<u32, VIEWS>(0u, 96u, 144u, 192u, 192u);
const SEATED_LISTS = 6u;

// The seats behind all of those, which the other plants share: winds from so many sides, each of so many strengths.
const SHARED_SEATS = 192u;
const SIDES = 8u;
const STRENGTHS = 4u;
const STRONGER = 0.15;
const SHARED_VIEW = 3u;

// A turn by a quaternion, then a shift.
struct Carried {
    turn: vec4<f32>,
    shift: vec3<f32>,
}

// It is kept in 16 bits a number: of a tree 20 m high, a limb on five others lies at most some millimetres off.
fn packed_carried(whole: Carried) -> vec4<u32> {
    let turn = vec2<u32>(pack2x16snorm(whole.turn.xy), pack2x16snorm(whole.turn.zw));
    return vec4<u32>(turn, pack2x16float(whole.shift.xy), pack2x16float(vec2<f32>(whole.shift.z, 0.0)));
}

fn unpacked_carried(words: vec4<u32>) -> Carried {
    let turn = vec4<f32>(unpack2x16snorm(words.x), unpack2x16snorm(words.y));
    return Carried(turn, vec3<f32>(unpack2x16float(words.z), unpack2x16float(words.w).x));
}

// Limbs beside each other in a row of the texture from which leaves read how they are carried.
const CARRIED_ACROSS = 4096u;

fn texel_of_carried(place: u32) -> vec2<u32> {
    return vec2<u32>(place % CARRIED_ACROSS, place / CARRIED_ACROSS);
}

// How many plants of a view have a seat, of whose lists the first that has none starts there.
fn seats_of(view: u32, start: u32) -> u32 {
    return min(SEATS[view], start);
}

fn turn_of(plant: PlacedPlant) -> vec4<f32> {
    return normalize(vec4<f32>(unpack2x16snorm(plant.turn.x), unpack2x16snorm(plant.turn.y)));
}

// The breeze that a plant feels in a view, which is turned as it is. The last cascade is drawn once for all moments.
fn breeze_of(view: u32, plant: PlacedPlant) -> LocalWind {
    let turn = turn_of(plant);
    let seconds = select(frame.moment.x, 0.0, view == VIEWS - 1u);
    let push = wind_push(plant.place.xy, seconds, plant.phase);
    let felt = rotated(vec4<f32>(-turn.xyz, turn.w), vec3<f32>(push.x, 0.0, -push.y));
    return wind_on(felt.xz, seconds, plant.phase);
}

// The wind of a shared seat.
fn shared_breeze(seat: u32) -> LocalWind {
    let turn = f32(seat / STRENGTHS) * (6.2831853 / f32(SIDES));
    let strength = max(f32(seat % STRENGTHS) * STRONGER, 1e-6);
    return wind_on(strength * vec2<f32>(cos(turn), sin(turn)), frame.moment.x, f32(seat / STRENGTHS) / f32(SIDES));
}

// The side from which the wind of the shared seats that are nearest comes.
fn side_of(breeze: LocalWind) -> u32 {
    return u32(round((atan2(breeze.wind.z, breeze.wind.x) / 6.2831853 + 1.0) * f32(SIDES))) % SIDES;
}

// The first of the two shared seats whose winds are nearest, and the share of the second.
fn shared_seat(side: u32, push: f32) -> vec2<f32> {
    let strength = clamp(push / STRONGER, 0.0, f32(STRENGTHS) - 1.001);
    return vec2<f32>(f32(SHARED_SEATS + side * STRENGTHS) + floor(strength), fract(strength));
}

// A limb turned about its joint, for a place so far along it.
fn turned_limb(limb: Limb, along: f32, breeze: LocalWind) -> Carried {
    let half = half_turn(limb, along, breeze);
    let turn = vec4<f32>(half, 1.0) / sqrt(1.0 + dot(half, half));
    return Carried(turn, limb.joint - rotated(turn, limb.joint));
}

// What the second does after the first.
fn carried_by(first: Carried, second: Carried) -> Carried {
    let a = second.turn;
    let b = first.turn;
    let turn = vec4<f32>(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
    return Carried(turn, rotated(second.turn, first.shift) + second.shift);
}
