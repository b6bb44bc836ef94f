
// Virtual pipes with one signed flux an edge; the twin of pipes.rs, which has the method and its source.

const RETAINED_SHARE: f32 = 1e-6;
const NEGLIGIBLE: f32 = 1e-20;

/// The amount, or nothing where it is less than counts.
fn without_negligible(amount: f32) -> f32 {
    return select(amount, 0.0, abs(amount) < NEGLIGIBLE);
}

/// Signed flux through an edge; `here` and `next` are surface and depth on its two sides.
fn edge_flux(old: f32, here: vec2<f32>, next: vec2<f32>, link: f32, flow_rate: f32) -> f32 {
    let drop = here.x - next.x;
    let donor_of_drop = select(next.y, here.y, drop > 0.0);
    let gained = old + select(0.0, flow_rate * drop, donor_of_drop > 0.0);
    let donor = select(next.y, here.y, gained > 0.0);
    return select(0.0, gained * link, donor > 0.0);
}

/// Sine of the slope along an edge with this rise.
fn sine(rise: f32, link: f32) -> f32 {
    return abs(rise) * link / sqrt(1.0 + rise * rise);
}

/// What the flux from a cell with data into one without becomes: a free fall. `here` and `next` are depth,
/// change and land on its two sides.
fn overfall(flux: f32, old: f32, here: vec3<f32>, next: vec3<f32>, flow_rate: f32) -> f32 {
    let outward = here.z - next.z;
    let head = (here.x + here.y) * here.z - (next.x + next.y) * next.z;
    let gained = old + flow_rate * head;
    return select(select(0.0, flux, outward == 0.0), gained, outward * gained > 0.0);
}

/// What leaves a cell by its signed fluxes.
fn outflow_by(east: f32, west: f32, south: f32, north: f32) -> f32 {
    return (max(east, 0.0) + max(-west, 0.0)) + (max(south, 0.0) + max(-north, 0.0));
}

/// What share of its outflow a cell can give, and how much sediment a unit of its outflow carries.
struct Limited {
    share: f32,
    concentration: f32,
}

fn limit(depth: f32, sediment: f32, outflow: f32, epsilon: f32) -> Limited {
    let available = depth * (1.0 - RETAINED_SHARE);
    return Limited(select(1.0, available / outflow, outflow > available), sediment / (depth + epsilon));
}

fn unlimited(depth: f32, sediment: f32, outflow: f32, epsilon: f32) -> Limited {
    return Limited(1.0, sediment / max(max(depth, 0.0) + epsilon, outflow));
}

/// The flux through an edge, scaled to what its giving cell can give.
fn scale(wanted: f32, share: f32, share_next: f32) -> f32 {
    return exact(wanted * select(share_next, share, wanted > 0.0));
}
