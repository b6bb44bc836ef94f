// Twin of `surroundings.rs`: the ground that goes on beyond the border.

struct Folded {
    place: vec2<f32>,
    sign: vec2<f32>,
}

// The place within a rectangle that a place is mirrored to, again and again, and the sign of directions there.
fn folded(place: vec2<f32>, corner: vec2<f32>, cells: vec2<f32>) -> Folded {
    let share = fract((place - corner) / (2.0 * cells));
    let within = corner + cells * (1.0 - abs(2.0 * share - 1.0));
    return Folded(within, select(vec2<f32>(-1.0), vec2<f32>(1.0), share <= vec2<f32>(0.5)));
}

fn mirrored_within(place: vec2<f32>) -> Folded {
    return folded(place, vec2<f32>(0.5), scene.grid.xy);
}

// The place whose ground is far away at another, and what a rise there becomes eastward and southward.
struct Turned {
    place: vec2<f32>,
    east: vec2<f32>,
    south: vec2<f32>,
}

fn turned_within(place: vec2<f32>) -> Turned {
    let away = place - 0.5 - 0.5 * scene.grid.xy;
    let longer = max(scene.grid.x, scene.grid.y);
    let wave = 2.0 * PI / (scene.bend.x * longer);
    let height = scene.bend.y * longer;
    let bent = away + height * sin(wave * away.yx);
    let slopes = height * wave * cos(wave * away.yx);
    let turn = scene.turned.xy;
    let turned = vec2<f32>(dot(vec2<f32>(turn.x, -turn.y), bent), dot(turn.yx, bent));
    let corner = 0.5 + scene.bend.z * scene.grid.xy;
    let found = folded(0.5 + scene.turned.zw * scene.grid.xy + turned, corner, (1.0 - 2.0 * scene.bend.z) * scene.grid.xy);
    let east = found.sign * vec2<f32>(turn.x - turn.y * slopes.y, turn.y + turn.x * slopes.y);
    let south = found.sign * vec2<f32>(turn.x * slopes.x - turn.y, turn.y * slopes.x + turn.x);
    return Turned(found.place, east, south);
}

// A place beyond the border: the place of the landscape that it is like, its ground, and how much of the border is left
// behind.
struct Beyond {
    place: vec2<f32>,
    // The place whose rivers run there.
    river: vec2<f32>,
    surface: vec3<f32>,
    // Height and rise of the ground of the place that it is like: its beds lie by those.
    own: vec3<f32>,
    share: f32,
}

fn is_beyond(place: vec2<f32>) -> bool {
    return any(place < vec2<f32>(0.5)) || any(place > scene.grid.xy + 0.5);
}

fn nearest_within(place: vec2<f32>) -> vec2<f32> {
    return clamp(place, vec2<f32>(0.5), scene.grid.xy + 0.5);
}

// Height far away in the direction of a place, and how uneven the ground is there; and the rise of both by the cell.
struct Far {
    ground: vec2<f32>,
    east: vec2<f32>,
    south: vec2<f32>,
}

fn far_at(place: vec2<f32>) -> Far {
    let away = place - 0.5 - 0.5 * scene.grid.xy;
    let at = fract(atan2(away.x, -away.y) / (2.0 * PI)) * f32(FAR_DIRECTIONS);
    let first = i32(at);
    let t = fract(at);
    let one = scene.far_ground[first % FAR_DIRECTIONS].xy;
    let other = scene.far_ground[(first + 1) % FAR_DIRECTIONS].xy;
    let swing = 6.0 * t * (1.0 - t) * f32(FAR_DIRECTIONS) / (2.0 * PI) / max(dot(away, away), 1e-6);
    let change = (other - one) * swing;
    return Far(mix(one, other, t * t * (3.0 - 2.0 * t)), -away.y * change, away.x * change);
}

// Most by which ground beyond the border rises above the border's height and sinks below it, as shares of the greatest height
// above the mean.
const NEAR_ABOVE = 0.4;
const NEAR_BELOW = 0.08;

