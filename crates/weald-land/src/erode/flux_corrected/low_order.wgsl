
// The upwind step, the water after it, the range of concentrations of this cell, and what antidiffusion would
// carry east and south.

@compute @workgroup_size(16, 16)
fn low_order(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let flux = vec4<f32>(face_east(cell), face_west(cell), face_south(cell), face_north(cell));
    let here = mixed(cell);
    let to_east = mixed(cell + EAST);
    let to_south = mixed(cell + SOUTH);
    let carried_east = carried_by(flux.x, here.concentration, to_east.concentration);
    let carried_west = carried_by(flux.y, mixed(cell + WEST).concentration, here.concentration);
    let carried_south = carried_by(flux.z, here.concentration, to_south.concentration);
    let carried_north = carried_by(flux.w, mixed(cell + NORTH).concentration, here.concentration);
    let low =
        settled_sediment(cell) + ((carried_west - carried_east) + (carried_north - carried_south));
    let after = here.volume + ((flux.y - flux.x) + (flux.w - flux.z));
    let now = select(here.concentration, low / after, after > 0.0);
    let east = link(cell, cell + EAST) * antidiffusion(flux.x, here, to_east);
    let south = link(cell, cell + SOUTH) * antidiffusion(flux.z, here, to_south);
    if (inside(cell)) {
        upwind_step[index(cell)] =
            vec4<f32>(low, after, min(now, here.concentration), max(now, here.concentration));
        antidiffusive[index(cell)] = vec2<f32>(east, south);
    }
}
