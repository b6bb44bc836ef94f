
// Sums over the eight edges of a cell; the twin of edges.rs.

const AXIS: f32 = 0.6666666666666666;
const DIAGONAL: f32 = 0.16666666666666666;
const PIPE_AXIS: f32 = 0.54;
const PIPE_DIAGONAL: f32 = 0.23;
const STILL: f32 = 1e-30;
const MOST_GATHERED: f32 = 3.7037037;
const SHORTEST: f32 = 0.5;
const LEAST_OCCUPIED: f32 = 0.01;
const RETAINED_SHARE: f32 = 2e-6;
const THINNEST: f32 = 1e-8;
const MAX_SHARE_OF_DROP: f32 = 0.25;
const MAX_DROP: f32 = 2.0;
const NEGLIGIBLE: f32 = 1e-20;

const SOUTH_EAST: vec2<i32> = vec2<i32>(1, 1);
const SOUTH_WEST: vec2<i32> = vec2<i32>(-1, 1);
const NORTH_EAST: vec2<i32> = vec2<i32>(1, -1);
const NORTH_WEST: vec2<i32> = vec2<i32>(-1, -1);

/// The amount, or nothing where it is less than counts.
fn without_negligible(amount: f32) -> f32 {
    return select(amount, 0.0, abs(amount) < NEGLIGIBLE);
}

/// The size of a cell's discharge, how much it has gathered, and all that runs through.
struct Discharge {
    size: f32,
    gathered: f32,
    through: f32,
}

fn sum_of_sizes(fluxes: vec4<f32>) -> f32 {
    return (abs(fluxes.x) + abs(fluxes.y)) + (abs(fluxes.z) + abs(fluxes.w));
}

fn sum_of_squares(fluxes: vec4<f32>) -> f32 {
    return (fluxes.x * fluxes.x + fluxes.y * fluxes.y) + (fluxes.z * fluxes.z + fluxes.w * fluxes.w);
}

/// `axes` are the fluxes through the eastern, western, southern and northern edge, `diagonals` those through the
/// south-eastern, north-western, south-western and north-eastern one.
fn discharge_of(axes: vec4<f32>, diagonals: vec4<f32>) -> Discharge {
    let main = diagonals.x + diagonals.y;
    let other = diagonals.z + diagonals.w;
    let eastward = 0.5 * ((axes.x + axes.y) + (main - other));
    let southward = 0.5 * ((axes.z + axes.w) + (main + other));
    let energy = 0.5 * (sum_of_squares(axes) / PIPE_AXIS + sum_of_squares(diagonals) / PIPE_DIAGONAL);
    let square = eastward * eastward + southward * southward;
    let gathered = select(MOST_GATHERED, clamp(energy / square, 1.0, MOST_GATHERED), square > STILL);
    let through = 0.5 * (sum_of_sizes(axes) + sum_of_sizes(diagonals));
    return Discharge(sqrt(square), gathered, through);
}

/// Share of the ground that the channels of a discharge take.
fn occupied(discharge: Discharge) -> f32 {
    let single = clamp((discharge.gathered - 1.0) * 2.0, 0.0, 1.0);
    let apart = constants.gathering + (1.0 - constants.gathering) * single;
    let carried = discharge.size + (discharge.through - discharge.size) * single;
    let length = select(SHORTEST, max(discharge.size / carried, SHORTEST), carried > 0.0);
    let width = constants.channel_width * sqrt(carried * apart);
    return clamp(width * length / apart, LEAST_OCCUPIED, 1.0);
}

fn leaving(fluxes: vec4<f32>) -> f32 {
    return (max(fluxes.x, 0.0) + max(-fluxes.y, 0.0)) + (max(fluxes.z, 0.0) + max(-fluxes.w, 0.0));
}

fn given(fluxes: vec4<f32>, surface: f32, along: vec4<f32>) -> f32 {
    return (max(fluxes.x, 0.0) * (surface - along.x) + max(-fluxes.y, 0.0) * (surface - along.y))
        + (max(fluxes.z, 0.0) * (surface - along.z) + max(-fluxes.w, 0.0) * (surface - along.w));
}

/// Power of what leaves a cell; `along_axes` and `along_diagonals` are the surfaces of its neighbours.
fn power_of(
    axes: vec4<f32>, diagonals: vec4<f32>, surface: f32, along_axes: vec4<f32>, along_diagonals: vec4<f32>,
) -> f32 {
    return max(given(axes, surface, along_axes) + given(diagonals, surface, along_diagonals), 0.0);
}

/// What leaves a cell.
fn outflow(axes: vec4<f32>, diagonals: vec4<f32>) -> f32 {
    return leaving(axes) + leaving(diagonals);
}
