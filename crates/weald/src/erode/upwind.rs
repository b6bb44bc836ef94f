//! Upwind transport of sediment in flux form: what leaves one cell enters its neighbour, so that none is
//! lost (Han 2015, eq. 7–8; the cap that keeps it stable is in [`super::pipes`]).

use super::pipes::worth_counting;
use crate::stencil::kernel::kernel;

kernel! {
    /// Sediment after the fluxes of a step: each flux carries the concentration of the cell it comes from.
    pub(crate) struct Upwind {
        reads {
            old, east, west, south, north,
            concentration, concentration_east, concentration_west, concentration_south, concentration_north,
        }
        updates {}
        writes { sediment }
        constants {}
    }
    fn cell() {
        let to_east = east * if east >= 0.0 { concentration } else { concentration_east };
        let from_west = west * if west >= 0.0 { concentration_west } else { concentration };
        let to_south = south * if south >= 0.0 { concentration } else { concentration_south };
        let from_north = north * if north >= 0.0 { concentration_north } else { concentration };
        sediment = worth_counting(old + ((from_west - to_east) + (from_north - to_south)));
    }
}
