//! Rivers that carve ground over years: shallow water in eight pipes with friction, what its power takes up and what
//! settles, creep and slides. All of it in metres and time, and none of it knows the directions of the grid.
//!
//! *Water.* Bates, Horritt, Fewtrell 2010, "A simple inertial formulation of the shallow water equations", doi
//! 10.1016/j.jhydrol.2010.03.027, on virtual pipes (O'Brien and Hodgins 1995, doi 10.1109/CA.1995.393532) to all
//! eight neighbours. The flux `f` through an edge with the vector `e` gains `g dt w h ΔH` and loses by friction:
//!
//! ```text
//! f' = (f + g dt w h (H_i - H_j) / l) / (1 + dt c_f r / h²),   h = min(max H - max z, deepest)
//! ```
//!
//! with `w` = 2/3 along the axes and 1/6 along the diagonals, so that `Σ w e eᵀ = 2 I`: what is driven by a slope
//! flows down it in every direction alike. The friction is Darcy's and Weisbach's (`c_f` = their factor over 8), which
//! grows with the square of the discharge `q = ½ Σ f e`; the source has Manning's, of which the power 7/3 is not the
//! same to the last bit on every machine. `r = |q|³ / (½ Σ f²/w)` is `|q|` for a sheet, and takes back in a channel
//! of one cell what the missing pipes at its sides would have carried, so that a channel runs along a diagonal as it
//! does along an axis. `deepest` bounds the speed of waves, and with it the step `dt = C l / √(g deepest)`; deeper
//! water flows as if it were that deep.
//!
//! *Channels* are `k √Q` wide (Leopold and Maddock 1953). Where that is less than their cell, water is that much
//! deeper than on the mean of the cell, and its power acts on that much less ground. A sheet gathers in channels some
//! metres apart, whatever the cell.
//!
//! *Ground.* Unit stream power `ω = Σ f ΔH / width` (of the outflows, with the surface of the water: still water takes
//! nothing up, and no pit digs itself) takes up `K (ω - ω_c)`; sediment settles with `v_s C` (Davy and Lague 2009, doi
//! 10.1029/2008JF001146) and travels upwind with the water. Ground creeps by `D ∇²z`, and where the slope
//! `S = (½ Σ w Δz²)^½` exceeds the talus, by `D_s (S - talus) / S` more.
//!
//! *Time.* Rivers do most of their work in floods. A flood of some hours stands for years: what happens to the ground
//! in a second of flow is multiplied by the years over the hours (the morphological factor of Roelvink 2006, doi
//! 10.1016/j.coastaleng.2005.11.002).

pub(crate) mod edges;
pub(crate) mod kernels;
mod program;

pub(crate) use program::program;

use std::sync::Arc;

use super::forcing::Forcing;
use super::pipeline::{Equations, Pipeline};
use super::sums;
use edges::{AXIS, DIAGONAL};
use kernels::{Accelerate, Flow, FreeFall, Rained, Resistance, Shares, Slid, Through, Unrest, Uptake, Wear};
use weald_engine::kernel;
use weald_engine::machine::{Means, Part};
use weald_engine::uniform;

/// Planes that change, before and after a step; the first three are those of all models of water.
const STATE: [(&str, &str); 7] = [
    ("change_before", "change"),
    ("depth_before", "water"),
    ("sediment_before", "sediment"),
    ("old_east", "flux_east"),
    ("old_south", "flux_south"),
    ("old_diagonal", "flux_diagonal"),
    ("old_antidiagonal", "flux_antidiagonal"),
];

/// Number of planes that change.
pub(crate) const PLANES: usize = STATE.len();

/// Mean fluxes through the eastern, southern, south-eastern and south-western edge.
pub(crate) const MEAN_FLUXES: Means<'static> = &[
    &[Part { plane: 3, factor: 1.0, from: [0, 0] }],
    &[Part { plane: 4, factor: 1.0, from: [0, 0] }],
    &[Part { plane: 5, factor: 1.0, from: [0, 0] }],
    &[Part { plane: 6, factor: 1.0, from: [0, 0] }],
];

