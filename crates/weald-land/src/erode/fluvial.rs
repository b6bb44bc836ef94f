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
//! with weights such that `Σ w e eᵀ = 2 I`: what is driven by a slope flows down it in every direction alike, and
//! spreads to the sides alike (see [`edges`]). The friction is Darcy's and Weisbach's (`c_f` = their factor over 8), which
//! grows with the square of the discharge `q = ½ Σ f e`; the source has Manning's, of which the power 7/3 is not the
//! same to the last bit on every machine. `r = |q|³ / (½ Σ f²/w)` is `|q|` for a sheet, and takes back in a channel
//! of one cell what the missing pipes at its sides would have carried, so that a channel runs along a diagonal as it
//! does along an axis. `deepest` bounds the speed of waves, and with it the step `dt = C l / √(g deepest)`; deeper
//! water flows as if it were that deep.
//!
//! *Channels* are `k √Q` wide (Leopold and Maddock 1953), and as long in a cell as their water is displaced in it. Where
//! that is less than their cell, water is that much deeper than on the mean of the cell, and its power acts on that much
//! less ground. A sheet gathers in channels some metres apart, whatever the cell.
//!
//! *Banks.* Sediment also drifts down the slope of the bed across a stream. Without that a river on fine cells digs a canal of
//! one cell, whatever its discharge (Baar and others 2019, doi 10.1038/s41467-019-12753-x, on why models need it and for how much more of it than is
//! measured). A channel of `k √Q` has the discharge `q = Q / (k √Q)` a width, and so is `W = k² q` wide, which each of its
//! cells knows by itself. Where that is more than a cell, ground creeps by `β E W² / h` more, with the uptake `E` and the
//! depth `h`: what is taken up in the middle of a channel is made up for from its sides where the bed lies `h` higher within
//! `√(2β)` of its width. Of a bank that is higher than the water is deep only
//! that depth is worn, and cells at an open edge, which hold the base level, are not. The bed levels along the channel as well, which on gentle slopes is little. Where the flow
//! has spread, `q` is small, and it spreads little further: with `β` of 0.05 rivers of 36 and 64 m³/s come to be `k √Q` wide within 6 %, on
//! cells of 5 and 10 m, those of 256 m³/s a third wider.
//!
//! *Ground.* Unit stream power `ω = Σ f ΔH / width` (of the outflows, with the surface of the water: still water takes
//! nothing up, and no pit digs itself) takes up `K (ω - ω_c)`; sediment settles with `v_s C` (Davy and Lague 2009, doi
//! 10.1029/2008JF001146) and travels upwind with the water. Ground creeps by `D ∇²z`, and where the slope
//! `S = (½ Σ w Δz²)^½` exceeds the talus, by `D_s (S - talus) / S` more.
//!
//! *Time.* Rivers do most of their work in floods. A flood of some hours stands for years: what happens to the ground
//! in a second of flow is multiplied by the years over the hours (the morphological factor of Roelvink 2006, doi
//! 10.1016/j.coastaleng.2005.11.002).

mod banks;
pub(crate) mod edges;
pub(crate) mod kernels;
mod program;
pub(crate) mod strata;

pub(crate) use program::program;

use std::sync::Arc;

use super::pipeline::{Equations, Pipeline};
use super::springs::Forcing;
use super::sums;
use banks::{Banks, Washed};
use edges::{PIPE_AXIS, PIPE_DIAGONAL};
use kernels::{Accelerate, Dried, Flow, Rained, Shares, Slid, Through, Unrest, Uptake, Wear};
use strata::{BOTTOMS, Mapped, Strata};
use weald_core::material::MAX_MATERIALS;
use weald_engine::machine::{Means, Part};
use weald_engine::uniform;

/// Planes that change, before and after a step; the first three are those of all models of water.
const STATE: [(&str, &str); 8] = [
    ("change_before", "change"),
    ("depth_before", "water"),
    ("sediment_before", "sediment"),
    ("old_east", "flux_east"),
    ("old_south", "flux_south"),
    ("old_diagonal", "flux_diagonal"),
    ("old_antidiagonal", "flux_antidiagonal"),
    ("resistance_before", "resistance"),
];

/// Number of planes that change on ground of one material.
pub(crate) const PLANES: usize = STATE.len();

