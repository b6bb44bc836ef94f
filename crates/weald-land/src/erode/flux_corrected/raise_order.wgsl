
// The upwind step corrected by the limited antidiffusive fluxes.

/// An antidiffusive flux as far as the giving and the taking cell allow, by their shares of gains and losses;
/// `giver` is the western or northern one.
fn limited_by(flux: f32, giver: vec2<f32>, taker: vec2<f32>) -> f32 {
    return exact(flux * select(min(giver.x, taker.y), min(giver.y, taker.x), flux > 0.0));
}

@compute @workgroup_size(16, 16)
fn raise_order(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let here = shares[index(cell)];
    let flux = antidiffusive_of(cell);
    let east = limited_by(flux.x, here, shares[index(cell + EAST)]);
    let west = limited_by(flux.y, shares[index(cell + WEST)], here);
    let south = limited_by(flux.z, here, shares[index(cell + SOUTH)]);
    let north = limited_by(flux.w, shares[index(cell + NORTH)], here);
    if (inside(cell)) {
        arrive(cell, without_negligible(upwind_step[index(cell)].x + ((west - east) + (north - south))));
    }
}
