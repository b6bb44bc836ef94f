//! Dissolution alone, which fills water up to its capacity: fast and slow.

use super::han::{self, MEANING, RULE, Ran, Run, header, row, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Measured, Verdict, views};
use crate::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "dissolution",
    title: "Dissolution alone",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 8, after Mei, Decaudin and Hu 2007, doi 10.1109/PG.2007.15",
    shows: "Erosion that only fills water up to its capacity does not form rivers. This holds where dissolution \
            is fast; slow dissolution depends on discharge again and does form them.",
    seconds: 7,
    make,
};

/// Share of the free capacity that is taken up in a step (K_s), fast to slow.
const RATES: [f64; 4] = [1.0, 0.1, 0.03, 0.01];

/// K_s from which dissolution is fast.
const FAST: f64 = 0.1;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |rate: f64| {
        let keys = format!("law = \"dissolution\"\ncapacity = 1.0\nerosion = {rate:?}");
        Run::new(job, &format!("K_s = {rate}"), &keys)
    };
    let others = [Run::new(job, "water only", "erosion = 0.0"), Run::new(job, "by velocity", "")];
    let runs = han::run_all(&[RATES.map(run).to_vec(), others.to_vec()].concat())?;
    let dissolved = &runs[..RATES.len()];
    let width = job.choose(420, 32);
    let relief = views::sheet(dissolved, 4, |landscape| views::relief(landscape, width))?;
    let flow = views::sheet(dissolved, 4, |landscape| views::flow(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", dissolved, relief),
            views::plate("flow", "Mean discharge", dissolved, flow),
        ],
        measured: measured(&runs),
        claims: claims(&runs),
    })
}

fn measured(runs: &[Ran]) -> Measured {
    let row = |ran: &Ran| [row(ran), vec![format!("{:.2}", ran.measures.flux_gini)]].concat();
    Measured {
        header: [header(), vec!["unevenness".to_owned()]].concat(),
        rows: runs.iter().map(row).collect(),
        remarks: vec![
            MEANING.to_owned(),
            "`unevenness`: Gini coefficient of the mean discharge of the cells, 0 where all carry the same.".to_owned(),
        ],
    }
}

fn claims(runs: &[Ran]) -> Vec<Claim> {
    let (dissolved, water) = (&runs[..RATES.len()], &runs[RATES.len()]);
    let chans: Vec<f64> = dissolved.iter().map(|ran| ran.measures.chan).collect();
    let shares: Vec<String> = chans.iter().map(|&chan| share(chan)).collect();
    let none = |least: f64| RATES.iter().zip(&chans).all(|(&rate, &chan)| rate < least || chan < 0.1 * water.measures.chan);
    vec![Claim::new(
        "Dissolution alone does not form rivers",
        Verdict::under(&format!("where it is fast, K_s of {FAST} or more"), none(FAST), none(0.0)),
        format!("`chan` {}; {RULE}", han::list(RATES.map(|rate| format!("at K_s {rate}:")), &shares)),
    )]
}
