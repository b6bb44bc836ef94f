//! Dissolution alone, which fills water up to its capacity: fast and slow.

use super::han::{self, FinishedRun, MEANING, Run, header, row, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, views};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

pub(super) const FIGURE: Figure = Figure {
    id: "dissolution",
    title: "Dissolution alone",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 8, after Mei, Decaudin and Hu 2007, doi 10.1109/PG.2007.15",
    shows: "Erosion that only fills water up to its capacity does not form rivers. This holds where dissolution \
            is fast; slow dissolution depends on discharge again and does form them.",
    seconds: 7,
    make: Make::Alone(make),
};

/// Share of the unused transport capacity that an iteration takes up (K_s), fast to slow.
const RATES: [f64; 4] = [1.0, 0.1, 0.03, 0.01];

/// K_s from which dissolution is fast.
const FAST: f64 = 0.1;

/// Steps after which little is dissolved yet.
const EARLY: u32 = 240;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |rate: f64| {
        let keys = format!("law = \"dissolution\"\ncapacity = 1.0\nerosion = {rate:?}");
        Run::new(job, &format!("K_s = {rate}"), &keys)
    };
    let [water, velocity] = [Run::new(job, "water only", "erosion = 0.0"), Run::new(job, "by velocity", "")];
    let early = |run: Run| Run { iterations: job.choose(EARLY, 120), ..run };
    let young = han::run_all(&[early(run(FAST)), early(velocity.clone())])?;
    let runs = han::run_all(&[RATES.map(run).to_vec(), vec![water, velocity]].concat())?;
    let dissolved = &runs[..RATES.len()];
    let width = job.choose(380, 32);
    let relief = views::sheet(dissolved, 4, |landscape| views::relief(landscape, width))?;
    let flow = views::sheet(dissolved, 4, |landscape| views::flow(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", dissolved, relief),
            views::plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                dissolved,
                flow,
            ),
        ],
        measured: measured(&runs),
        claims: vec![no_rivers(&runs), like_streams(&young, &runs)?],
        ..FigureOutput::default()
    })
}

fn measured(runs: &[FinishedRun]) -> Measured {
    let row = |ran: &FinishedRun| [row(ran), vec![format!("{:.2}", ran.measures.flux_gini)]].concat();
    Measured {
        header: [header(), vec!["unevenness".to_owned()]].concat(),
        rows: runs.iter().map(row).collect(),
        remarks: vec![
            MEANING.to_owned(),
            "`unevenness`: Gini coefficient of the mean discharge of the cells, 0 where all carry the same."
                .to_owned(),
        ],
    }
}

fn no_rivers(runs: &[FinishedRun]) -> Claim {
    let (dissolved, water) = (&runs[..RATES.len()], &runs[RATES.len()]);
    let chans: Vec<f64> = dissolved.iter().map(|ran| ran.measures.chan).collect();
    let shares: Vec<String> = chans.iter().map(|&chan| share(chan)).collect();
    let none = |least: f64| {
        RATES.iter().zip(&chans).all(|(&rate, &chan)| rate < least || chan < 0.1 * water.measures.chan)
    };
    Claim::new(
        "Dissolution alone does not form rivers",
        Verdict::under(&format!("where it is fast, K_s of {FAST} or more"), none(FAST), none(0.0)),
        format!(
            "`chan` {}; water that does not erode has {}",
            han::list(RATES.map(|rate| format!("at K_s {rate}:")), &shares),
            share(water.measures.chan)
        ),
    )
}

/// Correlation from which two maps of discharge look alike.
const ALIKE: f64 = 0.6;

/// Compares the map of discharge of fast dissolution with that of erosion by velocity, early and at the end.
fn like_streams(young: &[FinishedRun], runs: &[FinishedRun]) -> Result<Claim, Error> {
    let fast = RATES.iter().position(|&rate| rate == FAST).expect("it is among them");
    let early = likeness(&young[0].landscape, &young[1].landscape)?;
    let late = likeness(&runs[fast].landscape, &runs[RATES.len() + 1].landscape)?;
    let steps = young[0].run.iterations;
    Ok(Claim::new(
        "Its map of discharge looks like that of Fig. 4",
        Verdict::under("while little is dissolved", early >= ALIKE, early >= ALIKE && late >= ALIKE),
        format!(
            "logarithms of discharge at K_s {FAST} and by velocity correlate by {early:.2} after {steps} steps and by \
             {late:.2} after {}; maps look alike from {ALIKE}",
            runs[fast].run.iterations
        ),
    ))
}

/// Correlation of the logarithms of two discharges, from the rain of one cell upwards.
fn likeness(one: &Landscape, other: &Landscape) -> Result<f64, Error> {
    let logarithms = |landscape| -> Result<Vec<f64>, Error> {
        let discharge = views::discharge(landscape)?;
        Ok(discharge.values().iter().map(|&flow| libm::log(f64::from(flow).max(han::RAIN))).collect())
    };
    let (one, other) = (logarithms(one)?, logarithms(other)?);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let means = [mean(&one), mean(&other)];
    let [mut both, mut first, mut second] = [0.0; 3];
    for (a, b) in one.iter().zip(&other) {
        let (a, b) = (a - means[0], b - means[1]);
        both += a * b;
        first += a * a;
        second += b * b;
    }
    Ok(both / (first * second).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};

    #[test]
    fn a_rate_that_just_counts_as_fast_is_judged_with_the_faster_ones() {
        let flat = Field::filled(Size::square(2).expect("small"), 0.0);
        let judged = |chans: [f64; 5]| {
            let runs = chans.map(|chan| {
                let mut ran = han::finished(flat.clone());
                ran.measures.chan = chan;
                ran
            });
            no_rivers(&runs).verdict
        };
        // The last is that of water that does not erode, of which a tenth is a river.
        assert_eq!(judged([0.0, 0.0, 0.0, 0.0, 1.0]), Verdict::Shown);
        assert!(matches!(judged([0.0, 0.0, 0.5, 0.5, 1.0]), Verdict::ShownIf(_)));
        assert_eq!(judged([0.0, 0.5, 0.0, 0.0, 1.0]), Verdict::NotReproduced);
    }
}
