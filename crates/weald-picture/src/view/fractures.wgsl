// Twin of `fractures.rs`: joints of rock, and the blocks between them.

const BLOCKS_LARGEST = 1.0;
const BLOCKS_SMALLER = 0.434;
const BLOCK_LAYERS = 7u;
const BLOCK_SIDES = vec2<f32>(1.5, 2.3);
const JOINT_FIRST = vec2<f32>(0.92, 0.39);
const JOINT_SECOND = vec2<f32>(-0.47, 0.88);
const JOINT_OPEN = 0.06;
const BLOCK_PIXELS = 1.6;
const BLOCKS_LEFT = 0.6;
const BLOCK_TOP = 0.72;
const UNEVEN_BLOCKS = vec4<f32>(0.31, 1.4, 0.117, 2.4);
const JOINT_FLATTEST = 0.2;

struct Fractures {
    tone: f32,
    crack: f32,
    facet: vec2<f32>,
    ledge: f32,
}

struct Face {
    place: vec2<f32>,
    level: f32,
    normal: vec3<f32>,
    thickness: f32,
    footprint: f32,
}

// Share of the darkness of a joint at a distance from its middle, which a face cuts at an angle of that sine.
fn joint(within: f32, sine: f32, deep: f32, wide: f32) -> f32 {
    return deep * (1.0 - ramp(min(within, 1.0 - within) / sine, 0.25 * wide, wide));
}

// A way along blocks of one width as one along blocks of all widths, and how fast it goes there.
fn unevenly(along: f32, phase: f32) -> vec2<f32> {
    let fold = fract(along * UNEVEN_BLOCKS.xz + phase) - 0.5;
    let wide = UNEVEN_BLOCKS.yw;
    let rates = select(-UNEVEN_BLOCKS.xz * wide, UNEVEN_BLOCKS.xz * wide, fold >= vec2<f32>(0.0));
    return vec2<f32>(along + dot(wide, abs(fold)), 1.0 + rates.x + rates.y);
}

// Blocks of one height.
fn blocks_at(face: Face, height: f32, seed: u32) -> Fractures {
    let along = vec2<f32>(dot(face.place, JOINT_FIRST), dot(face.place, JOINT_SECOND)) / (BLOCK_SIDES * height);
    let up = unevenly(face.level / height, 0.37 * f32(seed & 7u));
    let bed = floor(up.x);
    // Neither do joints go on from bed to bed, nor across the other set.
    let in_bed = grain_bits(i32(bed), 11, seed);
    let first = unevenly(along.x + part_of(in_bed, 0u), part_of(in_bed, 16u));
    let row = floor(first.x);
    let in_row = grain_bits(i32(row), i32(bed), seed ^ 0x5bd1u);
    let second = unevenly(along.y + part_of(in_row, 0u), part_of(in_row, 16u));
    let column = floor(second.x);
    let hash = grain_bits(i32(column), i32(row) + i32(bed) * 57, seed ^ 0x91e1u);
    let within = vec3<f32>(first.x - row, second.x - column, up.x - bed);

    let cosines = vec3<f32>(dot(face.normal.xy, JOINT_FIRST), dot(face.normal.xy, JOINT_SECOND), face.normal.z);
    let least = vec3<f32>(JOINT_FLATTEST * JOINT_FLATTEST);
    let rates = vec3<f32>(first.y, second.y, up.y);
    let sines = rates * sqrt(max(1.0 - cosines * cosines, least)) / vec3<f32>(BLOCK_SIDES, 1.0);
    let blur = face.footprint / height;
    let wide = max(JOINT_OPEN, 0.8 * blur);
    // Few joints are open and most are closed.
    let chances = vec3<f32>(part_of(in_row, 8u), part_of(hash, 0u), part_of(in_bed, 8u));
    let deep = chances * chances;
    let upright = max(joint(within.x, sines.x, deep.x, wide), joint(within.y, sines.y, deep.y, wide));
    let crack = max(upright, joint(within.z, sines.z, deep.z, wide));
    let turns = 2.0 * vec2<f32>(part_of(hash, 8u), part_of(hash, 16u)) - 1.0;
    let soft = clamp(0.8 * blur * sines.z, 0.03, 0.25);
    let lies = select(0.0, 1.0, part_of(hash, 24u) < 0.5);
    return Fractures(
        part_of(hash, 16u) - 0.5,
        crack * min(2.5 * JOINT_OPEN / max(blur, 1e-6), 1.0),
        turns.x * JOINT_FIRST + turns.y * JOINT_SECOND,
        lies * ramp(within.z, BLOCK_TOP - soft, BLOCK_TOP + soft),
    );
}

// The blocks at a point of a face.
fn fractures_at(face: Face) -> Fractures {
    var sum = Fractures(0.0, 0.0, vec2<f32>(0.0), 0.0);
    var height = BLOCKS_LARGEST * face.thickness;
    let pixel = BLOCK_PIXELS * face.footprint;
    var seen = grain_visible(pixel, height);
    if seen <= 0.0 {
        return sum;
    }
    var layer = 0u;
    loop {
        let smaller = BLOCKS_SMALLER * height;
        let next = select(0.0, grain_visible(pixel, smaller), layer + 1u < BLOCK_LAYERS);
        let here = blocks_at(face, height, 0x2bu + layer);
        let weight = seen * (1.0 - (1.0 - BLOCKS_LEFT) * next);
        sum.tone += weight * here.tone;
        sum.crack = max(sum.crack, weight * here.crack);
        sum.facet += weight * here.facet;
        sum.ledge = max(sum.ledge, weight * here.ledge);
        height = smaller;
        seen = next;
        layer++;
        if layer >= BLOCK_LAYERS || seen <= 0.0 {
            break;
        }
    }
    return sum;
}
