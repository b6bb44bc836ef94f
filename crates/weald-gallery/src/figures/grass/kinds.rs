//! The built-in species, each as it grows on ground that it likes.

use super::raster::Vector;
use super::tufts::portrait;
use crate::figures::views::laid_out;
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::random::{hash2, unit};
use weald_plants::grass::{Bend, Growth, SPECIES, Set};

pub(in crate::figures) const FIGURE_5B: Figure = Figure {
    id: "grass-5b",
    title: "Other grasses",
    source: "Kim and Cho 2009, outlook; Weald",
    shows: "The source asks for other plants by other curves, widths and colours. These have their own curves, stiffness and \
        seed heads: above on good soil in half light, below on poor soil in full light.",
    seconds: 6,
    make: Make::Alone(|job| Ok(make(job))),
};

/// Sets of a clump.
const SETS: u32 = 9;

/// Good ground, and bad.
const GROUNDS: [[f32; 2]; 2] = [[0.9, 0.5], [0.15, 1.0]];

fn make(job: GalleryJob) -> FigureOutput {
    let size = job.choose([252, 350], [40, 60]);
    let set = |[soil, light]: [f32; 2]| Set { soil, light, level: 4.0, cut: 1.0, trodden: 0.0, seed: 4 };
    let mut images = Vec::new();
    let mut rows = Vec::new();
    for ground in GROUNDS {
        for species in &SPECIES {
            let height = set(GROUNDS[0]).height(species, Bend::Total) * species.stalk.max(1.0);
            images.push(
                portrait(species, &clump(&set(ground), 0.1 * height), 1.45 * height, size)
                    .titled(species.name),
            );
        }
    }
    for species in &SPECIES {
        let number = |ground| {
            let growth = Growth::at(&species.curves, ground, 0.5);
            [
                set([ground, 0.5]).height(species, Bend::Total),
                4000.0 * species.width * growth.width,
                growth.bend.to_degrees() * species.bending,
            ]
        };
        let [good, bad] = [0.9, 0.15].map(number);
        rows.push(vec![
            species.name.to_owned(),
            format!("{:.2} to {:.2}", bad[0], good[0]),
            format!("{:.1} to {:.1}", bad[1], good[1]),
            format!("{:.0} to {:.0}", bad[2], good[2]),
            species.heads.to_string(),
        ]);
    }
    let heights = SPECIES.each_ref().map(|species| set(GROUNDS[0]).height(species, Bend::Total));
    let spread =
        heights.iter().fold(0.0_f32, |a, &b| a.max(b)) / heights.iter().fold(f32::MAX, |a, &b| a.min(b));
    FigureOutput {
        plates: vec![Plate {
            name: "portraits",
            caption: "Clumps of nine sets of ryegrass, fescue, reed, feather grass and false oat grass, each at a scale of its own"
                .to_owned(),
            image: laid_out(&images, SPECIES.len()),
        }],
        measured: Measured {
            header: texts(["species", "height (m)", "width (mm)", "bend (°)", "heads of a set"]),
            rows,
            remarks: texts(["From poor to good soil, in half light."]),
        },
        claims: vec![Claim::new(
            "Other curves and sizes make other grasses",
            Verdict::of(spread > 5.0),
            format!("{} species, the tallest {spread:.0} times as high as the shortest", SPECIES.len()),
        )], ..FigureOutput::default() }
}

/// Sets that grow close together, within so many metres.
fn clump(set: &Set, reach: f32) -> Vec<(Vector, Set)> {
    let place = |number: u32| {
        let random = |purpose| (2.0 * unit(hash2(11, i64::from(number), purpose)) - 1.0) as f32 * reach;
        ([random(0), 0.0, random(1)], Set { seed: 31 * number + 4, ..*set })
    };
    (0..SETS).map(place).collect()
}
