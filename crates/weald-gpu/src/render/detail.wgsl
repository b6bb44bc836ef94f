// Ground from close by: what lies between the finest of the view's noise and the blades and stones that one sees at
// one's feet. Every mark is a hash of its place, so nothing repeats.

// Footprint in metres from which on nothing of it is seen.
const DETAIL_FROM = 0.30;

// Longest of its wavelengths in metres.
const DETAIL_LENGTH = 0.9;

// Share that is left, at one's feet, of the bumps that are seen from afar.
const AFAR = 0.14;

// How far patches of stones follow the tufts between them, and how soft their edges are.
const PATCHY_STONES = 4.0;
const STONES_EDGE = 0.12;

// Stones: how high one stands at a place that is counted in stones, which way it leans, and a tone for each.
struct Stone {
    height: f32,
    slope: vec2<f32>,
    tone: f32,
}

// A stone in most cells of a grid, each of its own size and turn, off the middle by chance; the uppermost of those that
// reach a place counts. Scattered points by Worley 1996, doi 10.1145/237170.237267.
fn stones(place: vec2<f32>, seed: u32) -> Stone {
    let corner = floor(place);
    var top = Stone(0.0, vec2<f32>(0.0), 0.0);
    var look = 0;
    loop {
        let cell = corner + vec2<f32>(f32(look % 3 - 1), f32(look / 3 - 1));
        let hash = grain_bits(i32(cell.x), i32(cell.y), seed);
        let more = grain_bits(i32(hash & 0x7fffu), 7, seed);
        let centre = cell + vec2<f32>(f32(hash & 0xffffu), f32(hash >> 16u)) / 65536.0;
        // Small ones are many.
        let random = f32(more & 0xffu) / 255.0;
        let radius = 0.16 + 0.52 * random * random;
        let turn = f32((more >> 8u) & 0xffu) * 0.0123;
        let axis = vec2<f32>(cos(turn), sin(turn));
        let away = place - centre;
        // Its length over its width.
        let long = 1.0 + 0.7 * f32((more >> 16u) & 0xffu) / 255.0;
        let within = vec2<f32>(dot(away, axis), long * (axis.x * away.y - axis.y * away.x)) / radius;
        let below = 1.0 - dot(within, within);
        let height = radius * sqrt(max(below, 0.0));
        if height > top.height {
            let slope = -(axis * within.x + long * vec2<f32>(-axis.y, axis.x) * within.y) / sqrt(below + 0.15);
            top = Stone(height, slope, f32(more >> 24u) / 255.0 - 0.5);
        }
        look++;
        if look >= 9 {
            break;
        }
    }
    return top;
}

// A flat stretch of detail: tone around 0, a hue that is drier above 0, and slopes.
struct Detail {
    tone: f32,
    hue: f32,
    bump: vec2<f32>,
}

fn turf_detail(point: vec3<f32>, rise: vec2<f32>, footprint: f32) -> Detail {
    let tufts = octaves_on_slope(Octaves(DETAIL_LENGTH, 5u, 0.72, 0x31u), point, rise, footprint);
    let dry = octaves_on_slope(Octaves(3.1 * DETAIL_LENGTH, 3u, 0.6, 0x32u), point, rise, footprint);
    return Detail(0.75 * tufts.value, 0.9 * dry.value + 0.4 * tufts.value, 0.06 * tufts.slope);
}

// The size of the finest of three layers that is seen, each so many times as large as the one before, and its number: software
// works out what a layer is before it asks whether that is seen.
struct Layer {
    size: f32,
    number: u32,
}

fn first_layer(size: f32, larger: f32, footprint: f32) -> Layer {
    var layer = Layer(size, 0u);
    for (var look = 0; look < 2; look++) {
        let is_unseen = grain_visible(footprint, 0.6 * layer.size) <= 0.0;
        layer.size = select(layer.size, larger * layer.size, is_unseen);
        layer.number += select(0u, 1u, is_unseen);
    }
    return layer;
}

