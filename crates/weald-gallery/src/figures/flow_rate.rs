//! Water and discharge for a small and a large k.

use super::han::{self, MEANING, Run, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, texts, views};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "flow-rate",
    title: "Streams by k",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 4",
    shows: "With a small k water stands in hollows and creeps; with a large k it gathers in streams.",
    seconds: 10,
    make: Make::Alone(make),
};

const RATES: [f64; 5] = [0.02, 0.1, 0.2, 0.4, 0.45];

/// Seeds of the ground over which measures are averaged.
const SEEDS: [u64; 5] = [3, 5, 7, 11, 13];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let drawn = han::run_all(&[0.02, 0.4].map(|rate| run(job, rate)))?;
    let width = job.choose(600, 32);
    let streams = RATES.map(|rate| Streams::of(job, rate)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let (side, iterations) = SMALL;
    let remark = format!(
        "Means over five seeds on {side} × {side} cells after {iterations} steps, with the least and the greatest."
    );
    let depth = views::sheet(&drawn, 2, |landscape| views::depth(landscape, width))?;
    let flow = views::sheet(&drawn, 2, |landscape| views::flow(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("water", "Depth of water, from 0 to 1 cell,", &drawn, depth),
            views::plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                &drawn,
                flow,
            ),
        ],
        measured: Measured {
            header: texts(["k", "chan", "reach", "drains"]),
            rows: streams.iter().map(Streams::row).collect(),
            remarks: vec![remark, MEANING.to_owned()],
        },
        claims: claims(&streams),
        ..FigureOutput::default()
    })
}

fn run(job: GalleryJob, rate: f64) -> Run {
    Run::new(job, &format!("k = {rate:?}"), &format!("flow_rate = {rate:?}"))
}

/// Cells a side and steps of the runs that are measured.
const SMALL: (usize, u32) = (128, 2400);

/// Measures for one k over the seeds.
struct Streams {
    rate: f64,
    chan: Vec<f64>,
    reach: Vec<f64>,
    drains: Vec<f64>,
}

impl Streams {
    fn of(job: GalleryJob, rate: f64) -> Result<Self, Error> {
        let (side, iterations) = job.choose(SMALL, (32, 120));
        let runs = han::run_all(&Run { side, iterations, ..run(job, rate) }.for_seeds(&SEEDS))?;
        let all = |of: fn(&han::FinishedRun) -> f64| runs.iter().map(of).collect();
        Ok(Self {
            rate,
            chan: all(|ran| ran.measures.chan),
            reach: all(|ran| ran.measures.reach),
            drains: all(|ran| ran.measures.drains),
        })
    }

    fn mean_chan(&self) -> f64 {
        self.chan.iter().sum::<f64>() / self.chan.len() as f64
    }

    fn row(&self) -> Vec<String> {
        let cell = |values: &[f64], digits: usize| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(0.0, f64::max);
            format!("{mean:.digits$} ({least:.digits$} to {most:.digits$})")
        };
        vec![format!("{:?}", self.rate), cell(&self.chan, 4), cell(&self.reach, 2), cell(&self.drains, 2)]
    }
}

fn claims(streams: &[Streams]) -> Vec<Claim> {
    let shares: Vec<String> = streams.iter().map(|streams| share(streams.mean_chan())).collect();
    let rises = |streams: &[Streams]| streams.is_sorted_by(|a, b| a.mean_chan() < b.mean_chan());
    vec![Claim::new(
        "A larger k makes better streams",
        Verdict::under("up to k = 0.4", rises(&streams[..4]), rises(streams)),
        format!("`chan` {}", han::list(RATES.map(|rate| format!("at k {rate:?}:")), &shares)),
    )]
}
