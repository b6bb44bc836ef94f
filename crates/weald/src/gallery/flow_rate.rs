//! Water and discharge for a small and a large k.

use super::han::{self, MEANING, Ran, Run, header, row, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Measured, Verdict, views};
use crate::error::Error;
use crate::picture::Image;

pub(super) const FIGURE: Figure = Figure {
    id: "flow-rate",
    title: "Streams by k",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 4",
    shows: "With a small k water stands on the slopes and creeps; with a large k it gathers in streams.",
    seconds: 6,
    make,
};

const RATES: [f64; 5] = [0.02, 0.1, 0.2, 0.4, 0.45];

/// Places in [`RATES`] of the small and the large k that are drawn.
const DRAWN: [usize; 2] = [0, 3];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |rate: f64| Run::new(job, &format!("k = {rate:?}"), &format!("flow_rate = {rate:?}"));
    let runs = han::run_all(&RATES.map(run))?;
    let width = job.choose(600, 32);
    let drawn = DRAWN.map(|place| runs[place].clone());
    let pair = |draw: fn(&crate::Landscape, u32) -> Result<Image, Error>| {
        views::sheet(&drawn, 2, |landscape| draw(landscape, width))
    };
    Ok(FigureOutput {
        plates: vec![
            views::plate("water", "Depth of water, from 0 to 1 cell,", &drawn, pair(views::depth)?),
            views::plate("flow", "Mean discharge", &drawn, pair(views::flow)?),
        ],
        measured: Measured {
            header: header(),
            rows: runs.iter().map(row).collect(),
            remarks: vec![MEANING.to_owned()],
        },
        claims: claims(&runs),
    })
}

fn claims(runs: &[Ran]) -> Vec<Claim> {
    let chans: Vec<f64> = runs.iter().map(|ran| ran.measures.chan).collect();
    let shares: Vec<String> = chans.iter().map(|&chan| share(chan)).collect();
    let upto = chans[..4].is_sorted_by(|a, b| a < b);
    vec![Claim::new(
        "A larger k makes better streams",
        Verdict::under("up to k = 0.4", upto, upto && chans[4] > chans[3]),
        format!("`chan` {}", han::list(RATES.map(|rate| format!("at k {rate:?}:")), &shares)),
    )]
}
