// The share of the sun's disc that is seen from a point: cascades of depths as the sun sees them.
//
// Each cascade is a square of the plane that faces the sun; the last holds the whole landscape, so that it holds all
// shadows that it throws on the plain as well. How wide a shadow's edge is follows from how far away what throws it is
// and how large the sun is: Fernando 2005, "Percentage-closer soft shadows", doi 10.1145/1187112.1187153. What differs:
// looks lie on a fixed grid, not at random, so that nothing flickers or is grainy.

const CASCADES = 4;

// Share of a cascade's side over which it passes into the next.
const PASSING = 0.08;

// Widest edge of a shadow, as a radius in texels.
const WIDEST = 3.0;

@group(0) @binding(1) var shadow_depths: texture_depth_2d_array;
@group(0) @binding(2) var shadow_between: sampler_comparison;

// Where a point lies in a cascade: from -1 to 1, and its depth from the sun, 0 to 1.
fn in_cascade(point: vec3<f32>, cascade: i32) -> vec3<f32> {
    let square = frame.cascades[cascade];
    let aside = vec2<f32>(dot(point, frame.sun_right.xyz), dot(point, frame.sun_up.xyz));
    let depth = (frame.sun_right.w - dot(point, scene.sun.xyz)) / frame.sun_up.w;
    return vec3<f32>((aside - square.xy) / square.zw, depth);
}

// Mean distance from the sun of what is nearer to it than a depth, around a place; above 1 where nothing is.
fn blocker_depth(place: vec2<f32>, cascade: i32, depth: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(shadow_depths));
    let last = vec2<i32>(size) - 1;
    var sum = 0.0;
    var count = 0.0;
    var look = 0;
    loop {
        let offset = vec2<f32>(f32(look % 3 - 1), f32(look / 3 - 1)) * 2.0;
        let texel = clamp(vec2<i32>(place * size + offset), vec2<i32>(0), last);
        let found = textureLoad(shadow_depths, texel, cascade, 0);
        if found < depth {
            sum += found;
            count += 1.0;
        }
        look++;
        if look >= 9 {
            break;
        }
    }
    return select(2.0, sum / max(count, 1.0), count > 0.0);
}

// The weights of two neighbouring texels, so far away, in the mean of four looks so far apart, each between two texels.
fn look_weights(away: vec2<f32>, spacing: f32) -> vec2<f32> {
    var sum = vec2<f32>(0.0);
    for (var look = 0; look < 4; look++) {
        sum += max(1.0 - abs(away + (f32(look) - 1.5) * spacing), vec2<f32>(0.0));
    }
    return 0.25 * sum;
}

// The share of sixteen looks, four by four and so many texels apart, from which a depth is open to the sun: texels lie closer
// than looks do, so that four of them at a time serve several looks.
fn open_share(place: vec2<f32>, cascade: i32, depth: f32, spacing: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(shadow_depths));
    let middle = place * size - 0.5;
    let first = floor(middle - 1.5 * spacing);
    let end = floor(middle + 1.5 * spacing) + 2.0;
    var sum = 0.0;
    var south = first.y;
    loop {
        let down = look_weights(vec2<f32>(south, south + 1.0) - middle.y, spacing);
        var east = first.x;
        loop {
            let across = look_weights(vec2<f32>(east, east + 1.0) - middle.x, spacing);
            let corner = (vec2<f32>(east, south) + 1.0) / size;
            let open = textureGatherCompare(shadow_depths, shadow_between, corner, cascade, depth);
            sum += down.x * dot(across, open.wz) + down.y * dot(across, open.xy);
            east += 2.0;
            if east >= end.x {
                break;
            }
        }
        south += 2.0;
        if south >= end.y {
            break;
        }
    }
    return sum;
}

fn seen_in_cascade(point: vec3<f32>, normal: vec3<f32>, cascade: i32) -> f32 {
    let square = frame.cascades[cascade];
    let size = f32(textureDimensions(shadow_depths).x);
    let texel = 2.0 * max(square.z, square.w) / size;
    let facing = clamp(dot(normal, scene.sun.xyz), 0.0, 1.0);
    // Off the surface by as much as it may rise within the looks.
    let lifted = point + normal * texel * (0.3 + 1.2 * sqrt(1.0 - facing * facing));
    let at = in_cascade(lifted, cascade);
    let place = at.xy * vec2<f32>(0.5, -0.5) + 0.5;
    let range = frame.sun_up.w;
    let depth = min(at.z - 0.5 * texel / range, 1.0);
    let blocker = blocker_depth(place, cascade, depth);
    if blocker > 1.0 {
        // Around a point without anything before it there may still be the start of an edge.
        return textureSampleCompareLevel(shadow_depths, shadow_between, place, cascade, depth);
    }
    let width = (depth - blocker) * range * tan(scene.sun.w) / texel;
    let spacing = clamp(width, 0.75, WIDEST) * 0.5;
    return open_share(place, cascade, depth, spacing);
}

// The first cascade that holds a point; as many as there are where none does.
fn first_cascade(point: vec3<f32>) -> i32 {
    var first = CASCADES;
    for (var cascade = CASCADES - 1; cascade >= 0; cascade--) {
        let at = abs(in_cascade(point, cascade).xy);
        first = select(first, cascade, max(at.x, at.y) < 1.0);
    }
    return first;
}

// How much of a cascade counts for a point so far within it, at most 1: the last one ends where the landscape does.
fn share_of_cascade(cascade: i32, inside: f32) -> f32 {
    let reached = select(clamp(inside / PASSING, 0.0, 1.0), 1.0, cascade == CASCADES - 1);
    return select(0.0, reached * frame.cascade_shares[cascade], inside > 0.0);
}

// Software looks into a cascade for as long as one of several pixels wants it: each begins with its own first one.
fn sun_seen(point: vec3<f32>, normal: vec3<f32>) -> f32 {
    return sun_seen_on(point, point, normal);
}

// The same of a point of the triangles that a camera sees, which the cascades of that camera hold, and the point of the
// smooth ground there, which the last holds.
fn sun_seen_on(point: vec3<f32>, smooth_point: vec3<f32>, normal: vec3<f32>) -> f32 {
    var passed = 1.0;
    var seen = 0.0;
    let first = first_cascade(point);
    // Far beyond them numbers of texels would be too large to count by ones.
    if first >= CASCADES {
        return through_clouds(point);
    }
    var cascade = first;
    loop {
        let at = abs(in_cascade(point, cascade).xy);
        let share = share_of_cascade(cascade, 1.0 - max(at.x, at.y));
        let here = select(point, smooth_point, cascade == CASCADES - 1);
        seen += passed * share * seen_in_cascade(here, normal, cascade);
        passed *= 1.0 - share;
        cascade++;
        if cascade >= CASCADES || passed <= 0.0 {
            break;
        }
    }
    return (seen + passed) * through_clouds(point);
}
