
// What would flow to the eastern and southern neighbours if every cell had water enough.

/// Surface and depth.
fn surface(cell: vec2<i32>) -> vec2<f32> {
    let at = index(cell);
    let ground = base[at] + change[at];
    return vec2<f32>(ground + depth[at], depth[at]);
}

/// Depth, change and land; beyond the walls nothing.
fn fall(cell: vec2<i32>) -> vec3<f32> {
    let at = index(cell);
    return select(vec3<f32>(0.0), vec3<f32>(depth[at], change[at], valid(cell)), inside(cell));
}

fn wanted_through(old: f32, cell: vec2<i32>, next: vec2<i32>) -> f32 {
    let flux = edge_flux(old, surface(cell), surface(next), link(cell, next), constants.flow_rate);
    if (OPEN) {
        return overfall(flux, old, fall(cell), fall(next), constants.flow_rate);
    }
    return flux;
}

@compute @workgroup_size(16, 16)
fn flux(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let old = fluxes[index(cell)];
    let east = wanted_through(old.x, cell, cell + EAST);
    let south = wanted_through(old.y, cell, cell + SOUTH);
    if (inside(cell)) {
        wanted[index(cell)] = vec2<f32>(east, south);
    }
}
