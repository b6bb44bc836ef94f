//! What one cell becomes in a step of [`super`], which has the equations and their sources.

use super::banks::levelled;
use super::edges::{AXIS, DIAGONAL, Discharge, PIPE_AXIS, PIPE_DIAGONAL, larger, outflow, power};
use crate::erode::pipes::without_negligible;
use weald_engine::kernel;

/// Share of its water that a cell keeps when everything would flow out, so that rounding cannot make its depth
/// negative: some ten times the rounding error of the eight fluxes.
pub(super) const RETAINED_SHARE: f32 = 2e-6;

/// Outflow in cells³ up to which a cell gives less than it has.
const LEAST_OUTFLOW: f32 = 1e-25;

/// Water thinner than this, in cells, does not flow.
pub(super) const THINNEST: f32 = 1e-8;

/// Discharge that is as good as none where something is divided by it.
const LEAST_DISCHARGE: f32 = 1e-20;

/// Most of the drop to its receivers that a cell may lose in a step: more would turn the slope round.
pub(super) const MAX_SHARE_OF_DROP: f32 = 0.25;

/// Steepest drop that counts there: falls from a cliff do not dig deeper.
pub(super) const MAX_DROP: f32 = 2.0;

/// What falls freely over an edge from water of some depth, which then has the speed of its waves, for a conductance
/// of 1.
#[inline(always)]
fn free_fall(depth: f32, deepest: f32, flow_rate: f32) -> f32 {
    let depth = depth.min(deepest);
    depth * (flow_rate * depth).sqrt()
}

kernel! {
    /// Depth after rain, ground, water surface, and what would fall over an open edge.
    pub(crate) struct Rained {
        reads { base, change_before, depth_before, inflow }
        writes { ground, surface, rained, fallen, fall }
        constants { rain: f32, flow_rate: f32, deepest: f32 }
    }
    fn cell() {
        ground = base + change_before;
        rained = depth_before + rain * inflow;
        surface = ground + rained;
        fallen = rained - depth_before;
        fall = free_fall(rained, deepest, flow_rate);
    }
}

kernel! {
    /// The same where water evaporates too, as much as there is at most.
    pub(crate) struct Dried {
        reads { base, change_before, depth_before, inflow }
        writes { ground, surface, rained, fallen, evaporated, fall }
        constants { rain: f32, evaporation: f32, flow_rate: f32, deepest: f32 }
    }
    fn cell() {
        ground = base + change_before;
        let wet = depth_before + rain * inflow;
        rained = wet - wet.min(evaporation);
        surface = ground + rained;
        fallen = wet - depth_before;
        evaporated = rained - wet;
        fall = free_fall(rained, deepest, flow_rate);
    }
}

/// Depth of the water over an edge; `here` and `next` are surface, ground and resistance on its two sides.
#[inline(always)]
fn depth_over(here: [f32; 3], next: [f32; 3], deepest: f32) -> f32 {
    (larger(here[0], next[0]) - larger(here[1], next[1])).min(deepest)
}

/// Fluxes through two edges after a step, where they had been `old`: `(f + g dt w h ΔH) / (1 + r / h²)`. Both share a
/// division, which takes as long as ten products: `a / b` and `c / d` are `a d / (b d)` and `c b / (b d)`.
#[inline(always)]
fn accelerated(
    old: [f32; 2],
    here: [f32; 3],
    next: [[f32; 3]; 2],
    conductance: f32,
    deepest: f32,
) -> [f32; 2] {
    let [a, b] = next.map(|next| {
        let depth = depth_over(here, next, deepest);
        let square = depth.max(THINNEST) * depth.max(THINNEST);
        let flows = if depth > THINNEST { square } else { 0.0 };
        [depth, flows, square + 0.5 * (here[2] + next[2])]
    });
    let both = 1.0 / (a[2] * b[2]);
    let gained = |old: f32, depth: f32, next: [f32; 3]| old + conductance * depth * (here[0] - next[0]);
    [
        gained(old[0], a[0], next[0]) * (a[1] * b[2] * both),
        gained(old[1], b[0], next[1]) * (b[1] * a[2] * both),
    ]
}

/// The flux between two cells with data, or the free fall from one of them over an open edge; `valid` and `fall` are
/// those of the two sides.
#[inline(always)]
fn through_edge(flux: f32, valid: [f32; 2], fall: [f32; 2], face: f32) -> f32 {
    let outward = valid[0] - valid[1];
    let falling = outward * face * if outward > 0.0 { fall[0] } else { fall[1] };
    if outward == 0.0 { flux * (valid[0] * valid[1]) } else { falling }
}

