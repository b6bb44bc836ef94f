//! Generators: ground from nothing, one file a method.
//!
//! A generator fills the whole grid, no-data cells as well, so that its random numbers do not depend on the
//! mask. Positions are those of cell centres, in metres from the north-western corner of the landscape.

pub mod basin;
pub mod cone;
pub mod constant;
pub mod diamond_square;
pub mod dome;
pub mod fault;
pub mod fbm;
pub mod hash;
pub mod minstd;
pub mod noise;
pub mod octaves;
pub mod plane;
pub mod relief;
pub mod ridged;
pub mod volcano;
pub mod warp;

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};
pub use weald_engine::generator::Generator;
use weald_engine::program::Program;

/// The programs of all generators that a device can run, for tests of the shaders.
pub fn programs() -> Vec<Program> {
    let domain = Domain::new(Size { columns: 5, rows: 4 }, 1.0);
    let made = [
        fbm::Fbm::default().on_device(&domain, 1),
        ridged::Ridged::default().on_device(&domain, 1),
        warp::Warp::default().on_device(&domain, 1),
        fault::Fault::default().on_device(&domain, 1),
        diamond_square::DiamondSquare::default().on_device(&domain, 1),
    ];
    made.into_iter().flatten().map(|work| work.program).collect()
}

/// A field by column and row, in metres, made on all cores.
fn by_cells(size: Size, height: impl Fn(usize, usize) -> f64 + Sync) -> Field {
    let mut field = Field::filled(size, 0.0);
    field.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
        for (x, value) in row.iter_mut().enumerate() {
            *value = height(x, y) as f32;
        }
    });
    field
}

/// Distance in metres of a cell's centre from a point given in metres from the western and the northern edge;
/// the middle of the landscape stands in for what is not given.
fn distance_from(domain: &Domain, center: [Option<f64>; 2]) -> impl Fn(usize, usize) -> f64 + use<> {
    let cell = domain.cell;
    let middle = [domain.size.columns, domain.size.rows].map(|cells| cells as f64 * cell / 2.0);
    let [center_x, center_y] = [0, 1].map(|axis| center[axis].unwrap_or(middle[axis]));
    move |x, y| {
        let [dx, dy] = [(x as f64 + 0.5) * cell - center_x, (y as f64 + 0.5) * cell - center_y];
        (dx * dx + dy * dy).sqrt()
    }
}
