
// Limits the fluxes to the water that cells have, and moves water and sediment by them.

fn wanted_at(cell: vec2<i32>) -> vec2<f32> {
    return select(vec2<f32>(0.0), wanted[index(cell)], inside(cell));
}

fn limited(cell: vec2<i32>) -> Limited {
    let at = index(cell);
    let here = wanted_at(cell);
    let outflow = outflow_by(here.x, wanted_at(cell + WEST).x, here.y, wanted_at(cell + NORTH).y);
    if (LIMITER) {
        return limit(depth[at], sediment[at], outflow, constants.epsilon);
    }
    return unlimited(depth[at], sediment[at], outflow, constants.epsilon);
}

@compute @workgroup_size(16, 16)
fn flow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let here = limited(cell);
    let east = limited(cell + EAST);
    let west = limited(cell + WEST);
    let south = limited(cell + SOUTH);
    let north = limited(cell + NORTH);
    let flux = vec4<f32>(
        scale(wanted_at(cell).x, here.share, east.share),
        scale(wanted_at(cell + WEST).x, west.share, here.share),
        scale(wanted_at(cell).y, here.share, south.share),
        scale(wanted_at(cell + NORTH).y, north.share, here.share),
    );
    let water = flow_of_water(depth[at], flux, valid(cell), weather.rain, weather.evaporation);
    let around =
        vec4<f32>(east.concentration, west.concentration, south.concentration, north.concentration);
    var found = sediment[at];
    if (UPWIND) {
        found = flow_of_sediment(sediment[at], flux, here.concentration, around);
    }
    tally(select(EVAPORATED, RAINED, weather.rain > 0.0), cell, water.sky);
    var kept = 1.0;
    if (OPEN) {
        kept = valid(cell);
        tally(WATER_OUT, cell, water.depth * (1.0 - kept));
        tally(SEDIMENT_OUT, cell, found * (1.0 - kept));
    }
    if (inside(cell)) {
        fluxes[at] = flux.xz;
        depth_next[at] = water.depth * kept;
        sediment_next[at] = found * kept;
    }
}
