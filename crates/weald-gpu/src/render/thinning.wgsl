// How many of the sets of grass stand at a distance: the twin of `share` in choice.rs.

// Distance in metres beyond which there is no blade.
const FARTHEST = 96.0;

// Distance up to which every set stands, and how fast they become fewer beyond it.
const WHOLE = 10.0;
const THINNING = 1.15;

// Most times as broad blades become where there are fewer of them.
const BROADEST = 2.6;

// Angle of a pixel up to which distances count as they are for blades, and most times as far away as they count.
const GRASS_PIXEL = 1e-3;
const COARSEST = 2.0;

// A distance as it counts for blades: as many times farther as pixels are larger than that.
fn counted(distance: f32) -> f32 {
    return distance * clamp(frame.eye.w / GRASS_PIXEL, 1.0, COARSEST);
}

fn share(distance: f32) -> f32 {
    let thinned = pow(WHOLE / max(counted(distance), WHOLE), THINNING);
    return thinned * clamp((FARTHEST - distance) / (0.35 * FARTHEST), 0.0, 1.0);
}

// How many times as broad blades are where so many sets stand, so that a meadow stays as thick.
fn broader(share: f32) -> f32 {
    return min(1.0 / sqrt(max(share, 0.05)), BROADEST);
}
