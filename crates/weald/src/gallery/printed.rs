//! The scheme as printed, in which a wet cell gives more water than it has.

use super::han::{self, MEANING, RULE, Ran, Run, header, row};
use super::{Claim, Figure, FigureOutput, GalleryJob, Measured, Verdict, views};
use crate::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "printed",
    title: "The scheme as printed",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, equations 4 to 9",
    shows: "As printed, flux starts by differences in level and is stopped only where a cell is dry, so that depths go \
            below zero. Weald scales fluxes to the water there is.",
    seconds: 8,
    make,
};

/// Name and keys of each variant of the printed scheme.
const VARIANTS: [(&str, &str); 6] = [
    ("k 0.4", "flow_rate = 0.4"),
    ("k 0.2", "flow_rate = 0.2"),
    ("k 0.05", "flow_rate = 0.05"),
    ("k 0.01", "flow_rate = 0.01"),
    ("k 0.2, E 0.015", "flow_rate = 0.2\nevaporation = 0.015"),
    ("k 0.05, E 0.015", "flow_rate = 0.05\nevaporation = 0.015"),
];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let as_printed = |(name, keys): (&str, &str)| Run::new(job, name, &format!("{keys}\nlimiter = false"));
    let limited = Run::new(job, "limited, k 0.4", "");
    let water = Run::new(job, "water only, limited", "erosion = 0.0");
    let runs = han::run_all(&[vec![water, limited], VARIANTS.map(as_printed).to_vec()].concat())?;
    let drawn = [&runs[1..3], &runs[4..5]].concat();
    let width = job.choose(560, 32);
    let flow = views::sheet(&drawn, 3, |landscape| views::flow(landscape, width))?;
    let relief = views::sheet(&drawn, 3, |landscape| views::relief(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", &drawn, relief),
            views::plate("flow", "Mean discharge", &drawn, flow),
        ],
        measured: measured(&runs)?,
        claims: claims(&runs),
    })
}

fn measured(runs: &[Ran]) -> Result<Measured, Error> {
    let row = |ran: &Ran| -> Result<Vec<String>, Error> {
        let (lowest, _) = ran.landscape.field("water")?.range(None).unwrap_or((0.0, 0.0));
        let debt = ran.landscape.field("water")?.values().iter().filter(|&&depth| depth < -1e-6).count();
        let share = 100.0 * debt as f64 / ran.ground().size().cells() as f64;
        Ok([row(ran), vec![format!("{lowest:.2}"), format!("{share:.0} %")]].concat())
    };
    Ok(Measured {
        header: [header(), super::texts(["least depth", "cells below zero"])].concat(),
        rows: runs.iter().map(row).collect::<Result<_, _>>()?,
        remarks: vec![MEANING.to_owned()],
    })
}

fn claims(runs: &[Ran]) -> Vec<Claim> {
    let (water, limited, printed) = (&runs[0], &runs[1], &runs[2..]);
    let networks = printed.iter().filter(|ran| ran.is_network(water)).count();
    let best = printed.iter().map(|ran| ran.measures.chan).fold(0.0, f64::max);
    vec![Claim::new(
        "The scheme forms networks of rivers",
        Verdict::under(
            "with fluxes scaled to the water there is; as printed none formed",
            limited.is_network(water),
            networks == printed.len(),
        ),
        format!(
            "`chan` {:.4} with the limiter, at most {best:.4} in {} runs as printed, {networks} of which are networks; {RULE}",
            limited.measures.chan,
            printed.len()
        ),
    )]
}