// Rise of a level of water from the border inward, in cells, with which it is that of another lake.
const OTHER_LAKE = 0.25;

// The ground at a place beyond the border.
fn ground_beyond(place: vec2<f32>) -> Beyond {
    let border = nearest_within(place);
    let away = place - border;
    let distance = length(away);
    let width = scene.around.z * max(scene.grid.x, scene.grid.y);
    let t = min(distance / width, 1.0);
    let share = t * t * (3.0 - 2.0 * t);
    let growth = away * (6.0 * t * (1.0 - t) / (width * max(distance, 1e-6)));
    let mirrored = mirrored_within(place);
    let turned = turned_within(place);
    let edge = spline_with_slope(bed, border);
    let within = spline_with_slope(bed, mirrored.place);
    let there = spline_with_slope(bed, turned.place);
    let around = far_at(place);
    let uneven = around.ground.y;
    let off = there.x - scene.around.w;
    let lower = 1.0 + max(off, 0.0) / scene.far_highest.x;
    let unlike = off / lower;
    let steep = 1.0 / (lower * lower);
    let off_edge = edge.x - within.x;
    let most = select(NEAR_ABOVE, NEAR_BELOW, off_edge < 0.0) * scene.far_highest.x;
    let held = 1.0 + abs(off_edge) / most;
    let near = edge.x + off_edge / held;
    let kept = 1.0 / (held * held);
    let far = around.ground.x + uneven * unlike;
    let turned_rise = vec2<f32>(dot(turned.east, there.yz), dot(turned.south, there.yz));
    let swing = vec2<f32>(dot(around.east, vec2<f32>(1.0, unlike)), dot(around.south, vec2<f32>(1.0, unlike)));
    let far_rise = uneven * steep * turned_rise + swing;
    let along = select(vec2<f32>(0.0), (1.0 + kept) * edge.yz, place == border);
    let near_rise = along - kept * mirrored.sign * within.yz;
    let slope = mix(near_rise, far_rise, share) + (far - near) * growth;
    let longer = max(scene.grid.x, scene.grid.y);
    let patchy = octaves_at(Octaves(0.05 * longer, 4u, 0.55, 0x61u), place, 0.0).value;
    let is_near = share + 0.5 * patchy < 0.5;
    let like = select(turned.place, mirrored.place, is_near);
    let own = select(there, within, is_near);
    let river = select(turned.place, mirrored.place, share < 0.5);
    return Beyond(like, river, vec3<f32>(mix(near, far, share), slope), own, share);
}

// Level of the water at a place beyond the border; far below the ground where a scene has no water.
fn level_beyond(place: vec2<f32>, beyond: Beyond) -> f32 {
    if !is_above(scene.has.x, 0.0, place.x + FAR_AWAY) {
        return -1e9;
    }
    let dry = beyond.surface.x - scene.scale.w;
    let far = select(dry, scene.around.y, scene.around.y > -1e29);
    var near = far;
    if beyond.share < 1.0 {
        let within = spline_at(level, mirrored_within(place).place);
        let off = abs(within - spline_at(level, nearest_within(place)));
        // Without a sea, `scene.around.y` lies far below all ground.
        near = max(mix(dry, within, exp(-off / (OTHER_LAKE * scene.scale.w))), scene.around.y);
    }
    return mix(near, far, beyond.share);
}

// What rivers keep of their width there.
fn river_share_beyond(beyond: Beyond) -> f32 {
    return abs(1.0 - 2.0 * beyond.share);
}

// Metres off its level, as it is drawn, up to which a height is that of the sea.
const AT_SEA = 0.5;

// Whether a height is that of the sea.
fn is_at_sea(height: f32) -> bool {
    return abs(height - scene.around.y) < AT_SEA;
}

// The share in which what lies at a place beyond the border fades into what lies farthest.
fn lost_share(place: vec2<f32>) -> f32 {
    let away = (place - nearest_within(place)) / (scene.around.x * max(scene.grid.x, scene.grid.y));
    return 1.0 - exp(-dot(away, away));
}
