//! How much snow lies at a point: by altitude, slope, sun and wind, and in patches where it begins.
//!
//! A score adds up what keeps snow and what takes it: height above the line, hollows that hold it, slopes that it slides
//! off, the sun on slopes that face south, and wind from the west that carries it over crests onto their eastern sides.
//! Over a third of the relief the score goes from none to all; between them, noise says which places are white already.
//! All numbers are chosen by eye.

use super::vector::ramp;

/// Share of the relief that a score of 1 is.
const SCALE: f32 = 0.16;

/// What a slope that faces south loses to one that faces north, and one that faces west to one that faces east: half of it.
const SUN: f32 = 0.8;
const WIND: f32 = 0.35;

/// Densities of woods between which patches, hollows and shady slopes come to count for nothing.
const WOODS: [f32; 2] = [0.1, 0.6];

/// What snow lies on.
#[derive(Clone, Copy, Debug)]
pub(super) struct SnowSpot {
    /// Height above the snow line in reliefs; negative below it.
    pub(super) above: f32,
    /// Rise over run, and the same over that of bare rock.
    pub(super) slope: f32,
    pub(super) steepness: f32,
    /// The direction of the fall line, eastward and northward.
    pub(super) fall: [f32; 2],
    /// From -0.5 on crests to 0.5 in hollows.
    pub(super) hollow: f32,
    /// Noise: patches of many cells, detail finer than a cell, gullies.
    pub(super) noise: [f32; 3],
    /// How densely trees stand, 0 to 1.
    pub(super) wooded: f32,
}

/// Share of the ground that snow hides.
pub(super) fn snow_share(spot: &SnowSpot) -> f32 {
    let [broad, fine, gully] = spot.noise;
    // What drifts into hollows, slides down gullies or stays on shady slopes does so in the open.
    let open = 1.0 - ramp(spot.wooded, WOODS[0], WOODS[1]);
    let sloping = ramp(spot.slope, 0.1, 0.6);
    let aspect = sloping * (SUN * spot.fall[1] + WIND * spot.fall[0]);
    // It slides off what is a third steeper than bare rock.
    let hold = (1.3 - spot.steepness).min(0.6);
    let score = spot.above / SCALE + aspect.min(open * aspect) + 1.6 * hold + 1.3 * open * spot.hollow;
    let whole = ramp(score, -0.2, 2.0);
    let patches = 4.0 * open * whole * (1.0 - whole) * (0.6 * broad + 0.4 * fine + 1.4 * gully);
    let dusting = 0.25 * open * ramp(score, -0.2, 1.2) * (0.6 + fine).clamp(0.0, 1.0);
    ramp(whole + patches, 0.38, 0.62).max(dusting)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot() -> SnowSpot {
        SnowSpot {
            above: 0.0,
            slope: 0.4,
            steepness: 0.6,
            fall: [0.0; 2],
            hollow: 0.0,
            noise: [0.0; 3],
            wooded: 0.0,
        }
    }

    fn line(of: impl Fn(f32) -> SnowSpot) -> f32 {
        let heights = (-400..400).map(|step| 0.001 * step as f32);
        let half = heights.into_iter().find(|&above| snow_share(&of(above)) > 0.5);
        half.expect("high enough there is snow")
    }

    #[test]
    fn snow_lies_lower_on_northern_and_eastern_slopes_and_in_hollows() {
        let facing = |fall: [f32; 2]| line(|above| SnowSpot { above, fall, ..spot() });
        assert!(facing([0.0, 1.0]) < facing([0.0, -1.0]) - 0.05, "north and south");
        assert!(facing([1.0, 0.0]) < facing([-1.0, 0.0]) - 0.02, "lee and windward");
        let hollow = |hollow: f32| line(|above| SnowSpot { above, hollow, ..spot() });
        assert!(hollow(0.3) < hollow(-0.3) - 0.05);
        let steep = |steepness: f32| line(|above| SnowSpot { above, steepness, ..spot() });
        assert!(steep(0.6) < steep(1.6) - 0.05, "it slides off cliffs");
    }

    #[test]
    fn the_edge_of_snow_is_broken_by_noise_and_not_a_line() {
        // At one height about the line, some places are white and others bare.
        let share = |fine: f32| snow_share(&SnowSpot { above: -0.01, noise: [0.0, fine, 0.0], ..spot() });
        assert!(share(0.4) > 0.8 && share(-0.4) < 0.2, "{} and {}", share(0.4), share(-0.4));
        let far = |above: f32, fine: f32| snow_share(&SnowSpot { above, noise: [0.0, fine, 0.0], ..spot() });
        assert!(far(0.3, -0.5) > 0.95 && far(-0.4, 0.5) < 0.05);
    }

    #[test]
    fn no_patch_of_snow_lies_in_a_wood_below_the_line() {
        let gully = |above: f32, wooded: f32| {
            snow_share(&SnowSpot { above, wooded, noise: [0.0, 0.0, 0.5], ..spot() })
        };
        let below = (-300..0)
            .map(|step| 0.001 * step as f32)
            .filter(|&above| snow_share(&SnowSpot { above, ..spot() }) < 0.3);
        let below: Vec<_> = below.filter(|&above| gully(above, 0.0) > 0.5).collect();
        assert!(below.len() > 5, "in the open a gully has some: {}", below.len());
        assert!(below.iter().all(|&above| gully(above, 1.0) < 0.3));
        assert!(gully(0.3, 1.0) > 0.95, "high up all is white");
    }
}
