//! What one cell of one material becomes when it slides; [`super`] has the source and the order.

use crate::erode::pipes::{RETAINED_SHARE, without_negligible};
use weald_engine::kernel;

kernel! {
    /// The talus of a material where it lies rough.
    pub(crate) struct Softened {
        reads {
            ground, ground_east, ground_west, ground_south, ground_north,
            link_east, link_west, link_south, link_north, neighbour_share,
        }
        writes { softened }
        constants { talus: f32 }
    }
    fn cell() {
        let across = link_west * (ground_west - ground) + link_east * (ground_east - ground);
        let along = link_north * (ground_north - ground) + link_south * (ground_south - ground);
        let rough = ((across + along) * neighbour_share).abs();
        // The authors' numbers: a hundredth of the talus is smooth, and each roughness beyond it takes ten
        // times as much from the talus, so that nothing rests on ground as rough as a ninth of it.
        softened = (talus - 10.0 * (rough - 0.01 * talus).max(0.0)).max(0.0);
    }
}

kernel! {
    /// What wants to slide east and south between cells of their own talus.
    pub(crate) struct SoftAxis {
        reads {
            ground, ground_east, ground_south, talus, talus_east, talus_south, link_east, link_south,
        }
        writes { to_east, to_south }
        constants { strength: f32 }
    }
    fn cell() {
        let along = |step: f32, talus: f32| strength * (step - step.clamp(-talus, talus));
        // An edge has one talus, whichever of its cells is higher.
        to_east = link_east * along(ground - ground_east, (talus + talus_east) * 0.5);
        to_south = link_south * along(ground - ground_south, (talus + talus_south) * 0.5);
    }
}

kernel! {
    /// What share of what wants to slide off a cell there is.
    pub(crate) struct AvailableShare {
        reads { thickness, to_east, to_east_west, to_south, to_south_north }
        writes { share }
    }
    fn cell() {
        let along = to_east.max(0.0) + (-to_east_west).max(0.0);
        let outflow = along + (to_south.max(0.0) + (-to_south_north).max(0.0));
        let available = thickness * (1.0 - RETAINED_SHARE);
        share = if outflow > available { available / outflow } else { 1.0 };
    }
}

kernel! {
    /// Thickness after what came and went, each by the share of the cell that gives it.
    pub(crate) struct Slid {
        reads {
            before, to_east, to_east_west, to_south, to_south_north,
            share, share_east, share_west, share_south, share_north,
        }
        writes { thickness }
    }
    fn cell() {
        let east = to_east * if to_east > 0.0 { share } else { share_east };
        let west = to_east_west * if to_east_west > 0.0 { share_west } else { share };
        let south = to_south * if to_south > 0.0 { share } else { share_south };
        let north = to_south_north * if to_south_north > 0.0 { share_north } else { share };
        thickness = without_negligible(before + ((west - east) + (north - south)));
    }
}
