// Ground from close by: what lies between the finest of the view's noise and the blades and stones that one sees at
// one's feet. Every mark is a hash of its place, so nothing repeats.

// Footprint in metres from which on nothing of it is seen.
const DETAIL_FROM = 0.30;

// Longest of its wavelengths in metres.
const DETAIL_LENGTH = 0.9;

// Share that is left, at one's feet, of the bumps that are seen from afar.
const AFAR = 0.35;

// Stones: how high one stands at a place that is counted in stones, which way it leans, and a tone for each.
struct Stone {
    height: f32,
    slope: vec2<f32>,
    tone: f32,
}

// Cells around scattered points: Worley 1996, doi 10.1145/237170.237267.
fn stones(place: vec2<f32>, seed: u32) -> Stone {
    let corner = floor(place);
    var nearest = 8.0;
    var second = 8.0;
    var towards = vec2<f32>(0.0);
    var bits = 0u;
    for (var look = 0; look < 9; look++) {
        let cell = corner + vec2<f32>(f32(look % 3 - 1), f32(look / 3 - 1));
        let hash = grain_bits(i32(cell.x), i32(cell.y), seed);
        let centre = cell + vec2<f32>(f32(hash & 0xffffu), f32(hash >> 16u)) / 65536.0;
        let away = place - centre;
        let distance = dot(away, away);
        if distance < nearest {
            second = nearest;
            nearest = distance;
            towards = away;
            bits = hash;
        } else {
            second = min(second, distance);
        }
    }
    let edge = sqrt(second) - sqrt(nearest);
    let tone = f32(grain_bits(i32(bits & 0x7fffu), 7, seed) & 0xffffu) / 65536.0 - 0.5;
    let rise = clamp(edge * 4.0, 0.0, 1.0);
    return Stone(rise * rise * (3.0 - 2.0 * rise), -towards * rise, tone);
}

// A flat stretch of detail: tone around 0, a hue that is drier above 0, and slopes.
struct Detail {
    tone: f32,
    hue: f32,
    bump: vec2<f32>,
}

fn turf_detail(point: vec2<f32>, footprint: f32) -> Detail {
    let tufts = octaves_at(Octaves(DETAIL_LENGTH, 5u, 0.72, 0x31u), point, footprint);
    let dry = octaves_at(Octaves(3.1 * DETAIL_LENGTH, 3u, 0.6, 0x32u), point, footprint);
    return Detail(1.1 * tufts.value, 0.9 * dry.value + 0.4 * tufts.value, 0.10 * tufts.slope);
}

fn stone_detail(point: vec2<f32>, footprint: f32) -> Detail {
    var detail = Detail(0.0, 0.0, vec2<f32>(0.0));
    var size = 0.55;
    for (var layer = 0u; layer < 3u; layer++) {
        let shown = grain_visible(footprint, size);
        if shown > 0.0 {
            let stone = stones(point / size, 0x33u + layer);
            detail.tone += shown * (0.55 * stone.tone - 0.5 * (1.0 - stone.height));
            detail.hue += shown * 0.5 * stone.tone;
            detail.bump += shown * 0.55 * stone.slope;
        }
        size *= 0.38;
    }
    return detail;
}

fn rock_detail(point: vec2<f32>, footprint: f32) -> Detail {
    let rough = octaves_at(Octaves(DETAIL_LENGTH, 6u, 0.62, 0x36u), point, footprint);
    let cracks = octaves_at(Octaves(2.2 * DETAIL_LENGTH, 4u, 0.6, 0x37u), point, footprint);
    let crack = 1.0 - clamp(abs(cracks.value) * 7.0, 0.0, 1.0);
    let shown = grain_visible(footprint, 0.25);
    return Detail(0.75 * rough.value - 0.45 * shown * crack * crack, 0.3 * cracks.value, 0.16 * rough.slope);
}

// Detail of an upright plane or the level one, by how much the ground faces it.
fn hard_detail(point: vec3<f32>, normal: vec3<f32>, footprint: f32, stony: f32) -> Detail {
    var weights = normal * normal;
    weights *= weights;
    weights /= weights.x + weights.y + weights.z;
    let planes = array<vec2<f32>, 3>(point.yz, point.xz + vec2<f32>(31.7, 0.0), point.xy);
    var sum = Detail(0.0, 0.0, vec2<f32>(0.0));
    for (var plane = 0; plane < 3; plane++) {
        let weight = weights[plane];
        if weight < 0.03 {
            continue;
        }
        var here: Detail;
        if stony > 0.5 {
            here = stone_detail(planes[plane], footprint);
        } else {
            here = rock_detail(planes[plane], footprint);
        }
        sum.tone += weight * here.tone;
        sum.hue += weight * here.hue;
        // Slopes count on the level plane alone; on upright ones the tone shows the form.
        sum.bump += select(0.4, 1.0, plane == 2) * weight * here.bump;
    }
    return sum;
}

fn blended(a: Detail, b: Detail, share: f32) -> Detail {
    return Detail(mix(a.tone, b.tone, share), mix(a.hue, b.hue, share), mix(a.bump, b.bump, share));
}

// The skin of a spot with what is seen of it from close by.
fn with_detail(skin: Skin, point: vec3<f32>, normal: vec3<f32>, footprint: f32) -> Skin {
    if footprint >= DETAIL_FROM {
        return skin;
    }
    var detail = turf_detail(point.xy, footprint);
    if skin.kinds.y > 0.0 {
        detail = blended(detail, hard_detail(point, normal, footprint, 1.0), skin.kinds.y);
    }
    if skin.kinds.z > 0.0 {
        detail = blended(detail, hard_detail(point, normal, footprint, 0.0), skin.kinds.z);
    }
    let snow = octaves_at(Octaves(0.7, 5u, 0.5, 0x39u), point.xy, footprint);
    detail = blended(detail, Detail(0.12 * snow.value, 0.0, 0.05 * snow.slope), skin.kinds.w);
    let shown = clamp((DETAIL_FROM - footprint) / (0.5 * DETAIL_FROM), 0.0, 1.0);
    let warm = vec3<f32>(1.0 + 0.28 * detail.hue, 1.0 + 0.10 * detail.hue, 1.0 - 0.22 * detail.hue);
    var near = skin;
    near.albedo = clamp(skin.albedo * mix(vec3<f32>(1.0), max(1.0 + detail.tone, 0.25) * warm, shown), vec3<f32>(0.01), vec3<f32>(0.9));
    // What looks like a bump from afar is tufts and stones from close by, and would stand in black shade.
    near.bump = mix(1.0, AFAR, shown) * skin.bump + shown * detail.bump / sqrt(1.0 + dot(detail.bump, detail.bump));
    return near;
}