/// The plane behind them, where ground is of several materials.
const ROCK: (&str, &str) = ("rock_before", "rock");

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
        /// For each material, bedrock first: its erodibility over that of the bedrock, its talus over `talus`, and
        /// whether it is loose.
        pub(crate) materials: [[f32; 4]; MAX_MATERIALS],
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
        /// How fast ground levels across a channel, `β`.
        pub(crate) lateral_wear: f32,
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
        /// Thickness of a cover that protects by half what it lies on.
        pub(crate) half: f32,
        /// Uniforms with vectors end on a multiple of sixteen bytes.
        pub(crate) padding_a: f32,
    }
}

/// The method with its numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    pub(crate) constants: FluvialConstants,
    /// Materials, where the ground is of several.
    pub(crate) strata: Option<Strata>,
    /// Whether a constant plane says what rains on each cell.
    pub(crate) rain_map: bool,
    /// Whether one says how soft the ground is.
    pub(crate) erodibility_map: bool,
    /// Whether water evaporates.
    pub(crate) evaporates: bool,
}

impl Numbers {
    /// Number of planes that change.
    pub(crate) fn planes(&self) -> usize {
        PLANES + usize::from(self.strata.is_some())
    }

    fn state(&self) -> Vec<(&'static str, &'static str)> {
        STATE.into_iter().chain(self.strata.is_some().then_some(ROCK)).collect()
    }

    /// Names of the planes that stay: the ground at the start, what rains, and the bottoms of strata.
    fn constant_planes(&self) -> Vec<&'static str> {
        let strata = self.strata.as_ref().map_or(0, |strata| strata.beds.len());
        let rain = self.rain_map.then_some("inflow");
        let map = self.erodibility_map.then_some("erodibility_map");
        std::iter::once("base").chain(rain).chain(map).chain(BOTTOMS.into_iter().take(strata)).collect()
    }

    /// The equations in their order.
    pub(crate) fn pipeline(&self) -> Arc<Pipeline> {
        let mut equations = Equations::new(&self.constant_planes(), &self.state(), &self.constants);
        equations.weather(&Forcing { rain: 0.0, evaporation: 0.0 });
        // Where all is even, what belongs to cells with data alone stands for 1.
        let inflow = if self.rain_map { "inflow" } else { "valid" };
        let [repose, loose] = if self.strata.is_some() { ["repose", "loose"] } else { ["valid"; 2] };
        let softness = match (&self.strata, self.erodibility_map) {
            (Some(_), _) => "softness",
            (None, true) => "erodibility_map",
            (None, false) => "valid",
        };
        if let Some(strata) = &self.strata {
            strata.add_to(&mut equations);
            if self.erodibility_map {
                equations.kernel_on::<Mapped>(&[("factor", "erodibility_map")]);
            }
        }
        if self.evaporates {
            equations.kernel_on::<Dried>(&[("inflow", inflow)]).tally("evaporated", sums::EVAPORATED);
        } else {
            equations.kernel_on::<Rained>(&[("inflow", inflow)]);
        }
        equations.tally("fallen", sums::RAINED);
        equations.kernel::<Accelerate>().kernel::<Shares>().kernel::<Through>().kernel::<Flow>();
        equations.tally("water_out", sums::WATER_OUT).tally("sediment_out", sums::SEDIMENT_OUT);
        equations.kernel_on::<Uptake>(&[("softness", softness)]).kernel::<Wear>();
        equations.kernel::<Banks>().kernel::<Washed>();
        equations.kernel_on::<Unrest>(&[("repose", repose), ("loose", loose)]).kernel::<Slid>();
        equations.finish()
    }
}

/// The fluxes through the four edges that each cell keeps of a sheet with this discharge, `w (e · q)`.
pub(crate) fn fluxes_of(discharge: [&[f32]; 2], columns: usize) -> [Vec<f32>; 4] {
    let rows = discharge[0].len() / columns;
    let edge = |east: isize, south: isize, weight: f32| -> Vec<f32> {
        let through = |cell: usize| {
            let (x, y) = (cell % columns, cell / columns);
            let next = x.checked_add_signed(east).zip(y.checked_add_signed(south));
            let Some((x, y)) = next.filter(|&(x, y)| x < columns && y < rows) else { return 0.0 };
            let mean = discharge.map(|along| 0.5 * (along[cell] + along[y * columns + x]));
            weight * (mean[0] * east as f32 + mean[1] * south as f32)
        };
        (0..rows * columns).map(through).collect()
    };
    [edge(1, 0, PIPE_AXIS), edge(0, 1, PIPE_AXIS), edge(1, 1, PIPE_DIAGONAL), edge(-1, 1, PIPE_DIAGONAL)]
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
