//! The fractal ground that erosion starts from.

use super::ground::{SEED, start_terrain};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, han, views};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_land::analyse::network::{NetworkInput, measure};

pub(super) const FIGURE: Figure = Figure {
    id: "start",
    title: "Start terrain",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 3; Fournier, Fussell and Carpenter 1982, doi 10.1145/358523.358553",
    shows: "A height field by the diamond-square method: rough at all scales, without valleys that connect.",
    seconds: 2,
    make: Make::Alone(make),
};

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let side = job.choose(256, 32);
    let landscape = start_terrain(side, SEED)?;
    let (low, high) = landscape.field("height")?.range(None).unwrap_or((0.0, 0.0));
    let image = views::bare(&landscape, 768)?;
    let caption = format!("{side} × {side} cells, roughness 0.9");
    Ok(FigureOutput {
        plates: vec![Plate { name: "relief", caption, image }],
        measured: Measured {
            remarks: vec![format!("Heights from {low:.1} to {high:.1} cells.")],
            ..Measured::default()
        },
        claims: vec![without_valleys(job, &landscape)?],
        ..FigureOutput::default()
    })
}

fn without_valleys(job: GalleryJob, landscape: &Landscape) -> Result<Claim, Error> {
    let size = landscape.domain.size;
    let dry = Field::filled(size, 0.0);
    let still = measure(&NetworkInput {
        ground: landscape.field("height")?,
        before: None,
        depth: &dry,
        mean_flux_x: &dry,
        mean_flux_y: &dry,
        mean_rain: 1.0,
        cell: 1.0,
        valid: None,
    });
    let eroded = &han::run_all(&[han::Run::new(job, "erosion", "")])?[0].measures;
    Ok(Claim::new(
        "Fractal ground has no valleys that connect; erosion makes them",
        Verdict::of(eroded.reach > 3.0 * still.reach),
        format!(
            "the longest connected valley measures {:.2} of the side, after erosion {:.2}; the ground has {} pits",
            still.reach, eroded.reach, still.pits
        ),
    ))
}
