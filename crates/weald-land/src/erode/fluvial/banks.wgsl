
// The wear of banks; the twin of banks.rs.

const MOST_LEVELLED: f32 = 0.2;

/// 1 where water may change the ground; cells at an open edge hold the base level, at its corners too.
fn may_change(cell: vec2<i32>) -> f32 {
    let main = valid(cell + SOUTH_EAST) * valid(cell + NORTH_WEST);
    let other = valid(cell + SOUTH_WEST) * valid(cell + NORTH_EAST);
    return erodible(cell) * (1.0 - constants.open * (1.0 - main * other));
}

/// Share of the step between two cells that levels across a channel which is wider than they are.
fn levelled(discharge: f32, uptake: f32, depth: f32) -> f32 {
    let width = constants.channel_width * constants.channel_width * discharge;
    let wider = clamp(width - 1.0, 0.0, 1.0);
    return min(uptake * (width * width) * wider / depth, MOST_LEVELLED);
}

/// What comes over an edge from the next cell by the wear of banks; `here` and `next` are ground, what levels across channels, and
/// depth of water on its two sides.
fn washed(here: vec3<f32>, next: vec3<f32>) -> f32 {
    let step = next.x - here.x;
    let deep = max(here.z, next.z);
    let worn = max(-deep, min(step, deep));
    return 0.5 * (here.y + next.y) * worn;
}
