//! What one cell becomes in a step of Mei et al. 2007; [`super`] has the source and the order.

use crate::erode::pipes::without_negligible;
use weald_engine::kernel;

/// Least sine that counts as a slope, so that water on flat ground still carries something (Mei 2007,
/// section 3.3).
const MIN_SINE: f32 = 0.05;

kernel! {
    /// Depth after rain, ground, water surface.
    pub(crate) struct Rained {
        reads { base, change, before, valid }
        updates {}
        writes { ground, surface, depth, fallen }
        constants { rain: f32 }
    }
    fn cell() {
        ground = base + change;
        depth = before + rain * valid;
        surface = ground + depth;
        fallen = depth - before;
    }
}

kernel! {
    /// Mean sine of the slopes around a cell.
    pub(crate) struct MeanSine {
        reads { sine_east, sine_west, sine_south, sine_north, neighbour_share }
        updates {}
        writes { tilt }
        constants {}
    }
    fn cell() {
        tilt = ((sine_west + sine_east) + (sine_north + sine_south)) * neighbour_share;
    }
}

kernel! {
    /// Sine of the tilt by central differences, one-sided where a neighbour is missing.
    pub(crate) struct CentralTilt {
        reads {
            ground, ground_east, ground_west, ground_south, ground_north, link_east, link_west, link_south,
            link_north,
        }
        updates {}
        writes { tilt }
        constants {}
    }
    fn cell() {
        let eastward = link_east * (ground_east - ground) + link_west * (ground - ground_west);
        let southward = link_south * (ground_south - ground) + link_north * (ground - ground_north);
        // The mean of two rises, or the one that there is.
        let across = eastward * if link_east + link_west > 1.0 { 0.5 } else { 1.0 };
        let along = southward * if link_south + link_north > 1.0 { 0.5 } else { 1.0 };
        let squared = across * across + along * along;
        tilt = (squared / (1.0 + squared)).sqrt();
    }
}

kernel! {
    /// Depth after the fluxes and evaporation, the velocity of the water that flowed, and what it takes from
    /// or gives to the ground: towards the capacity `C = K_c |v| sin a` by the share `K_s`, from a surplus
    /// by the share `K_d`.
    pub(crate) struct Exchange {
        reads {
            rained, east, west, south, north, from_west, from_east, from_north, from_south,
            found, change_before, tilt, erodible, valid,
        }
        updates {}
        writes { depth, evaporated, eastward, southward, change, sediment, lost }
        constants {
            evaporation: f32, velocity_epsilon: f32, capacity: f32, erosion: f32, deposition: f32,
            deposit_ratio: f32,
        }
    }
    fn cell() {
        let inflow = (from_west + from_east) + (from_north + from_south);
        let flowed = rained + (inflow - ((east + west) + (south + north)));
        let mean_depth = (rained + flowed) * 0.5;
        let per_depth = if mean_depth > velocity_epsilon { 0.5 / mean_depth } else { 0.0 };
        eastward = ((from_west - west) + (east - from_east)) * per_depth;
        southward = ((from_north - north) + (south - from_south)) * per_depth;
        depth = without_negligible(flowed * (1.0 - evaporation * valid));
        evaporated = depth - flowed;
        let speed = (eastward * eastward + southward * southward).sqrt();
        let room = (capacity * tilt.max(MIN_SINE) * speed - found) * erodible;
        let eroded = change_before - erosion * room.max(0.0);
        let deposit = deposition * (-room).max(0.0);
        change = if room > 0.0 { eroded } else { change_before + deposit_ratio * deposit };
        sediment = if room > 0.0 { found + (change_before - eroded) } else { found - deposit };
        lost = (1.0 - deposit_ratio) * deposit;
    }
}

kernel! {
    /// The same where outflows are not limited: capped so that a cell never gives more than it has.
    pub(crate) struct LoadUnlimited {
        reads { sediment, depth, east, west, south, north }
        updates {}
        writes { concentration }
        constants { epsilon: f32 }
    }
    fn cell() {
        let outflow = (east + west) + (south + north);
        concentration = sediment / (depth.max(0.0) + epsilon).max(outflow);
    }
}

#[cfg(test)]
mod tests {
    use super::{CentralTilt, MIN_SINE, MeanSine};
    use crate::erode::outflow_kernels::Sines;
    use pulp::Arch;
    use weald_engine::program::twin::number;

    /// Both slopes of an inner cell of a plane that rises by `rise` a cell in a direction, in degrees from the east.
    fn slopes_of_plane(rise: f32, direction_deg: f32) -> [f32; 2] {
        let (southward, eastward) = direction_deg.to_radians().sin_cos();
        let at = |x: f32, y: f32| [100.0 + rise * (eastward * x + southward * y)];
        let (one, quarter) = ([1.0], [0.25]);
        let (mut sine_east, mut sine_south, mut mean, mut central) = ([0.0], [0.0], [0.0], [0.0]);
        Sines {
            ground: &at(0.0, 0.0),
            ground_east: &at(1.0, 0.0),
            ground_south: &at(0.0, 1.0),
            link_east: &one,
            link_south: &one,
            sine_east: &mut sine_east,
            sine_south: &mut sine_south,
        }
        .run(Arch::new());
        MeanSine {
            sine_east: &sine_east,
            sine_west: &sine_east,
            sine_south: &sine_south,
            sine_north: &sine_south,
            neighbour_share: &quarter,
            tilt: &mut mean,
        }
        .run(Arch::new());
        CentralTilt {
            ground: &at(0.0, 0.0),
            ground_east: &at(1.0, 0.0),
            ground_west: &at(-1.0, 0.0),
            ground_south: &at(0.0, 1.0),
            ground_north: &at(0.0, -1.0),
            link_east: &one,
            link_west: &one,
            link_south: &one,
            link_north: &one,
            tilt: &mut central,
        }
        .run(Arch::new());
        [mean[0], central[0]]
    }

    #[test]
    fn central_differences_find_the_sine_of_a_plane_in_every_direction_and_the_mean_of_sines_does_not() {
        for tilt_deg in [0.5_f32, 5.0, 30.0, 60.0, 80.0] {
            let sine = tilt_deg.to_radians().sin();
            for direction_deg in [0.0, 10.0, 22.5, 45.0, 67.5, 90.0, 135.0, 180.0, 260.0_f32] {
                let [mean, central] = slopes_of_plane(tilt_deg.to_radians().tan(), direction_deg);
                assert!(
                    (central / sine - 1.0).abs() < 1e-3,
                    "{tilt_deg}°, {direction_deg}°: {central}, {sine}"
                );
                assert!(
                    mean < 0.96 * sine || tilt_deg > 45.0,
                    "{tilt_deg}°, {direction_deg}°: {mean}, {sine}"
                );
            }
        }
    }

    #[test]
    fn a_missing_neighbour_leaves_the_rise_to_the_other() {
        let (here, there) = ([10.0], [11.0]);
        let (one, none) = ([1.0], [0.0]);
        let mut tilt = [0.0];
        CentralTilt {
            ground: &here,
            ground_east: &there,
            ground_west: &[0.0],
            ground_south: &[0.0],
            ground_north: &[0.0],
            link_east: &one,
            link_west: &none,
            link_south: &none,
            link_north: &none,
            tilt: &mut tilt,
        }
        .run(Arch::new());
        assert!((tilt[0] - 45.0_f32.to_radians().sin()).abs() < 1e-6, "{}", tilt[0]);
    }

    #[test]
    fn the_shader_has_the_same_constants() {
        assert_eq!(number(include_str!("kernels.wgsl"), "MIN_SINE") as f32, MIN_SINE);
    }
}
