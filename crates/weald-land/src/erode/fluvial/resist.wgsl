
// How much the bed holds back: the friction of the flow of the step before, a unit of depth².

fn old(cell: vec2<i32>) -> vec4<f32> {
    return select(vec4<f32>(0.0), fluxes[index(cell)], inside(cell));
}

fn surface_at(cell: vec2<i32>) -> f32 {
    return select(0.0, level[index(cell)].x, inside(cell));
}

@compute @workgroup_size(16, 16)
fn resist(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let here = old(cell);
    let axes = vec4<f32>(here.x, old(cell + WEST).x, here.y, old(cell + NORTH).y);
    let diagonals = vec4<f32>(here.z, old(cell + NORTH_WEST).z, here.w, old(cell + NORTH_EAST).w);
    let surface = surface_at(cell);
    let along_axes = vec4<f32>(
        surface_at(cell + EAST), surface_at(cell + WEST), surface_at(cell + SOUTH), surface_at(cell + NORTH),
    );
    let along_diagonals = vec4<f32>(
        surface_at(cell + SOUTH_EAST),
        surface_at(cell + NORTH_WEST),
        surface_at(cell + SOUTH_WEST),
        surface_at(cell + NORTH_EAST),
    );
    let discharge = discharge_of(axes, diagonals);
    let power = power_of(axes, diagonals, surface, along_axes, along_diagonals);
    let held = max(constants.friction * discharge.size, power);
    if (inside(cell)) {
        resistance[index(cell)] = held / discharge.gathered * occupied(discharge);
    }
}
