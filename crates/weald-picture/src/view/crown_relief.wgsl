// Twin of `crown_relief.rs`: crowns of woods as they are seen aslant.

// Height of the crowns of a layer beside their spacing, at most so many metres, and the steps in which a line of sight comes down
// to them.
const WOOD_RISE = 0.5;
const WOOD_MOST_RISE = 12.0;
const WOOD_STEPS = 4u;

// Towards the eye from the point in question, without exaggeration; of any length.
var<private> sight: vec3<f32> = vec3<f32>(0.0, 0.0, 1.0);

// Height of an eye above the ground as a share of its distance, from which crowns are seen from no lower.
const LOWEST_SIGHT = 0.25;

// How far the line of sight goes aside for each metre that it comes nearer to the ground, from the eye's side.
fn aslant(spot: SurfacePoint) -> vec2<f32> {
    let rising = sight.z + spot.slope * dot(spot.fall, sight.xy);
    return sight.xy / max(rising, LOWEST_SIGHT * length(sight));
}

// Metres above the ground that no crown is higher than.
fn highest_crown(footprint: f32) -> f32 {
    var sum = 0.0;
    var spacing = WOOD_SPACING;
    var finer = 0.0;
    for (var layer = 0u; layer < WOOD_LAYERS; layer++) {
        let seen = max(seen_of_layer(layer, spacing, footprint), finer);
        sum += (seen - finer) * min(WOOD_RISE * spacing, WOOD_MOST_RISE);
        finer = seen;
        spacing *= WOOD_COARSER;
    }
    return sum;
}

// Height of the crowns at a point in metres, where woods are so dense.
fn crown_height(point: vec2<f32>, density: f32, footprint: f32) -> f32 {
    var sum = 0.0;
    var place = point;
    var spacing = WOOD_SPACING;
    var finer = 0.0;
    var stands = vec2<f32>(density, MIDDLE_AGE);
    var layer = 0u;
    loop {
        let seen = max(seen_of_layer(layer, spacing, footprint), finer);
        if seen > finer {
            let height = dome(place / spacing, WOOD_SEED + layer, stands.x, stands.y).height;
            sum += (seen - finer) * min(WOOD_RISE * spacing, WOOD_MOST_RISE) * height;
        }
        finer = seen;
        spacing *= WOOD_COARSER;
        place = turned_lattice(place);
        stands = GROUPS;
        layer++;
        if layer >= WOOD_LAYERS {
            break;
        }
    }
    return sum;
}

// At which height a line of sight crosses what stands on the ground, between a step at which it was so high and so far above that, and one
// at which it is below: where it would were both straight.
fn crossed_at(before: vec2<f32>, now: vec2<f32>) -> f32 {
    return before.x + before.y / max(before.y - now.y, 1e-6) * (now.x - before.x);
}

// Where a line of sight to a point of the ground meets the crowns of a wood, as a point to look at from straight above: relief
// mapping (Policarpo, Oliveira and Comba 2005).
fn seen_crown(point: vec2<f32>, density: f32, footprint: f32, aslant: vec2<f32>) -> vec2<f32> {
    let top = highest_crown(footprint);
    var found = 0.0;
    var above = vec2<f32>(top, 0.0);
    var step = 0u;
    loop {
        let up = top * (1.0 - f32(step) / f32(WOOD_STEPS));
        let left = up - crown_height(point + up * aslant, density, footprint);
        let is_met = step > 0u && left <= 0.0;
        found = select(found, crossed_at(above, vec2<f32>(up, left)), is_met);
        above = vec2<f32>(up, left);
        step++;
        // Where there is no wood nothing is looked for.
        if is_met || step > WOOD_STEPS || density <= 0.0 {
            break;
        }
    }
    return point + found * aslant;
}