kernel! {
    /// Fluxes through the eastern, southern, south-eastern and south-western edge, if every cell had water enough.
    /// Into cells without data water falls freely where edges are `open`.
    pub(crate) struct Accelerate {
        reads {
            old_east, old_south, old_diagonal, old_antidiagonal,
            surface, surface_east, surface_south, surface_south_east, surface_south_west,
            ground, ground_east, ground_south, ground_south_east, ground_south_west,
            resistance_before, resistance_before_east, resistance_before_south,
            resistance_before_south_east, resistance_before_south_west,
            fall, fall_east, fall_south, fall_south_east, fall_south_west,
            valid, valid_east, valid_south, valid_south_east, valid_south_west,
        }
        writes { wanted_east, wanted_south, wanted_diagonal, wanted_antidiagonal }
        constants { flow_rate: f32, deepest: f32, open: f32 }
    }
    fn cell() {
        let here = [surface, ground, resistance_before];
        let (axis, diagonal) = (PIPE_AXIS * flow_rate, PIPE_DIAGONAL * flow_rate);
        let east = [surface_east, ground_east, resistance_before_east];
        let south = [surface_south, ground_south, resistance_before_south];
        let south_east = [surface_south_east, ground_south_east, resistance_before_south_east];
        let south_west = [surface_south_west, ground_south_west, resistance_before_south_west];
        let [flux, flux_south] = accelerated([old_east, old_south], here, [east, south], axis, deepest);
        wanted_east = through_edge(flux, [valid, valid_east], [fall, fall_east], PIPE_AXIS * open);
        wanted_south = through_edge(flux_south, [valid, valid_south], [fall, fall_south], PIPE_AXIS * open);
        let old = [old_diagonal, old_antidiagonal];
        let [flux, flux_south_west] = accelerated(old, here, [south_east, south_west], diagonal, deepest);
        let (valid_next, fall_next) = (valid_south_east, fall_south_east);
        wanted_diagonal = through_edge(flux, [valid, valid_next], [fall, fall_next], PIPE_DIAGONAL * open);
        let (valid_next, fall_next) = (valid_south_west, fall_south_west);
        wanted_antidiagonal = through_edge(flux_south_west, [valid, valid_next], [fall, fall_next], PIPE_DIAGONAL * open);
    }
}

kernel! {
    /// What share of its outflow a cell can give, and how much sediment a unit of its outflow carries.
    pub(crate) struct Shares {
        reads {
            rained, sediment_before, wanted_east, wanted_east_west, wanted_south, wanted_south_north,
            wanted_diagonal, wanted_diagonal_north_west, wanted_antidiagonal, wanted_antidiagonal_north_east,
        }
        writes { share, concentration }
        constants { thin: f32 }
    }
    fn cell() {
        let out = outflow(
            [wanted_east, wanted_east_west, wanted_south, wanted_south_north],
            [
                wanted_diagonal, wanted_diagonal_north_west, wanted_antidiagonal,
                wanted_antidiagonal_north_east,
            ],
        );
        let available = rained * (1.0 - RETAINED_SHARE);
        let (out, mixed) = (out.max(LEAST_OUTFLOW), rained + thin);
        let both = 1.0 / (out * mixed);
        share = if out > available { available * (mixed * both) } else { 1.0 };
        concentration = sediment_before * (out * both);
    }
}

kernel! {
    /// Scales the flux through each edge to what its giving cell can give.
    pub(crate) struct Through {
        reads {
            wanted_east, wanted_south, wanted_diagonal, wanted_antidiagonal,
            share, share_east, share_south, share_south_east, share_south_west,
        }
        writes { flux_east, flux_south, flux_diagonal, flux_antidiagonal }
    }
    fn cell() {
        flux_east = wanted_east * if wanted_east > 0.0 { share } else { share_east };
        flux_south = wanted_south * if wanted_south > 0.0 { share } else { share_south };
        flux_diagonal = wanted_diagonal * if wanted_diagonal > 0.0 { share } else { share_south_east };
        flux_antidiagonal =
            wanted_antidiagonal * if wanted_antidiagonal > 0.0 { share } else { share_south_west };
    }
}

