//! The fractal ground that erosion starts from.

use super::{Figure, FigureOutput, GalleryJob, Measured, Plate, run_steps};
use crate::domain::Domain;
use crate::error::Error;
use crate::grid::Size;
use crate::landscape::Landscape;
use crate::picture::{Picture, Relief};

pub(super) const FIGURE: Figure = Figure {
    id: "start",
    title: "Start terrain",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 3; Fournier, Fussell and Carpenter 1982, doi 10.1145/358523.358553",
    shows: "A height field by the diamond-square method: rough at all scales, without valleys that connect.",
    make,
};

/// Seed of the start terrain in all erosion figures.
const SEED: u64 = 3;

/// Fractal ground of `side` cells with a relief of a fifth of that, cells of size 1.
pub(super) fn start_terrain(side: usize) -> Result<Landscape, Error> {
    let mut landscape = Landscape::new(Domain::new(Size::square(side)?, 1.0));
    let keys = format!("relief = {:?}\nroughness = 0.9", side as f64 / 256.0 * 50.0);
    run_steps(&mut landscape, SEED, &[("diamond-square", &keys)])?;
    Ok(landscape)
}

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let side = job.choose(256, 32);
    let landscape = start_terrain(side)?;
    let (low, high) = landscape.field("height")?.range(None).unwrap_or((0.0, 0.0));
    let image = Relief { width: Some(768), contours: Some(0.0), ..Relief::default() }.render(&landscape)?;
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "relief",
            caption: format!("{side} × {side} cells, roughness 0.9"),
            image,
        }],
        measured: Measured {
            remarks: vec![format!("Heights from {low:.1} to {high:.1} cells.")],
            ..Measured::default()
        },
    })
}
