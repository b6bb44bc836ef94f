// MacCormack transport that loses nothing: see flux_corrected.rs for the equations and their sources.
//
// A model says what is carried and by what: load(cell), water_before(cell), and the water through the eastern
// and southern faces, face_east(cell) and face_south(cell).

fn face_west(cell: vec2<i32>) -> f32 {
    return select(0.0, face_east(cell + WEST), cell.x > 0);
}

fn face_north(cell: vec2<i32>) -> f32 {
    return select(0.0, face_south(cell + NORTH), cell.y > 0);
}

/// Sediment in a unit of water, and the water that it is mixed in: never less than what flows out.
fn mixed_at(cell: vec2<i32>) -> vec2<f32> {
    let east = face_east(cell);
    let west = face_west(cell);
    let south = face_south(cell);
    let north = face_north(cell);
    let outflow = (max(east, 0.0) + max(-west, 0.0)) + (max(south, 0.0) + max(-north, 0.0));
    let volume = max(max(water_before(cell), 0.0) + constants.epsilon, outflow * (1.0 + KEPT));
    return vec2<f32>(load(cell) / volume, volume);
}

/// Antidiffusive flux through a face, positive to the east or south. `here` and `next` are concentration and
/// volume on its two sides.
fn antidiffusion(flux: f32, here: vec2<f32>, next: vec2<f32>) -> f32 {
    let volume = select(next.y, here.y, flux > 0.0);
    let still = 1.0 - abs(flux) / volume;
    return 0.5 * abs(flux) * still * (next.x - here.x);
}

@compute @workgroup_size(16, 16)
fn mix_load(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        mixed[index(cell)] = mixed_at(cell);
    }
}

@compute @workgroup_size(16, 16)
fn low_order(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (!inside(cell)) {
        return;
    }
    let at = index(cell);
    let east = face_east(cell);
    let west = face_west(cell);
    let south = face_south(cell);
    let north = face_north(cell);
    let here = mixed[at];
    let there_east = mixed[index(cell + EAST)];
    let there_south = mixed[index(cell + SOUTH)];
    let carried_east = east * select(there_east.x, here.x, east >= 0.0);
    let carried_west = west * select(here.x, mixed[index(cell + WEST)].x, west >= 0.0);
    let carried_south = south * select(there_south.x, here.x, south >= 0.0);
    let carried_north = north * select(here.x, mixed[index(cell + NORTH)].x, north >= 0.0);
    let low = load(cell) + ((carried_west - carried_east) + (carried_north - carried_south));
    let after = here.y + ((west - east) + (north - south));
    let now = select(here.x, low / after, after > 0.0);
    upwind_step[at] = vec4<f32>(low, after, min(now, here.x), max(now, here.x));
    antidiffusive[at] = vec2<f32>(
        link(cell, cell + EAST) * antidiffusion(east, here, there_east),
        link(cell, cell + SOUTH) * antidiffusion(south, here, there_south),
    );
}

/// The share of what is wanted that fits.
fn fitting(room_found: f32, wanted: f32) -> f32 {
    let room = max(room_found, 0.0) * (1.0 - KEPT);
    return select(1.0, room / wanted, wanted > room);
}

/// Least and most concentration of a neighbour, or of the cell itself where there is none.
fn extremes(here: vec2<i32>, there: vec2<i32>) -> vec2<f32> {
    return upwind_step[index(select(here, there, vec2<bool>(link(here, there) > 0.0)))].zw;
}

@compute @workgroup_size(16, 16)
fn concentration_range(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (!inside(cell)) {
        return;
    }
    let at = index(cell);
    let own = upwind_step[at];
    let sides = array<vec2<f32>, 4>(
        extremes(cell, cell + EAST),
        extremes(cell, cell + WEST),
        extremes(cell, cell + SOUTH),
        extremes(cell, cell + NORTH),
    );
    let bottom = min(min(own.z, min(sides[0].x, sides[1].x)), min(sides[2].x, sides[3].x));
    let top = max(max(own.w, max(sides[0].y, sides[1].y)), max(sides[2].y, sides[3].y));
    let to = antidiffusive[at];
    let from_west = select(0.0, antidiffusive[index(cell + WEST)].x, cell.x > 0);
    let from_north = select(0.0, antidiffusive[index(cell + NORTH)].y, cell.y > 0);
    let gained = (max(from_west, 0.0) + max(-to.x, 0.0)) + (max(from_north, 0.0) + max(-to.y, 0.0));
    let lost = (max(to.x, 0.0) + max(-from_west, 0.0)) + (max(to.y, 0.0) + max(-from_north, 0.0));
    shares[at] = vec2<f32>(
        fitting(top * own.y - own.x, gained),
        fitting(own.x - bottom * own.y, lost),
    );
}

/// An antidiffusive flux as far as the giving and the taking cell allow: (gain, loss) of the western or
/// northern cell, and of the other.
fn limited(flux: f32, here: vec2<f32>, there: vec2<f32>) -> f32 {
    return flux * select(min(here.x, there.y), min(here.y, there.x), flux > 0.0);
}

/// The load after the step.
fn corrected(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    let here = shares[at];
    let to = antidiffusive[at];
    let west_at = index(cell + WEST);
    let north_at = index(cell + NORTH);
    let from_west = select(0.0, antidiffusive[west_at].x, cell.x > 0);
    let from_north = select(0.0, antidiffusive[north_at].y, cell.y > 0);
    let east = limited(to.x, here, shares[index(cell + EAST)]);
    let west = limited(from_west, shares[west_at], here);
    let south = limited(to.y, here, shares[index(cell + SOUTH)]);
    let north = limited(from_north, shares[north_at], here);
    return worth_counting(upwind_step[at].x + ((west - east) + (north - south)));
}
