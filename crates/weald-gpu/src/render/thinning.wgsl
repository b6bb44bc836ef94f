// How many of the sets of grass stand at a distance: the twin of `share` in choice.rs.

// Distance in metres beyond which there is no blade.
const FARTHEST = 96.0;

// Distance up to which every set stands, and how fast they become fewer beyond it.
const WHOLE = 10.0;
const THINNING = 1.15;

// Most times as broad blades become where there are fewer of them.
const BROADEST = 2.6;

// Angle of a pixel for which distances count as they are for blades, and how many times as far away as they are they count at
// least and at most.
const GRASS_PIXEL = 1e-3;
const FINEST = 0.5;
const COARSEST = 2.0;

// How many times as far away as they are blades count: as many as pixels are larger.
fn coarser() -> f32 {
    return clamp(frame.eye.w / GRASS_PIXEL, FINEST, COARSEST);
}

// A distance as it counts for the shape of blades.
fn counted(distance: f32) -> f32 {
    return distance * coarser();
}

fn share(distance: f32) -> f32 {
    let larger = max(coarser(), 1.0);
    let thinned = pow(WHOLE / max(larger * sqrt(larger) * distance, WHOLE), THINNING);
    return thinned * clamp((FARTHEST - distance) / (0.35 * FARTHEST), 0.0, 1.0);
}

// How many times as broad blades are where so many sets stand, so that a meadow stays as thick.
fn broader(share: f32) -> f32 {
    return min(1.0 / sqrt(max(share, 0.05)), BROADEST);
}