uniform! {
    /// Constants of the method, in cells and steps.
    pub(crate) struct FluvialConstants {
        /// `g dt² / l`.
        pub(crate) flow_rate: f32,
        /// Depth from which on water flows as if it were that deep.
        pub(crate) deepest: f32,
        /// `c_f`.
        pub(crate) friction: f32,
        /// Distance of the channels in which a sheet gathers.
        pub(crate) gathering: f32,
        /// Width of a channel over the root of its discharge.
        pub(crate) channel_width: f32,
        /// Ground that a unit of power takes up.
        pub(crate) erodibility: f32,
        /// Power below which nothing is taken up.
        pub(crate) threshold: f32,
        /// Fall of the sediment.
        pub(crate) settling: f32,
        /// Depth added where something is divided by depth.
        pub(crate) thin: f32,
        /// Steepest slope that rests.
        pub(crate) talus: f32,
        pub(crate) slide: f32,
        pub(crate) creep: f32,
        /// 1 where water leaves over the edges, else 0.
        pub(crate) open: f32,
    }
}

kernel! {
    /// Ground of a row.
    pub(crate) struct Ground {
        reads { base, settled }
        writes { ground }
    }
    fn cell() {
        ground = base + settled;
    }
}

/// The equations in their order.
pub(crate) fn pipeline(constants: &FluvialConstants) -> Arc<Pipeline> {
    let mut equations = Equations::new(&["base"], &STATE, constants);
    equations.weather(&Forcing { rain: 0.0, evaporation: 0.0 });
    equations.kernel::<Rained>().tally("fallen", sums::RAINED);
    equations.kernel::<Resistance>().kernel::<Accelerate>();
    if constants.open > 0.0 {
        add_falls(&mut equations);
    }
    equations.kernel::<Shares>().kernel::<Through>().kernel::<Flow>();
    equations.tally("water_out", sums::WATER_OUT).tally("sediment_out", sums::SEDIMENT_OUT);
    equations.kernel::<Uptake>().kernel::<Wear>().kernel::<Ground>().kernel::<Unrest>().kernel::<Slid>();
    equations.finish()
}

/// Free falls over the four edges that a cell keeps.
fn add_falls(equations: &mut Equations) {
    let edges = [
        ("wanted_east", "rained_east", "valid_east", AXIS),
        ("wanted_south", "rained_south", "valid_south", AXIS),
        ("wanted_diagonal", "rained_south_east", "valid_south_east", DIAGONAL),
        ("wanted_antidiagonal", "rained_south_west", "valid_south_west", DIAGONAL),
    ];
    for (wanted, rained_next, valid_next, face) in edges {
        let rows = [("wanted", wanted), ("rained_next", rained_next), ("valid_next", valid_next)];
        equations.number("face", face).kernel_on::<FreeFall>(&rows);
    }
}

/// The fluxes through the eastern and southern side of each cell of a grid with that many columns, from those of the
/// edges: what crosses a corner counts half for the cells on both sides of it.
pub(crate) fn through_sides(means: &[Vec<f32>], columns: usize) -> [Vec<f32>; 2] {
    let [east, south, diagonal, antidiagonal] = means else { unreachable!("four edges a cell") };
    let rows = east.len() / columns;
    let at = |plane: &[f32], x: Option<usize>, y: Option<usize>| match (x, y) {
        (Some(x), Some(y)) if x < columns && y < rows => plane[y * columns + x],
        _ => 0.0,
    };
    let side = |value: &dyn Fn(usize, usize) -> f32| -> Vec<f32> {
        (0..rows * columns).map(|cell| value(cell % columns, cell / columns)).collect()
    };
    [
        side(&|x, y| {
            let (next, above) = (Some(x + 1), y.checked_sub(1));
            let main = at(diagonal, Some(x), Some(y)) + at(diagonal, Some(x), above);
            let other = at(antidiagonal, next, Some(y)) + at(antidiagonal, next, above);
            east[y * columns + x] + 0.5 * (main - other)
        }),
        side(&|x, y| {
            let before = x.checked_sub(1);
            let main = at(diagonal, Some(x), Some(y)) + at(diagonal, before, Some(y));
            let other = at(antidiagonal, Some(x), Some(y)) + at(antidiagonal, Some(x + 1), Some(y));
            south[y * columns + x] + 0.5 * (main + other)
        }),
    ]
}
