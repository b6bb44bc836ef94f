
// Fluxes through the eastern, southern, south-eastern and south-western edge, if every cell had water enough.

/// Flux through an edge after a step; `here` and `next` are surface, ground and depth on its two sides.
fn accelerated(old: f32, here: vec4<f32>, next: vec4<f32>, conductance: f32, resistance: f32) -> f32 {
    let depth = min(max(here.x, next.x) - max(here.y, next.y), constants.deepest);
    let gained = old + conductance * depth * (here.x - next.x);
    let held = 1.0 + resistance / (depth * depth);
    return select(0.0, gained / held, depth > THINNEST);
}

/// What would fall from a cell over an open edge.
fn fall(cell: vec2<i32>) -> f32 {
    return select(0.0, level[index(cell)].w, inside(cell));
}

fn wanted_through(old: f32, cell: vec2<i32>, next: vec2<i32>, weight: f32) -> f32 {
    let here = level[index(cell)];
    let there = level[index(next)];
    let held = 0.5 * (resistance[index(cell)] + resistance[index(next)]);
    let flux = accelerated(old, here, there, weight * constants.flow_rate, held) * link(cell, next);
    let outward = valid(cell) - valid(next);
    let falling = outward * (weight * constants.open) * select(fall(next), fall(cell), outward > 0.0);
    return select(falling, flux, outward == 0.0);
}

@compute @workgroup_size(16, 16)
fn accelerate(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let old = fluxes[index(cell)];
    let east = wanted_through(old.x, cell, cell + EAST, PIPE_AXIS);
    let south = wanted_through(old.y, cell, cell + SOUTH, PIPE_AXIS);
    let south_east = wanted_through(old.z, cell, cell + SOUTH_EAST, PIPE_DIAGONAL);
    let south_west = wanted_through(old.w, cell, cell + SOUTH_WEST, PIPE_DIAGONAL);
    if (inside(cell)) {
        wanted[index(cell)] = vec4<f32>(east, south, south_east, south_west);
    }
}