fn stone_detail(point: vec2<f32>, footprint: f32) -> Detail {
    let sand = octaves_at(Octaves(0.4, 6u, 0.7, 0x3au), point, footprint);
    var detail = Detail(0.35 * sand.value, 0.4 * sand.value, 0.06 * sand.slope);
    let finest = first_layer(0.06, 2.9, footprint);
    var size = finest.size;
    var layer = finest.number;
    loop {
        let shown = grain_visible(footprint, 0.6 * size);
        if shown > 0.0 {
            let stone = stones(point / size + 17.3 * f32(layer), 0x33u + layer);
            // What lies on sand covers it, and shades it at its edge.
            let edge = clamp(stone.height * 6.0, 0.0, 1.0);
            let on_top = shown * edge;
            detail.tone = mix(detail.tone, 0.75 * stone.tone + 0.12 * sand.value - 0.35 * (1.0 - edge), on_top);
            detail.hue = mix(detail.hue, 0.8 * stone.tone, on_top);
            detail.bump = mix(detail.bump, 0.45 * stone.slope, on_top);
        }
        size *= 2.9;
        layer++;
        if layer >= 3u {
            break;
        }
    }
    return detail;
}

// What trees shed: leaves and needles that lie over each other, each of its own turn and tone.
fn litter_detail(point: vec2<f32>, footprint: f32) -> Detail {
    let mould = octaves_at(Octaves(1.3, 6u, 0.66, 0x3du), point, footprint);
    var detail = Detail(0.9 * mould.value, 0.5 * mould.value, 0.05 * mould.slope);
    let finest = first_layer(0.05, 1.5, footprint);
    var size = finest.size;
    var layer = finest.number;
    loop {
        let shown = grain_visible(footprint, 0.6 * size);
        if shown > 0.0 {
            // Flat and longer than broad, and no layer along another.
            let leaf = stones(turned_by(point, 1.1 * f32(layer)) / vec2<f32>(size, 0.6 * size), 0x46u + layer);
            let on_top = shown * clamp(leaf.height * 8.0, 0.0, 1.0);
            detail.tone = mix(detail.tone, 0.4 * mould.value + 1.3 * leaf.tone, on_top);
            detail.hue = mix(detail.hue, 0.4 * mould.value + 1.8 * leaf.tone, on_top);
            detail.bump = mix(detail.bump, 0.16 * leaf.slope, on_top);
        }
        size *= 1.5;
        layer++;
        if layer >= 3u {
            break;
        }
    }
    return detail;
}

fn turned_by(point: vec2<f32>, angle: f32) -> vec2<f32> {
    let sine = sin(angle);
    let cosine = cos(angle);
    return vec2<f32>(cosine * point.x - sine * point.y, sine * point.x + cosine * point.y);
}

fn rock_detail(point: vec2<f32>, footprint: f32) -> Detail {
    let rough = octaves_at(Octaves(DETAIL_LENGTH, 6u, 0.62, 0x36u), point, footprint);
    let cracks = octaves_at(Octaves(2.2 * DETAIL_LENGTH, 4u, 0.6, 0x37u), point, footprint);
    let crack = 1.0 - clamp(abs(cracks.value) * 7.0, 0.0, 1.0);
    let shown = grain_visible(footprint, 0.25);
    return Detail(0.75 * rough.value - 0.45 * shown * crack * crack, 0.3 * cracks.value, 0.16 * rough.slope);
}

// Of what there is detail on planes.
const OF_ROCK = 0u;
const OF_STONES = 1u;
const OF_LITTER = 2u;

fn detail_of(point: vec2<f32>, footprint: f32, what: u32) -> Detail {
    switch what {
        case OF_STONES: {
            return stone_detail(point, footprint);
        }
        case OF_LITTER: {
            return litter_detail(point, footprint);
        }
        default: {
            return rock_detail(point, footprint);
        }
    }
}

