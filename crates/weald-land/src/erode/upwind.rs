//! Water and sediment carried by the fluxes of a step.
//!
//! Depth follows from the fluxes, rain and evaporation (Han 2015, eq. 9); sediment goes upwind in flux form,
//! so that what leaves one cell enters its neighbour and none is lost (eq. 7–8; the cap that keeps it stable
//! is in [`super::pipes`]).

use super::pipes::without_negligible;
use weald_engine::kernel;

kernel! {
    /// Depth and sediment after the fluxes of a step, and what the sky gave or took. Each flux carries the
    /// concentration of the cell it comes from; evaporation stops at dry ground.
    pub(crate) struct Upwind {
        reads {
            depth_before, sediment_before, east, west, south, north, valid,
            concentration, concentration_east, concentration_west, concentration_south, concentration_north,
        }
        updates {}
        writes { depth, sky, sediment }
        constants { rain: f32, evaporation: f32 }
    }
    fn cell() {
        let flowed = depth_before + ((west - east) + (north - south));
        depth = without_negligible(flowed + rain * valid - flowed.max(0.0).min(evaporation));
        sky = depth - flowed;
        let to_east = east * if east >= 0.0 { concentration } else { concentration_east };
        let from_west = west * if west >= 0.0 { concentration_west } else { concentration };
        let to_south = south * if south >= 0.0 { concentration } else { concentration_south };
        let from_north = north * if north >= 0.0 { concentration_north } else { concentration };
        sediment = without_negligible(sediment_before + ((from_west - to_east) + (from_north - to_south)));
    }
}
