// The surfaces of a scene from ground and water as they are now: the twin of `Surface::new` and `water::levels`. What
// differs from the latter: all water that is deep enough is drawn, not lakes alone, and levels go on over one ring of dry
// cells.

struct Follow {
    columns: u32,
    rows: u32,
    // Elevation of the lowest ground in metres, and the factor on heights.
    low: f32,
    exaggeration: f32,
    // Depth from which a cell is wet, and to which the level falls below dry ground.
    shallow: f32,
    dry: f32,
    // Side of a cell in metres.
    cell: f32,
}

// Control points beyond each border.
const RIM = 2;

@group(0) @binding(0) var<uniform> follow: Follow;
@group(0) @binding(1) var<storage, read> ground: array<f32>;
@group(0) @binding(2) var<storage, read> depth: array<f32>;
@group(0) @binding(3) var land: texture_2d<f32>;
@group(0) @binding(4) var top_now: texture_storage_2d<r32float, write>;
@group(0) @binding(5) var bed_now: texture_storage_2d<r32float, write>;
@group(0) @binding(6) var level_now: texture_storage_2d<r32float, write>;

fn index_of(cell: vec2<i32>) -> u32 {
    return u32(cell.y) * follow.columns + u32(cell.x);
}

fn level_at(cell: vec2<i32>) -> f32 {
    let here = index_of(cell);
    if depth[here] >= follow.shallow {
        return ground[here] + depth[here];
    }
    var sum = 0.0;
    var count = 0.0;
    for (var look = 0; look < 9; look++) {
        let other = cell + vec2<i32>(look % 3 - 1, look / 3 - 1);
        if any(other < vec2<i32>(0)) || any(other >= vec2<i32>(i32(follow.columns), i32(follow.rows))) {
            continue;
        }
        let at = index_of(other);
        if depth[at] >= follow.shallow {
            sum += ground[at] + depth[at];
            count += 1.0;
        }
    }
    if count > 0.0 {
        return min(sum / count, ground[here] - follow.dry);
    }
    return ground[here] - follow.cell;
}

// Heights of the ground, of the level, and of the higher of both.
fn heights_at(cell: vec2<i32>) -> vec3<f32> {
    let bed = ground[index_of(cell)];
    let level = level_at(cell);
    return (vec3<f32>(bed, level, max(bed, level)) - follow.low) * follow.exaggeration;
}

// What a control point beyond the border is made of, along one axis: its border cell, what lies as far inside of that, and
// how many times as far outside it is.
struct Reflection {
    edge: i32,
    inside: i32,
    beyond: f32,
}

fn reflection(place: i32, count: i32) -> Reflection {
    let cell = place - RIM;
    let edge = clamp(cell, 0, count - 1);
    let inside = clamp(2 * edge - cell, 0, count - 1);
    if inside == edge {
        return Reflection(edge, inside, 0.0);
    }
    return Reflection(edge, inside, f32(cell - edge) / f32(edge - inside));
}

fn across(mirror: Reflection, row: i32) -> vec3<f32> {
    let edge = heights_at(vec2<i32>(mirror.edge, row));
    if mirror.beyond == 0.0 {
        return edge;
    }
    return edge + mirror.beyond * (edge - heights_at(vec2<i32>(mirror.inside, row)));
}

@compute @workgroup_size(16, 16)
fn follow_ground(@builtin(global_invocation_id) at: vec3<u32>) {
    let point = vec2<i32>(at.xy);
    let cells = vec2<i32>(i32(follow.columns), i32(follow.rows));
    if any(point >= cells + 2 * RIM) {
        return;
    }
    // What has no data stays as it is.
    if textureDimensions(land).x > 1u && textureLoad(land, point, 0).x < 0.5 {
        return;
    }
    let x = reflection(point.x, cells.x);
    let y = reflection(point.y, cells.y);
    var heights = across(x, y.edge);
    if y.beyond != 0.0 {
        heights += y.beyond * (heights - across(x, y.inside));
    }
    textureStore(bed_now, point, vec4<f32>(heights.x));
    textureStore(level_now, point, vec4<f32>(heights.y));
    textureStore(top_now, point, vec4<f32>(heights.z));
}
