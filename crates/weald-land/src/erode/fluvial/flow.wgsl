
// Scales the fluxes to the water that cells have, moves water and sediment by them, says what they take up, and how much
// the bed will hold them back in the next step.

/// The flux through an edge, scaled to what its giving cell can give.
fn through(wanted: f32, here: vec4<f32>, next: vec4<f32>) -> f32 {
    return exact(wanted * select(next.x, here.x, wanted > 0.0));
}

/// Share of the power that reaches the bed.
fn reaches_bed(depth: f32) -> f32 {
    let shallow = constants.deepest / max(depth, constants.deepest);
    return shallow * shallow * shallow;
}

/// Sediment through an edge, with the concentration of the cell that the flux comes from.
fn carried_by(flux: f32, behind: vec4<f32>, ahead: vec4<f32>) -> f32 {
    return exact(flux * select(ahead.y, behind.y, flux >= 0.0));
}

fn surface_at(cell: vec2<i32>) -> f32 {
    return select(0.0, level[index(cell)].x, inside(cell));
}

@compute @workgroup_size(16, 16)
fn flow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let here = limits[at];
    let east = limits[index(cell + EAST)];
    let west = limits[index(cell + WEST)];
    let south = limits[index(cell + SOUTH)];
    let north = limits[index(cell + NORTH)];
    let south_east = limits[index(cell + SOUTH_EAST)];
    let north_west = limits[index(cell + NORTH_WEST)];
    let south_west = limits[index(cell + SOUTH_WEST)];
    let north_east = limits[index(cell + NORTH_EAST)];
    let wish = wanted_at(cell);
    let axes = vec4<f32>(
        through(wish.x, here, east),
        through(wanted_at(cell + WEST).x, west, here),
        through(wish.y, here, south),
        through(wanted_at(cell + NORTH).y, north, here),
    );
    let diagonals = vec4<f32>(
        through(wish.z, here, south_east),
        through(wanted_at(cell + NORTH_WEST).z, north_west, here),
        through(wish.w, here, south_west),
        through(wanted_at(cell + NORTH_EAST).w, north_east, here),
    );
    let gained = ((axes.y - axes.x) + (axes.w - axes.z))
        + ((diagonals.y - diagonals.x) + (diagonals.w - diagonals.z));
    let surface = level[at].x;
    let flowed = exact(without_negligible(level[at].z + gained));
    let brought_along_axes = (carried_by(axes.y, west, here) - carried_by(axes.x, here, east))
        + (carried_by(axes.w, north, here) - carried_by(axes.z, here, south));
    let brought_along_diagonals = (carried_by(diagonals.y, north_west, here) - carried_by(diagonals.x, here, south_east))
        + (carried_by(diagonals.w, north_east, here) - carried_by(diagonals.z, here, south_west));
    let found = exact(without_negligible(here.z + (brought_along_axes + brought_along_diagonals)));
    let kept = valid(cell);
    tally(WATER_OUT, cell, flowed * (1.0 - kept));
    tally(SEDIMENT_OUT, cell, found * (1.0 - kept));
    let along_axes = vec4<f32>(
        surface_at(cell + EAST), surface_at(cell + WEST), surface_at(cell + SOUTH), surface_at(cell + NORTH),
    );
    let along_diagonals = vec4<f32>(
        surface_at(cell + SOUTH_EAST),
        surface_at(cell + NORTH_WEST),
        surface_at(cell + SOUTH_WEST),
        surface_at(cell + NORTH_EAST),
    );
    let power = power_of(axes, diagonals, surface, along_axes, along_diagonals);
    let discharge = discharge_of(axes, diagonals);
    let occupied = occupied(discharge);
    let by_width = power / occupied * reaches_bed(level[at].z);
    let uptake = max(constants.erodibility * here.w * (by_width - constants.threshold), 0.0);
    let drop = select(0.0, min(power / discharge.size, MAX_DROP), discharge.size > 0.0);
    let entrained = min(uptake, MAX_SHARE_OF_DROP * drop);
    let held = max(constants.friction * discharge.size, power);
    if (inside(cell)) {
        fluxes[at] = vec4<f32>(axes.x, axes.z, diagonals.x, diagonals.z);
        let across = levelled(discharge.size, constants.lateral_wear * entrained, level[at].z + constants.thin);
        carried[at] = vec4<f32>(found * kept, entrained, flowed * kept, across);
        resistance[at] = 0.5 * (resistance[at] + held / discharge.gathered * occupied);
    }
}
