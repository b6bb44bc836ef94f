// A blade of grass from an instance: the twin of curves.rs, growth.rs, random.rs, spline.rs and blade.rs, with the same
// names and the same order of operations. It needs a binding `var<uniform> grasses: Grasses`.

const JOINT: f32 = 0.3;
const MAX_BEND: f32 = 1.0471976;
const BEND_OF_GAMMA: f32 = 0.5983986;
const BLADES: u32 = 6u;
const ROWS: u32 = 9u;
const YAW: u32 = 0u;
const PLACE: u32 = 1u;
const DISTANCE: u32 = 2u;
const HEIGHT: u32 = 3u;
const LEAN: u32 = 4u;
const FACING: u32 = 5u;
const PHASE: u32 = 6u;
const RANK: u32 = 7u;
const SPLAY: u32 = 8u;
const TRODDEN: f32 = 0.08;
const STALK_WIDTH: f32 = 0.3;
const STALK_SPLAY: f32 = 0.4;

struct Grasses {
    species: array<vec4<f32>, 144>,
    level_turn: f32,
}

struct Set {
    soil: f32,
    light: f32,
    level: f32,
    cut: f32,
    trodden: f32,
    seed: u32,
}

struct Instance {
    place: vec2<f32>,
    species: u32,
    tuft: Set,
}

struct Growth {
    width: f32,
    height: f32,
    bend: f32,
    blend: f32,
}

// Five points, each upwards and to where the stem bends.
struct Spline {
    a: vec2<f32>,
    b: vec2<f32>,
    c: vec2<f32>,
    d: vec2<f32>,
    e: vec2<f32>,
}

struct Blade {
    stem: Spline,
    root: vec2<f32>,
    facing: vec2<f32>,
    width: f32,
    taper: f32,
    fold: f32,
    head_length: f32,
    head_width: f32,
    blend: f32,
}

struct Vertex {
    place: vec3<f32>,
    normal: vec3<f32>,
    blend: f32,
    head: f32,
    along: f32,
}

fn unpack(words: vec4<u32>) -> Instance {
    let ground = words.z;
    let rest = words.w;
    return Instance(
        vec2<f32>(bitcast<f32>(words.x), bitcast<f32>(words.y)),
        (rest >> 16u) & 15u,
        Set(
            f32(ground & 1023u) * (1.0 / 1023.0),
            f32((ground >> 10u) & 1023u) * (1.0 / 1023.0),
            f32(ground >> 20u) * (4.0 / 4095.0),
            f32((rest >> 20u) & 63u) * (1.0 / 63.0),
            f32(rest >> 26u) * (1.0 / 63.0),
            rest & 0xffffu,
        ),
    );
}

fn row_of(species: u32, row: u32) -> vec4<f32> {
    return grasses.species[species * ROWS + row];
}

fn blended(a: f32, b: f32, t: f32) -> f32 {
    return a * (1.0 - t) + b * t;
}

fn mixed(a: vec2<f32>, b: vec2<f32>, t: f32) -> vec2<f32> {
    return a * (1.0 - t) + b * t;
}

fn midpoint(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return (a + b) * 0.5;
}

