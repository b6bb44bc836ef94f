// Twin of `crown_relief.rs`: crowns of woods as they are seen aslant.

// Height of the crowns of a layer beside their spacing, at most so many metres, and the steps in which a line of sight comes down
// to them.
const WOOD_RISE = 0.5;
const WOOD_MOST_RISE = 12.0;
const WOOD_STEPS = 4u;

// Height of the crowns at a point in metres, where woods are so dense; of domes that are all as high as the highest where `flat`
// is 1.
fn crown_height(point: vec2<f32>, density: f32, footprint: f32, flat: f32) -> f32 {
    var sum = 0.0;
    var place = point;
    var spacing = WOOD_SPACING;
    var finer = 0.0;
    for (var layer = 0u; layer < WOOD_LAYERS; layer++) {
        let single = layer == 0u;
        spacing *= select(WOOD_COARSER, 1.0, single);
        place = select(turned_lattice(place), place, single);
        let seen = grain_visible(footprint, select(1.4, WOOD_SINGLE, single) * spacing);
        let share = max(seen, finer) - finer;
        finer = max(seen, finer);
        let looks = select(0u, 1u, share > 0.0);
        for (var look = 0u; look < looks; look++) {
            let stands = select(GROUPS, vec2<f32>(density, MIDDLE_AGE), single);
            var height = 1.0;
            if flat < 1.0 {
                height = dome(place / spacing, WOOD_SEED + layer, stands.x, stands.y).height;
            }
            sum += share * min(WOOD_RISE * spacing, WOOD_MOST_RISE) * height;
        }
    }
    return sum;
}

// Where a line of sight to a point of the ground meets the crowns of a wood, as a point to look at from straight above: relief
// mapping (Policarpo, Oliveira and Comba 2005).
fn seen_crown(point: vec2<f32>, density: f32, footprint: f32, aslant: vec2<f32>) -> vec2<f32> {
    let top = crown_height(point, density, footprint, 1.0);
    var found = 0.0;
    var above = vec2<f32>(top, 0.0);
    // Where there is no wood nothing is looked for.
    let steps = select(0u, WOOD_STEPS + 1u, density > 0.0);
    for (var step = 0u; step < steps; step++) {
        let up = top * (1.0 - f32(step) / f32(WOOD_STEPS));
        let left = up - crown_height(point + up * aslant, density, footprint, 0.0);
        if step > 0u && left <= 0.0 {
            found = above.x + above.y / max(above.y - left, 1e-6) * (up - above.x);
            break;
        }
        above = vec2<f32>(up, left);
    }
    return point + found * aslant;
}