/// Sediment through an edge, with the concentration of the cell that the flux comes from.
#[inline(always)]
fn carried_by(flux: f32, behind: f32, ahead: f32) -> f32 {
    flux * if flux >= 0.0 { behind } else { ahead }
}

kernel! {
    /// Depth and sediment after the fluxes, and what left over an open edge.
    pub(crate) struct Flow {
        reads {
            rained, sediment_before, valid, flux_east, flux_east_west, flux_south, flux_south_north,
            flux_diagonal, flux_diagonal_north_west, flux_antidiagonal, flux_antidiagonal_north_east,
            concentration, concentration_east, concentration_west, concentration_south, concentration_north,
            concentration_south_east, concentration_north_west, concentration_south_west,
            concentration_north_east,
        }
        writes { water, carried, water_out, sediment_out }
    }
    fn cell() {
        let gained = ((flux_east_west - flux_east) + (flux_south_north - flux_south))
            + ((flux_diagonal_north_west - flux_diagonal)
                + (flux_antidiagonal_north_east - flux_antidiagonal));
        let flowed = without_negligible(rained + gained);
        let to_east = carried_by(flux_east, concentration, concentration_east);
        let from_west = carried_by(flux_east_west, concentration_west, concentration);
        let to_south = carried_by(flux_south, concentration, concentration_south);
        let from_north = carried_by(flux_south_north, concentration_north, concentration);
        let to_south_east = carried_by(flux_diagonal, concentration, concentration_south_east);
        let from_north_west = carried_by(flux_diagonal_north_west, concentration_north_west, concentration);
        let to_south_west = carried_by(flux_antidiagonal, concentration, concentration_south_west);
        let from_north_east =
            carried_by(flux_antidiagonal_north_east, concentration_north_east, concentration);
        let brought = ((from_west - to_east) + (from_north - to_south))
            + ((from_north_west - to_south_east) + (from_north_east - to_south_west));
        let found = without_negligible(sediment_before + brought);
        water = flowed * valid;
        carried = found * valid;
        water_out = flowed * (1.0 - valid);
        sediment_out = found * (1.0 - valid);
    }
}

kernel! {
    /// What the power of the flow would take up, and how much the bed will hold it back in the next step: friction a
    /// unit of depth². On slopes steeper than its friction water would run faster than its waves and break up in
    /// surges; the beds of steep streams form steps until it does not (Grant 1997, doi 10.1029/96WR03134).
    /// `softness` is what the ground's erodibility is to `erodibility`. The resistance is the mean of that of the step before
    /// and of what the new discharge finds. On steep ground friction ends a flow within a part of a step, so that with the
    /// latter alone too much and too little would flow by turns; with the mean discharge goes to the root that balances
    /// friction as by Heron's rule.
    pub(crate) struct Uptake {
        reads {
            softness, resistance_before, rained, flux_east, flux_east_west, flux_south, flux_south_north,
            flux_diagonal, flux_diagonal_north_west, flux_antidiagonal, flux_antidiagonal_north_east,
            surface, surface_east, surface_west, surface_south, surface_north,
            surface_south_east, surface_north_west, surface_south_west, surface_north_east,
        }
        writes { entrained, resistance, across }
        constants {
            friction: f32, gathering: f32, channel_width: f32, lateral_wear: f32, erodibility: f32, threshold: f32,
            deepest: f32, thin: f32,
        }
    }
    fn cell() {
        let axes = [flux_east, flux_east_west, flux_south, flux_south_north];
        let diagonals = [
            flux_diagonal, flux_diagonal_north_west, flux_antidiagonal, flux_antidiagonal_north_east,
        ];
        let power = power(
            (axes, diagonals),
            surface,
            [surface_east, surface_west, surface_south, surface_north],
            [surface_south_east, surface_north_west, surface_south_west, surface_north_east],
        );
        let discharge = Discharge::of(axes, diagonals);
        let [occupied, reciprocal] = discharge.occupied(gathering, channel_width);
        // Three quotients by one division: each number times the reciprocal of the product of all is the reciprocal of
        // the others' product.
        let (size, depth) = (larger(discharge.size, LEAST_DISCHARGE), larger(rained, deepest));
        let water = size * depth;
        let all = 1.0 / (discharge.gathered * water);
        // Share of the power that reaches the bed. Water deeper than `deepest` is driven through pipes of that depth by
        // a steeper surface than it needs: slope goes with the third power of depth.
        let shallow = deepest * (discharge.gathered * size * all);
        let by_width = power * (shallow * shallow * shallow) * reciprocal;
        let wanted = (erodibility * softness * (by_width - threshold)).max(0.0);
        let drop = power * (discharge.gathered * depth * all);
        let drop = if discharge.size > 0.0 { drop.min(MAX_DROP) } else { 0.0 };
        entrained = wanted.min(MAX_SHARE_OF_DROP * drop);
        across = levelled(discharge.size, lateral_wear * entrained, rained + thin, channel_width);
        // Friction times discharge; power is slope times discharge.
        let found = larger(friction * discharge.size, power) * (water * all) * occupied;
        resistance = 0.5 * (resistance_before + found);
    }
}

