//! How fast water runs, how much it can carry, and what it takes from or gives to the ground.
//!
//! Han 2015, eq. 10–16: face velocity is flux over the mean depth of both cells; the mean sine of the slopes
//! around a cell gives the capacity `K_c |v| sin a · d`; water takes `K_v |v|` (or, in the comparison with
//! dissolution, a share of the unused transport capacity), keeps what it can carry and drops the rest, of which the
//! ground gets back the deposit ratio `r`.
//!
//! Ground is kept as start height plus change, because a thin sheet of water on a high mountain wears less in a step
//! than the last digit of its height: the change alone has the digits.

use weald_engine::kernel;

kernel! {
    /// Velocity through the eastern and southern faces of each cell, in cells per step (eq. 11).
    pub(crate) struct FaceVelocities {
        reads { flux_east, flux_south, depth, depth_east, depth_south }
        updates {}
        writes { east, south }
        constants { velocity_epsilon: f32 }
    }
    fn cell() {
        let here = depth.max(0.0);
        east = flux_east / ((here + depth_east.max(0.0)) * 0.5 + velocity_epsilon);
        south = flux_south / ((here + depth_south.max(0.0)) * 0.5 + velocity_epsilon);
    }
}

kernel! {
    /// Cell velocity from its faces.
    pub(crate) struct CellVelocity {
        reads { east, west, south, north }
        updates {}
        writes { eastward, southward }
        constants {}
    }
    fn cell() {
        eastward = (west + east) * 0.5;
        southward = (north + south) * 0.5;
    }
}

/// Takes sediment from the ground, or gives it back where `taken` is negative. Water takes exactly what the
/// ground's rounded change lost, so that nothing vanishes in rounding.
#[inline(always)]
fn settle(found: f32, taken: f32, change: f32, ratio: f32) -> (f32, f32, f32) {
    let eroded = change - taken.max(0.0);
    let deposit = (-taken).max(0.0);
    if taken > 0.0 {
        (eroded, found + (change - eroded), 0.0)
    } else {
        (change + ratio * deposit, found - deposit, (1.0 - ratio) * deposit)
    }
}

kernel! {
    /// Takes sediment by the speed of the water (`K_v |v|`, eq. 13) and by the share `K_s` of its unused
    /// transport capacity (the dissolution that Han 2015, fig. 8, compares with), and settles what the water cannot
    /// carry (eq. 10, 12, 14–16). `lost` is the part of the deposit that shrinking takes out.
    pub(crate) struct Settle {
        reads {
            found, depth, change_before, face_east, face_west, face_south, face_north,
            sine_east, sine_west, sine_south, sine_north, neighbour_share, erodible,
        }
        updates {}
        writes { change, sediment, lost }
        constants { capacity: f32, uptake_by_speed: f32, uptake_by_capacity: f32, deposit_ratio: f32 }
    }
    fn cell() {
        let eastward = (face_west + face_east) * 0.5;
        let southward = (face_north + face_south) * 0.5;
        let speed = (eastward * eastward + southward * southward).sqrt();
        let sine = ((sine_west + sine_east) + (sine_north + sine_south)) * neighbour_share;
        let most = capacity * speed * sine * depth.max(0.0);
        let uptake = uptake_by_speed * speed + uptake_by_capacity * (most - found).max(0.0);
        let taken = ((found + uptake).min(most) - found) * erodible;
        (change, sediment, lost) = settle(found, taken, change_before, deposit_ratio);
    }
}