// Detail of an upright plane or the level one, by how much the ground faces it.
fn detail_on_planes(point: vec3<f32>, normal: vec3<f32>, footprint: f32, what: u32) -> Detail {
    var weights = normal * normal;
    weights *= weights;
    weights /= weights.x + weights.y + weights.z;
    var sum = Detail(0.0, 0.0, vec2<f32>(0.0));
    // The planes that count, the first of them first: on most ground one alone.
    var left = select(vec3<f32>(0.0), weights, weights >= vec3<f32>(0.03));
    var weight = greatest(left);
    loop {
        let is_level = left.z == weight;
        let is_east = !is_level & (left.x == weight);
        let upright = select(point.xz + vec2<f32>(31.7, 0.0), point.yz, is_east);
        let here = detail_of(select(upright, point.xy, is_level), footprint, what);
        sum.tone += weight * here.tone;
        sum.hue += weight * here.hue;
        // Slopes count on the level plane alone; on upright ones the tone shows the form.
        sum.bump += select(0.4, 1.0, is_level) * weight * here.bump;
        left = without_plane(left, is_level, is_east);
        weight = greatest(left);
        if weight <= 0.0 {
            break;
        }
    }
    return sum;
}

fn blended(a: Detail, b: Detail, share: f32) -> Detail {
    return Detail(mix(a.tone, b.tone, share), mix(a.hue, b.hue, share), mix(a.bump, b.bump, share));
}

// The share of stones where they lie in patches: as many as there are from afar, but each place is of stones or has none.
fn patch_of_stones(share: f32, tone: f32) -> f32 {
    return ramp(share + PATCHY_STONES * tone * share * (1.0 - share), 0.5 - STONES_EDGE, 0.5 + STONES_EDGE);
}

// The colour of a skin of which a share is stones, where such a share of a place is.
fn parted_colour(skin: SurfaceSample, share: f32) -> vec3<f32> {
    let stones = skin.kinds.y;
    let between = clamp((skin.albedo - stones * scene.scree.xyz) / max(1.0 - stones, 0.25), vec3<f32>(0.01), vec3<f32>(0.9));
    let alone = clamp(1.0 - skin.kinds.x - skin.kinds.z - skin.kinds.w, 0.0, 1.0);
    return mix(skin.albedo, mix(between, scene.scree.xyz, share), alone);
}

// The skin of a point with what is seen of it from close by.
fn with_detail(skin: SurfaceSample, point: vec3<f32>, normal: vec3<f32>, footprint: f32) -> SurfaceSample {
    if footprint >= DETAIL_FROM {
        return skin;
    }
    let rise = -normal.xy / max(normal.z, 0.05);
    var detail = turf_detail(point, rise, footprint);
    // Stones lie where the tone of all tufts says, from wherever they are seen.
    let tone = detail.tone;
    let standing = tufts_seen(abs(dot(normalize(sight), normal)));
    detail = Detail(standing * tone, standing * detail.hue, standing * detail.bump);
    var colour = skin.albedo;
    if skin.kinds.y > 0.0 {
        let share = patch_of_stones(skin.kinds.y, tone);
        colour = parted_colour(skin, share);
        detail = blended(detail, detail_on_planes(point, normal, footprint, OF_STONES), share);
    }
    if skin.kinds.z > 0.0 {
        detail = blended(detail, detail_on_planes(point, normal, footprint, OF_ROCK), skin.kinds.z);
    }
    let litter = trees_drawn * skin.kinds.x;
    if litter > 0.0 {
        detail = blended(detail, detail_on_planes(point, normal, footprint, OF_LITTER), litter);
    }
    let snow = octaves_on_slope(Octaves(0.7, 5u, 0.5, 0x39u), point, rise, footprint);
    detail = blended(detail, Detail(0.12 * snow.value, 0.0, 0.05 * snow.slope), skin.kinds.w);
    let shown = clamp((DETAIL_FROM - footprint) / (0.5 * DETAIL_FROM), 0.0, 1.0);
    let warm = vec3<f32>(1.0 + 0.28 * detail.hue, 1.0 + 0.10 * detail.hue, 1.0 - 0.22 * detail.hue);
    var near = skin;
    let toned = mix(skin.albedo, colour * max(1.0 + detail.tone, 0.25) * warm, shown);
    near.albedo = clamp(toned, vec3<f32>(0.01), vec3<f32>(0.9));
    // What looks like a bump from afar is tufts and stones from close by, and would stand in black shade.
    near.bump = mix(1.0, AFAR, shown) * skin.bump + shown * detail.bump / sqrt(1.0 + dot(detail.bump, detail.bump));
    return near;
}