kernel! {
    /// What the water takes from or gives to the ground. Ground and water change by the same rounded amount, so that
    /// nothing is lost; where it would be more than there is, nothing settles.
    pub(crate) struct Wear {
        reads {
            base, change_before, carried, water, entrained, erodible,
            valid_south_east, valid_north_west, valid_south_west, valid_north_east,
        }
        writes { settled, sediment, ground, movable }
        constants { settling: f32, thin: f32, open: f32 }
    }
    fn cell() {
        let diagonals = (valid_south_east * valid_north_west) * (valid_south_west * valid_north_east);
        // Cells at an open edge hold the base level, at its corners too.
        movable = erodible * (1.0 - open * (1.0 - diagonals));
        let left = (carried + entrained) * ((water + thin) / ((water + thin) + settling));
        let changed = change_before - (left - carried) * movable;
        let taken = change_before - changed;
        let there = carried + taken >= 0.0;
        settled = if there { changed } else { change_before };
        sediment = if there { carried + taken } else { carried };
        ground = base + settled;
    }
}

kernel! {
    /// Share of each step of the ground that creeps, and slides where the slope exceeds the talus. `repose` is what
    /// the talus of the ground is to `talus`, `loose` the share of it that is loose: bare rock does not creep.
    pub(crate) struct Unrest {
        reads {
            ground, ground_east, ground_west, ground_south, ground_north,
            ground_south_east, ground_north_west, ground_south_west, ground_north_east,
            valid_east, valid_west, valid_south, valid_north,
            valid_south_east, valid_north_west, valid_south_west, valid_north_east, repose, loose,
        }
        writes { unrest }
        constants { talus: f32, slide: f32, creep: f32 }
    }
    fn cell() {
        let square = |next: f32, valid: f32| (next - ground) * (next - ground) * valid;
        let axes = (square(ground_east, valid_east) + square(ground_west, valid_west))
            + (square(ground_south, valid_south) + square(ground_north, valid_north));
        let diagonals = (square(ground_south_east, valid_south_east)
            + square(ground_north_west, valid_north_west))
            + (square(ground_south_west, valid_south_west) + square(ground_north_east, valid_north_east));
        let slope = (0.5 * (AXIS * axes + DIAGONAL * diagonals)).sqrt();
        let rests = talus * repose;
        unrest = creep * loose + if slope > rests { slide * (slope - rests) / slope } else { 0.0 };
    }
}

kernel! {
    /// Ground after creep and slides: along each edge by the mean unrest of its two cells.
    pub(crate) struct Slid {
        reads {
            washed, valid, ground, ground_east, ground_west, ground_south, ground_north,
            ground_south_east, ground_north_west, ground_south_west, ground_north_east,
            unrest, unrest_east, unrest_west, unrest_south, unrest_north,
            unrest_south_east, unrest_north_west, unrest_south_west, unrest_north_east,
            valid_east, valid_west, valid_south, valid_north,
            valid_south_east, valid_north_west, valid_south_west, valid_north_east,
        }
        writes { change }
    }
    fn cell() {
        let from = |next: f32, its: f32, there: f32| (0.5 * (unrest + its) * there) * (next - ground);
        let axes = (from(ground_east, unrest_east, valid_east) + from(ground_west, unrest_west, valid_west))
            + (from(ground_south, unrest_south, valid_south) + from(ground_north, unrest_north, valid_north));
        let diagonals = (from(ground_south_east, unrest_south_east, valid_south_east)
            + from(ground_north_west, unrest_north_west, valid_north_west))
            + (from(ground_south_west, unrest_south_west, valid_south_west)
                + from(ground_north_east, unrest_north_east, valid_north_east));
        change = washed + (AXIS * axes + DIAGONAL * diagonals) * valid;
    }
}
