
// Shares of its antidiffusive gains and losses that a cell can take without leaving the range of
// concentrations around it.

/// The share of what is wanted that fits.
fn fitting(found: f32, wanted: f32) -> f32 {
    let room = max(found, 0.0) * (1.0 - RETAINED_SHARE);
    return select(1.0, room / wanted, wanted > room);
}

/// Least and most concentration of a neighbour, or of the cell itself where there is none.
fn extremes(here: vec2<i32>, there: vec2<i32>) -> vec2<f32> {
    return upwind_step[index(select(here, there, link(here, there) > 0.0))].zw;
}

@compute @workgroup_size(16, 16)
fn range(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let own = upwind_step[index(cell)];
    let east = extremes(cell, cell + EAST);
    let west = extremes(cell, cell + WEST);
    let south = extremes(cell, cell + SOUTH);
    let north = extremes(cell, cell + NORTH);
    let bottom = min(min(own.z, min(east.x, west.x)), min(south.x, north.x));
    let top = max(max(own.w, max(east.y, west.y)), max(south.y, north.y));
    let flux = antidiffusive_of(cell);
    let gained = (max(flux.y, 0.0) + max(-flux.x, 0.0)) + (max(flux.w, 0.0) + max(-flux.z, 0.0));
    let lost = (max(flux.x, 0.0) + max(-flux.y, 0.0)) + (max(flux.z, 0.0) + max(-flux.w, 0.0));
    if (inside(cell)) {
        shares[index(cell)] =
            vec2<f32>(fitting(exact(top * own.y) - own.x, gained), fitting(own.x - exact(bottom * own.y), lost));
    }
}
