//! Flow routing: where the water of each cell goes, and how much land lies above it.
//!
//! Depressions are filled to their lowest rims or breached, flat ground is given directions, then each cell
//! drains to its steepest neighbour (D8, O'Callaghan and Mark 1984, doi 10.1016/S0734-189X(84)80011-0), or to the
//! one that keeps its path nearest to the fall line (D8-LTD). The stages, one file each:
//!
//! | file | what |
//! |---|---|
//! | `surface` | heights with a ring of no-data around them |
//! | `descent` | steepest descent of every cell, by rows |
//! | `basins` | the cells that descend to the same pit |
//! | `saddles` | the saddles between basins that matter: a minimum spanning tree |
//! | `disjoint_sets` | sets of basins that were joined |
//! | `fill` | the level at which water leaves each basin: what priority-flood gives |
//! | `breach` | channels through the rims instead |
//! | `flats` | directions over flat ground |
//! | `fall_lines` | the two neighbours beside the fall line of each cell |
//! | `least_deviation` | directions along paths that stay near the fall line |
//! | `codes` | directions in the numbers of other programs |
//! | `accumulate`, `multiple` | upslope areas, along D8 or shared among all lower neighbours |
//! | `tiled` | the same, to the bit, over ground that is read tile by tile |
//!
//! What is filled is, to the bit, what priority-flood fills (Barnes, Lehman and Mulla 2014, doi
//! 10.1016/j.cageo.2013.04.024): the least height that a path to an outlet must pass. But there is no queue of
//! cells: water descends to pits in parallel, and only the graph of basins is flooded, from the lowest saddle up
//! (Cordonnier, Bovy and Braun 2019, "A versatile, linear complexity algorithm for flow routing in topographies
//! with depressions", doi 10.5194/esurf-7-549-2019). Every result is the same for any number of threads.

mod accumulate;
mod basins;
mod breach;
mod codes;
mod descent;
pub mod directions;
pub(crate) mod disjoint_sets;
mod fall_lines;
mod fill;
mod flats;
mod least_deviation;
mod multiple;
mod multiple_sums;
mod naive;
pub(crate) mod priority_flood;
pub(crate) mod row_weights;
mod saddles;
mod surface;
pub mod tiled;

pub use accumulate::accumulate;
pub use codes::DirectionCodes;
pub use multiple::MultipleFlow;
pub use multiple_sums::accumulate_multiple;
pub use naive::naive;

use basins::Basins;
use descent::Descent;
use directions::{Directions, OUTLET, SEA};
use saddles::Saddles;
use surface::Surface;
use weald_core::choices;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};

choices! {
    /// What becomes of depressions.
    pub enum Depressions {
        /// They fill to the lowest point of their rims.
        Fill = "fill",
        /// A channel through the rim drains them.
        Breach = "breach",
    }
}

choices! {
    /// Which neighbour a cell drains to.
    pub enum DirectionRule {
        /// The one to which the ground drops most by length: a path keeps to multiples of 45° where the fall line does not.
        Steepest = "d8",
        /// The one that keeps the path nearest to the fall line.
        LeastDeviation = "d8-ltd",
    }
}

/// How water is led over the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Routing {
    /// What becomes of depressions.
    pub depressions: Depressions,
    /// Deepest cut of a breach in metres; depressions that need a deeper one are filled.
    pub deepest_breach: f64,
    /// Height of the sea in metres: cells no higher, and connected to the border by such cells, are sea.
    pub sea_level: Option<f64>,
    /// Which neighbour a cell drains to.
    pub directions: DirectionRule,
}

impl Default for Routing {
    fn default() -> Self {
        Self {
            depressions: Depressions::Fill,
            deepest_breach: f64::INFINITY,
            sea_level: None,
            directions: DirectionRule::Steepest,
        }
    }
}

/// Ground without depressions, and the flow path over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Routed {
    /// Heights after filling or breaching: no flow path rises. Cells of the sea keep their height.
    pub surface: Field,
    /// Where each cell drains to. Every path ends at an outlet or in the sea.
    pub directions: Directions,
    /// The cells above each along those directions, and itself, where they were counted on the way: by [`accumulate`] without
    /// weights it is the same.
    pub upslope_cells: Option<Vec<u32>>,
}

/// Leads water over the ground. Cells without data take part in nothing; water leaves beside them as it does
/// over the border.
///
/// # Panics
/// If a height of a cell with data is not finite: a bug of the caller.
pub fn route(height: &Field, valid: Option<&Mask>, routing: &Routing) -> Routed {
    route_watched(height, valid, routing, &mut || Ok(())).expect("nobody stops it")
}

/// Stages of [`route_watched`], after each of which it tells.
pub const STAGES: u64 = 6;

/// The same, which tells after each of its [`STAGES`] and stops where that gives an error.
///
/// # Errors
/// That of `passed`.
///
/// # Panics
/// As [`route`].
pub fn route_watched(
    height: &Field,
    valid: Option<&Mask>,
    routing: &Routing,
    passed: &mut dyn FnMut() -> Result<(), Error>,
) -> Result<Routed, Error> {
    let mut surface = Surface::of(height, valid, routing.sea_level);
    condition(&mut surface, routing, passed)?;
    let mut descent = Descent::of(&surface);
    passed()?;
    flats::resolve(&surface, &mut descent);
    let paths = match routing.directions {
        DirectionRule::Steepest => None,
        DirectionRule::LeastDeviation => Some(least_deviation::follow(&surface, &descent.codes)),
    };
    passed()?;
    let codes = surface.inner(&descent.codes, |cell, code| match (code, &paths) {
        _ if surface.is_sea(cell) => SEA,
        (1..=8, Some(paths)) => paths.code(cell),
        (1..=8, None) => code,
        _ => OUTLET,
    });
    let upslope_cells = paths.map(|paths| {
        surface.inner(&descent.codes, |cell, _| if surface.has_data(cell) { paths.cells(cell) } else { 0 })
    });
    let filled = surface.inner(&surface.level, |_, level| level);
    let mut filled = Field::from_values(height.size(), filled);
    for (level, &height) in filled.values_mut().iter_mut().zip(height.values()) {
        if level.is_infinite() {
            *level = height;
        }
    }
    passed()?;
    Ok(Routed { surface: filled, directions: Directions::new(height.size(), codes), upslope_cells })
}

/// Takes the depressions out of a surface, in three stages.
fn condition(
    surface: &mut Surface,
    routing: &Routing,
    passed: &mut dyn FnMut() -> Result<(), Error>,
) -> Result<(), Error> {
    let basins = Basins::of(surface);
    passed()?;
    let saddles = Saddles::of(surface, &basins);
    passed()?;
    match routing.depressions {
        Depressions::Fill => fill::fill(surface, &basins, &saddles),
        Depressions::Breach => {
            breach::breach(surface, &basins, &saddles, routing.deepest_breach as f32);
            if routing.deepest_breach.is_finite() {
                let basins = Basins::of(surface);
                let saddles = Saddles::of(surface, &basins);
                fill::fill(surface, &basins, &saddles);
            }
        }
    }
    passed()
}
