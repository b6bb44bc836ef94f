//! Virtual pipes with one signed flux an edge: water accelerates down the surface, and no cell gives more
//! than it has.
//!
//! With surface `H = b + d` and `k = dt² g A / L`, each edge gains `k (H(i) - H(i+1))` unless the giving cell
//! is dry (Han 2015, eq. 1–6, doi 10.7583/JKGS.2015.15.6.171). The source lets depths go negative; with the
//! limiter every flux is multiplied by the share `min(1, d / outflow)` of its giving cell and the scaled flux
//! is kept as state, which makes the scheme conserve water without debts.

use weald_engine::kernel;

/// Share of its water that a cell keeps when everything would flow out, so that rounding cannot make its
/// depth negative: some ten times the rounding error of the four fluxes.
pub(super) const RETAINED_SHARE: f32 = 1e-6;

/// Depths and loads smaller than this, in cells, are nothing: numbers without full precision (denormals) would
/// make depths negative by rounding and slow the arithmetic a hundredfold.
const NEGLIGIBLE: f32 = 1e-20;

/// The amount, or nothing where it is less than counts.
#[inline(always)]
pub(super) fn without_negligible(amount: f32) -> f32 {
    if amount.abs() < NEGLIGIBLE { 0.0 } else { amount }
}

kernel! {
    /// Ground and water surface of a row.
    pub(crate) struct Surface {
        reads { base, change, depth }
        updates {}
        writes { ground, surface }
        constants {}
    }
    fn cell() {
        ground = base + change;
        surface = ground + depth;
    }
}

/// Signed flux through an edge (eq. 4–6); `here` and `next` are surface and depth on its two sides.
#[inline(always)]
fn edge_flux(old: f32, here: [f32; 2], next: [f32; 2], link: f32, flow_rate: f32) -> f32 {
    let drop = here[0] - next[0];
    let donor = if drop > 0.0 { here[1] } else { next[1] };
    let gained = old + if donor > 0.0 { flow_rate * drop } else { 0.0 };
    let donor = if gained > 0.0 { here[1] } else { next[1] };
    if donor > 0.0 { gained * link } else { 0.0 }
}

/// Sine of the slope along an edge with this rise.
#[inline(always)]
pub(super) fn sine(rise: f32, link: f32) -> f32 {
    rise.abs() * link / (1.0 + rise * rise).sqrt()
}

kernel! {
    /// Flux to the eastern and southern neighbours, and the sines of the slopes along these edges. Links are
    /// 1 where both cells hold data, else 0.
    pub(crate) struct Flux {
        reads {
            old_east, old_south, surface, surface_east, surface_south, depth, depth_east, depth_south,
            ground, ground_east, ground_south, link_east, link_south,
        }
        updates {}
        writes { east, south, sine_east, sine_south }
        constants { flow_rate: f32 }
    }
    fn cell() {
        let here = [surface, depth];
        east = edge_flux(old_east, here, [surface_east, depth_east], link_east, flow_rate);
        south = edge_flux(old_south, here, [surface_south, depth_south], link_south, flow_rate);
        sine_east = sine(ground_east - ground, link_east);
        sine_south = sine(ground_south - ground, link_south);
    }
}

kernel! {
    /// Flux from a cell with data into one without: a free fall, driven by how high the water stands over
    /// the ground of the start, which stays the base level of the land behind the edge. `land` is 1 for data,
    /// else 0; other edges keep what [`Flux`] gave them.
    pub(crate) struct Overfall {
        reads { old, depth, depth_next, change, change_next, valid, land_next }
        updates { flux }
        writes {}
        constants { flow_rate: f32 }
    }
    fn cell() {
        let outward = valid - land_next;
        let head = (depth + change) * valid - (depth_next + change_next) * land_next;
        let gained = old + flow_rate * head;
        flux = if outward * gained > 0.0 { gained } else if outward == 0.0 { flux } else { 0.0 };
    }
}

kernel! {
    /// What share of its outflow a cell can give, and how much sediment a unit of its outflow carries.
    pub(crate) struct Limit {
        reads { depth, sediment, east, west, south, north }
        updates {}
        writes { share, concentration }
        constants { epsilon: f32 }
    }
    fn cell() {
        let outflow = (east.max(0.0) + (-west).max(0.0)) + (south.max(0.0) + (-north).max(0.0));
        let available = depth * (1.0 - RETAINED_SHARE);
        share = if outflow > available { available / outflow } else { 1.0 };
        concentration = sediment / (depth + epsilon);
    }
}

kernel! {
    /// The same for the scheme as printed: depths may go negative, and the concentration is capped so that a
    /// cell never gives more sediment than it has (eq. 7 as printed diverges).
    pub(crate) struct Unlimited {
        reads { depth, sediment, east, west, south, north }
        updates {}
        writes { share, concentration }
        constants { epsilon: f32 }
    }
    fn cell() {
        let outflow = (east.max(0.0) + (-west).max(0.0)) + (south.max(0.0) + (-north).max(0.0));
        share = 1.0;
        concentration = sediment / (depth.max(0.0) + epsilon).max(outflow);
    }
}

kernel! {
    /// Scales the flux through each edge to what its giving cell can give.
    pub(crate) struct Scale {
        reads { wanted_east, wanted_south, share, share_east, share_south }
        updates {}
        writes { east, south }
        constants {}
    }
    fn cell() {
        east = wanted_east * if wanted_east > 0.0 { share } else { share_east };
        south = wanted_south * if wanted_south > 0.0 { share } else { share_south };
    }
}

kernel! {
    /// Empties the cells without data: what flowed into them has left over the edge.
    pub(crate) struct Drain {
        reads { valid }
        updates { depth, sediment }
        writes { water_out, sediment_out }
        constants {}
    }
    fn cell() {
        water_out = depth * (1.0 - valid);
        sediment_out = sediment * (1.0 - valid);
        depth *= valid;
        sediment *= valid;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_engine::program::twin::number;

    #[test]
    fn the_shader_has_the_same_constants() {
        let shader = include_str!("pipes.wgsl");
        assert_eq!(number(shader, "RETAINED_SHARE") as f32, RETAINED_SHARE);
        assert_eq!(number(shader, "NEGLIGIBLE") as f32, NEGLIGIBLE);
    }
}
