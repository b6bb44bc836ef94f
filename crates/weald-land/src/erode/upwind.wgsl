
// Water and sediment carried by the fluxes of a step; the twin of upwind.rs.

/// Depth after the fluxes of a step, and what the sky gave or took.
struct Flowed {
    depth: f32,
    sky: f32,
}

/// `flux` holds the fluxes through the eastern, western, southern and northern edge.
fn flow_of_water(before: f32, flux: vec4<f32>, valid: f32, rain: f32, evaporation: f32) -> Flowed {
    let flowed = exact(before + ((flux.y - flux.x) + (flux.w - flux.z)));
    let depth = exact(without_negligible(flowed + rain * valid - min(max(flowed, 0.0), evaporation * valid)));
    return Flowed(depth, depth - flowed);
}

/// Sediment through an edge: the flux with the concentration of the cell that it comes from.
fn carried_by(flux: f32, concentration_behind: f32, concentration_ahead: f32) -> f32 {
    return exact(flux * select(concentration_ahead, concentration_behind, flux >= 0.0));
}

/// Sediment after the fluxes of a step; `around` holds the concentrations of the four neighbours.
fn flow_of_sediment(before: f32, flux: vec4<f32>, concentration: f32, around: vec4<f32>) -> f32 {
    let to_east = carried_by(flux.x, concentration, around.x);
    let from_west = carried_by(flux.y, around.y, concentration);
    let to_south = carried_by(flux.z, concentration, around.z);
    let from_north = carried_by(flux.w, around.w, concentration);
    return without_negligible(before + ((from_west - to_east) + (from_north - to_south)));
}
