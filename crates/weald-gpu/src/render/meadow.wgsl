// Grass where it is looked at: each blade from its instance of 16 bytes, thinned and coarser with the distance.

// Distances in metres up to which blades have their finest and middle shapes, and beyond which there is none.
const NEAR = 9.0;
const MIDDLE = 28.0;
const FARTHEST = 96.0;

// Distance up to which every set stands, and how fast they become fewer beyond it.
const WHOLE = 10.0;
const THINNING = 1.15;

// Share of ranks over which a set that is thinned out sinks away, so that none vanishes at once.
const SINKING = 0.25;

// Share of light that comes through a blade.
const THROUGH = 0.45;

// Where a set stands, on the ground.
fn grass_root(place: vec2<f32>) -> vec3<f32> {
    let point = vec3<f32>(place.x, -place.y, 0.0);
    return vec3<f32>(point.xy, spline_at(bed, place_of(point)));
}

// How many of the sets stand at a distance.
fn grass_share(distance: f32) -> f32 {
    let thinned = pow(WHOLE / max(distance, WHOLE), THINNING);
    return thinned * clamp((FARTHEST - distance) / (0.35 * FARTHEST), 0.0, 1.0);
}

// How high a set stands at a distance, as a share: 0 where it is thinned out.
fn grass_height_share(tuft: Set, distance: f32) -> f32 {
    let rank = lot(tuft.seed, 7u, PHASE);
    let share = grass_share(distance);
    return clamp((share * (1.0 + SINKING) - rank) / SINKING, 0.0, 1.0);
}

// The list of a distance: 0 for the finest blades.
fn grass_list(distance: f32) -> u32 {
    return select(select(2u, 1u, distance < MIDDLE), 0u, distance < NEAR);
}

// Whether a ball of a radius around a point, seen from the eye, may be in the picture.
fn is_grass_in_sight(away: vec3<f32>, radius: f32) -> bool {
    let depth = dot(away, frame.forward.xyz);
    let aside = vec2<f32>(dot(away, frame.right.xyz), dot(away, frame.up.xyz));
    let half = vec2<f32>(frame.right.w, frame.up.w);
    return depth > -radius && all(abs(aside) <= depth * half + radius * sqrt(1.0 + half * half));
}
