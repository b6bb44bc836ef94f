// How many of the sets of grass stand at a distance: the twin of `Detail::share` in choice.rs.

// Distance in metres beyond which there is no blade, but where they reach farther.
const FARTHEST = 96.0;

// How fast sets become fewer beyond where all stand.
const THINNING = 1.15;

// Most times as broad blades become where there are fewer of them.
const BROADEST = 2.6;

// Angle of a pixel for which distances count as they are for blades, and how many times as far away as they are they count at
// least and at most.
const GRASS_PIXEL = 1e-3;
const FINEST = 0.5;
const COARSEST = 2.0;

// How many times as far away as they are blades count: as many as pixels are larger, which count as smaller where blades reach farther.
fn coarser() -> f32 {
    return clamp(frame.eye.w / (GRASS_PIXEL * frame.pixel.z), FINEST, COARSEST);
}

// A distance as it counts for the shape of blades.
fn counted(distance: f32) -> f32 {
    return distance * coarser();
}

fn share(distance: f32) -> f32 {
    let larger = max(coarser(), 1.0);
    let within = distance / frame.pixel.z;
    let whole = frame.pixel.w;
    let thinned = pow(whole / max(larger * sqrt(larger) * within, whole), THINNING);
    return thinned * clamp((FARTHEST - within) / (0.35 * FARTHEST), 0.0, 1.0);
}

// How many times as broad blades are where so many sets stand, so that a meadow stays as thick.
fn broader(share: f32) -> f32 {
    return min(1.0 / sqrt(max(share, 0.05)), BROADEST);
}
