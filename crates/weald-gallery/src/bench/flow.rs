//! Rates of flow over the ground: depressions filled, directions, upslope areas.

use super::rate::{Baseline, Rate, best_seconds};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_engine::generator::Generator;
use weald_land::flow::{MultipleFlow, Routing, accumulate, accumulate_multiple, naive, route};
use weald_land::generate::diamond_square::DiamondSquare;

/// Bytes per cell that the passes read and write: surface 8, descent twice 5, links 2, labels 17, passes 8, fill 12,
/// flats 6, directions and surface out 18, donors 4, sums 36. Rows that stay in the cache count once.
const BYTES: usize = 121;

/// The same for shares among lower neighbours, without routing: links 33, donors 9, sums 50.
const BYTES_OF_SHARES: usize = 92;

/// Most cells a side of the ground on which the naive version is measured: its rate falls with the size.
const NAIVE_SIDE: usize = 1024;

pub(super) fn flow(size: Size, bandwidth: f64, report: &mut (dyn FnMut(&Rate) + Send)) -> Result<(), Error> {
    let ground = ground(size)?;
    let small = ground_of_side(size.columns.min(NAIVE_SIDE))?;
    let naive = rate(small.size(), best_seconds(|| drop(naive(&small))));
    let mut routed = route(&ground, None, &Routing::default());
    let seconds = best_seconds(|| {
        routed = route(&ground, None, &Routing::default());
        drop(accumulate(&routed.directions, None, None));
    });
    let shares = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
    let seconds_of_shares = best_seconds(|| drop(accumulate_multiple(&shares, None)));
    let threads = Some(rayon::current_num_threads());
    for (name, seconds, bytes) in [
        ("flow, filled, D8", seconds, BYTES),
        ("flow, shared areas alone", seconds_of_shares, BYTES_OF_SHARES),
    ] {
        let beside = Baseline::Passes { bytes, bandwidth, naive };
        report(&Rate { name: name.to_owned(), size, threads, millions: rate(size, seconds), beside });
    }
    Ok(())
}

fn rate(size: Size, seconds: f64) -> f64 {
    size.cells() as f64 / seconds / 1e6
}

fn ground_of_side(side: usize) -> Result<Field, Error> {
    ground(Size::square(side)?)
}

/// Rough ground with many depressions.
fn ground(size: Size) -> Result<Field, Error> {
    let ground = DiamondSquare { relief: 800.0, ..DiamondSquare::default() };
    ground.fill(&Domain::new(size, 10.0), 7)
}