fn scrambled(number: u32) -> u32 {
    let state = number * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn random(seed: u32, blade: u32, purpose: u32) -> f32 {
    let bits = scrambled(scrambled(seed) ^ (blade * 16u + purpose));
    return f32(bits >> 8u) * (1.0 / 16777216.0);
}

fn sine(x: f32) -> f32 {
    let s = x * x;
    return x * (1.0 - s * (0.16666667 - s * (0.008333333 - s * (0.0001984127 - s * 0.0000027557319))));
}

fn cosine(x: f32) -> f32 {
    let s = x * x;
    let fine = 0.0013888889 - s * (0.000024801587 - s * 0.0000002755732);
    return 1.0 - s * (0.5 - s * (0.041666668 - s * fine));
}

fn direction(turns: f32) -> vec2<f32> {
    let quarters = turns * 4.0;
    let quadrant = floor(quarters + 0.5);
    let angle = (quarters - quadrant) * 1.5707964;
    let along = cosine(angle);
    let across = sine(angle);
    switch u32(quadrant) % 4u {
        case 0u: { return vec2<f32>(along, across); }
        case 1u: { return vec2<f32>(-across, along); }
        case 2u: { return vec2<f32>(-along, -across); }
        default: { return vec2<f32>(across, -along); }
    }
}

fn arc(a: f32, b: f32, c: f32, t: f32) -> f32 {
    return blended(blended(a, b, t), blended(b, c, t), t);
}

fn answer_to_light(four: vec4<f32>, fifth: f32, light: f32) -> f32 {
    let share = clamp(light, 0.0, 1.0);
    if share <= JOINT {
        return arc(four.x, four.y, four.z, min(share * (1.0 / JOINT), 1.0));
    }
    return arc(four.z, four.w, fifth, min((share - JOINT) * (1.0 / (1.0 - JOINT)), 1.0));
}

fn growth_at(species: u32, soil: f32, light: f32) -> Growth {
    let of_soil = row_of(species, 0u);
    let answer = arc(of_soil.x, of_soil.y, of_soil.z, clamp(soil, 0.0, 1.0));
    let wide = answer_to_light(row_of(species, 1u), row_of(species, 2u).x, light);
    let tall = answer_to_light(row_of(species, 3u), row_of(species, 4u).x, light);
    return growth_of(answer, wide, tall);
}

fn growth_of(soil: f32, wide: f32, tall: f32) -> Growth {
    let width = (soil + wide) * 0.125;
    let height = (soil + tall) * 0.5;
    let gamma = height - width + tall;
    let blend = (soil + (wide + tall) * 0.5) * 0.5;
    return Growth(width, height, clamp(gamma * BEND_OF_GAMMA, 0.0, MAX_BEND), blend);
}

fn points(height: f32, turn: f32) -> Spline {
    let s = sine(turn);
    let c = cosine(turn);
    let root = vec2<f32>(0.0);
    let one = risen(root, height, s, c);
    let two = risen(one, height * height, s, c);
    let three = risen(two, height * height * height, s, c);
    let four = risen(three, height * height * height * height, s, c);
    return Spline(root, one, two, three, four);
}

fn risen(point: vec2<f32>, power: f32, s: f32, c: f32) -> vec2<f32> {
    let grown = point.x + power;
    return vec2<f32>(grown * c - point.y * s, grown * s + point.y * c);
}

fn stem_of(points: Spline, level: f32) -> Spline {
    let whole = min(u32(level), 3u);
    let part = clamp(level - f32(whole), 0.0, 1.0);
    let old = at_level(points, whole);
    let young = at_level(points, whole + 1u);
    return Spline(
        mixed(old.a, young.a, part),
        mixed(old.b, young.b, part),
        mixed(old.c, young.c, part),
        mixed(old.d, young.d, part),
        mixed(old.e, young.e, part),
    );
}

fn at_level(p: Spline, level: u32) -> Spline {
    switch level {
        case 0u: { return Spline(p.a, p.a, p.a, p.a, p.a); }
        case 1u: { return halved(p.a, mixed(p.a, p.b, 1.0 / 3.0), mixed(p.a, p.b, 2.0 / 3.0), p.b); }
        case 2u: { return halved(p.a, mixed(p.a, p.b, 2.0 / 3.0), mixed(p.c, p.b, 2.0 / 3.0), p.c); }
        case 3u: { return halved(p.a, p.b, p.c, p.d); }
        default: { return p; }
    }
}

fn halved(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>) -> Spline {
    return Spline(a, midpoint(a, b), midpoint(b, c), midpoint(c, d), d);
}

// The point, then the derivative.
fn stem_at(stem: Spline, t: f32) -> vec4<f32> {
    let before = midpoint(stem.b, stem.c);
    let behind = midpoint(stem.c, stem.d);
    let middle = midpoint(before, behind);
    let doubled = t + t;
    if t < 0.5 {
        return cubic(stem.a, stem.b, before, middle, doubled);
    }
    return cubic(middle, behind, stem.d, stem.e, doubled - 1.0);
}

fn cubic(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>, t: f32) -> vec4<f32> {
    let ab = mixed(a, b, t);
    let bc = mixed(b, c, t);
    let cd = mixed(c, d, t);
    let abc = mixed(ab, bc, t);
    let bcd = mixed(bc, cd, t);
    return vec4<f32>(mixed(abc, bcd, t), 6.0 * (bcd - abc));
}

fn around(seed: u32, number: u32, random_of_blade: f32) -> f32 {
    let turns = random(seed, 0u, YAW) + (f32(number) + random_of_blade) * (1.0 / f32(BLADES));
    return turns - floor(turns);
}

// Where in a gust a set is: neighbours do not sway as one.
fn phase_of(tuft: Set) -> f32 {
    return random(tuft.seed, 0u, PHASE);
}

// Its place among its neighbours: where sets are left out, those of the highest rank go first.
fn rank_of(tuft: Set) -> f32 {
    return random(tuft.seed, 0u, RANK);
}

fn splayed_point(point: vec2<f32>, s: f32, c: f32) -> vec2<f32> {
    return vec2<f32>(point.x * c - point.y * s, point.x * s + point.y * c);
}

fn splayed(stem: Spline, angle: f32) -> Spline {
    let s = sine(angle);
    let c = cosine(angle);
    return Spline(
        splayed_point(stem.a, s, c),
        splayed_point(stem.b, s, c),
        splayed_point(stem.c, s, c),
        splayed_point(stem.d, s, c),
        splayed_point(stem.e, s, c),
    );
}

fn trodden_point(point: vec2<f32>, upright: f32, lying: f32) -> vec2<f32> {
    return vec2<f32>(point.x * upright, point.y + point.x * lying);
}

fn trodden(stem: Spline, share: f32) -> Spline {
    let upright = 1.0 - share * (1.0 - TRODDEN);
    let lying = sqrt(max(1.0 - upright * upright, 0.0));
    return Spline(
        trodden_point(stem.a, upright, lying),
        trodden_point(stem.b, upright, lying),
        trodden_point(stem.c, upright, lying),
        trodden_point(stem.d, upright, lying),
        trodden_point(stem.e, upright, lying),
    );
}

fn highest(stem: Spline) -> f32 {
    return max(max(max(stem.a.x, stem.b.x), max(stem.c.x, stem.d.x)), max(stem.e.x, 0.0));
}

fn blade_of(species: u32, tuft: Set, number: u32) -> Blade {
    let growth = growth_at(species, tuft.soil, tuft.light);
    let widths = row_of(species, 2u);
    let shape = row_of(species, 4u);
    let heads = row_of(species, 8u);
    let stalk_height = row_of(species, 6u).w;
    let height = row_of(species, 0u).w;
    let stalk = number < u32(row_of(species, 7u).w);
    let tall = (1.0 - shape.w * random(tuft.seed, number, HEIGHT)) * select(1.0, stalk_height, stalk);
    let lean = 1.0 + shape.w * (random(tuft.seed, number, LEAN) - 0.5);
    let turn = clamp(growth.bend * row_of(species, 5u).w * lean, 0.0, MAX_BEND) * grasses.level_turn;
    let splay = heads.z * select(1.0, STALK_SPLAY, stalk);
    let upright = stem_of(points(growth.height, turn), tuft.level);
    let stem = trodden(splayed(upright, splay * random(tuft.seed, number, SPLAY)), tuft.trodden);
    let scale = height * tall * 0.25;
    let limit = tuft.cut * (height * max(stalk_height, 1.0));
    let kept = min(limit / max(highest(stem) * scale, 1e-20), 1.0);
    let place = direction(around(tuft.seed, number, random(tuft.seed, number, PLACE)));
    let distance = widths.z * blended(0.25, 1.0, random(tuft.seed, number, DISTANCE));
    let sprouted = clamp(tuft.level, 0.0, 1.0);
    let ripe = clamp(tuft.level - 3.0, 0.0, 1.0) * growth.blend * kept;
    let width = growth.width * 4.0 * widths.y * sprouted;
    let metres = scale * kept;
    return Blade(
        Spline(stem.a * metres, stem.b * metres, stem.c * metres, stem.d * metres, stem.e * metres),
        place * distance,
        direction(around(tuft.seed, number, random(tuft.seed, number, FACING))),
        select(width, width * STALK_WIDTH, stalk),
        select(shape.y, 0.5, stalk),
        shape.z,
        select(1.0, heads.x, stalk),
        select(0.0, heads.y * ripe, stalk),
        growth.blend,
    );
}

fn bulge_of(blade: Blade, along: f32) -> f32 {
    let inside = clamp((along - 1.0) / max(blade.head_length, 1e-6) + 1.0, 0.0, 1.0);
    return 6.75 * inside * (1.0 - inside) * (1.0 - inside);
}

fn vertex_of(blade: Blade, along: f32, side: f32) -> Vertex {
    let found = stem_at(blade.stem, along);
    let rise = found.z;
    let run = found.w;
    let facing = blade.facing;
    let bulge = bulge_of(blade, along);
    let half = side * 0.5 * (blade.width * (1.0 - blade.taper * along * along) + blade.head_width * bulge);
    let length = sqrt(rise * rise + run * run);
    var slope = 1.0;
    var lean = 0.0;
    if length > 1e-12 {
        slope = run / length;
        lean = rise / length;
    }
    let turned = side * blade.fold;
    let shorter = 1.0 / sqrt(1.0 + turned * turned);
    return Vertex(
        vec3<f32>(
            blade.root.x + facing.x * found.y - facing.y * half,
            found.x,
            blade.root.y + facing.y * found.y + facing.x * half,
        ),
        vec3<f32>(
            (facing.y * turned - facing.x * lean) * shorter,
            slope * shorter,
            (-facing.x * turned - facing.y * lean) * shorter,
        ),
        blade.blend,
        select(0.0, min(bulge * 4.0, 1.0), blade.head_width > 0.0),
        along,
    );
}

fn swayed(blade: Blade, vertex: Vertex, push: vec2<f32>) -> Vertex {
    let share = vertex.along * vertex.along;
    let east = push.x * share;
    let south = push.y * share;
    let arm = vec3<f32>(vertex.place.x - blade.root.x, vertex.place.y, vertex.place.z - blade.root.y);
    let shifted = vec3<f32>(arm.x + east * arm.y, arm.y, arm.z + south * arm.y);
    let kept = length_of(arm) / max(length_of(shifted), 1e-20);
    let normal = vec3<f32>(
        vertex.normal.x,
        vertex.normal.y - east * vertex.normal.x - south * vertex.normal.z,
        vertex.normal.z,
    );
    let longer = 1.0 / max(length_of(normal), 1e-20);
    let place = vec3<f32>(blade.root.x + shifted.x * kept, arm.y * kept, blade.root.y + shifted.z * kept);
    return Vertex(place, normal * longer, vertex.blend, vertex.head, vertex.along);
}

fn length_of(v: vec3<f32>) -> f32 {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// Linear light, by the shares of the good colour and of the head's.
fn colour_of(species: u32, blend: f32, head: f32) -> vec3<f32> {
    let leaf = blend * row_of(species, 5u).xyz + (1.0 - blend) * row_of(species, 6u).xyz;
    return head * row_of(species, 7u).xyz + (1.0 - head) * leaf;
}
