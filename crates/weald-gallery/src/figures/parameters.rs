//! The parameters of Han 2015 and the values that the figures use.

use super::han::{self, Run, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, texts};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "parameters",
    title: "Parameters",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Table 1",
    shows: "The constants of the scheme. The values are those of Weald, chosen by the figures below; with cells of \
            size 1 they are the source's symbols.",
    seconds: 4,
    make: Make::Alone(make),
};

/// Symbol, key of the `hydraulic` step, value and meaning.
const TABLE: [[&str; 4]; 12] = [
    ["k", "flow_rate", "0.4", "dt² g A / l: how fast differences in level turn into flow"],
    ["R", "rain", "0.01", "cells per iteration while it rains"],
    ["E", "evaporation", "0.03", "cells per iteration while the sun shines"],
    ["T_R", "rain_period", "60", "steps"],
    ["T_E", "dry_period", "60", "steps"],
    ["ε", "epsilon", "0.001", "cells of depth, added where sediment is divided by depth"],
    ["ε_v", "velocity_epsilon", "0.1", "cells of depth, added where flux is divided by depth"],
    ["K_c", "capacity", "10.0", "sediment that a unit of water holds at unit speed and slope"],
    ["K_v", "erosion", "0.005", "uptake a unit of speed"],
    ["r", "deposit_ratio", "1.0", "share of deposited sediment added to the ground"],
    [
        "K_t",
        "thermal.strength",
        "0.05",
        "share of the excess slope that slides in a step, in figures with weathering",
    ],
    ["tan φ", "thermal.talus", "0.8", "slope that rests, in figures with weathering"],
];

/// The source's regulariser over four decades.
const EPSILONS: [f64; 3] = [1e-6, 1e-3, 1e-2];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |epsilon: f64| Run::new(job, "", &format!("epsilon = {epsilon:?}"));
    let runs = han::run_all(&EPSILONS.map(run))?;
    let chans: Vec<f64> = runs.iter().map(|ran| ran.measures.chan).collect();
    let least = chans.iter().copied().fold(f64::INFINITY, f64::min);
    let most = chans.iter().copied().fold(0.0, f64::max);
    let shares: Vec<String> = chans.iter().map(|&chan| share(chan)).collect();
    Ok(FigureOutput {
        plates: Vec::new(),
        measured: Measured {
            header: texts(["symbol", "key", "value", "what it is"]),
            rows: TABLE.map(texts).into(),
            remarks: texts([
                "Ground of 256 × 256 cells with a relief of 50 cells, 3600 steps, unless a figure says otherwise.",
            ]),
        },
        claims: vec![Claim::new(
            "Results hardly depend on ε",
            Verdict::of(least > 0.0 && most < 1.15 * least),
            format!("`chan` {}", han::list(EPSILONS.map(|epsilon| format!("at ε {epsilon:?}:")), &shares)),
        )],
        ..FigureOutput::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Detail;

    #[test]
    fn the_table_states_the_defaults() {
        let job = GalleryJob { detail: Detail::Draft };
        let stated: Vec<String> =
            TABLE[..10].iter().map(|[_, key, value, _]| format!("{key} = {value}")).collect();
        // Rain and its periods stand in every run of the figures already.
        let others: Vec<&str> = stated
            .iter()
            .map(String::as_str)
            .filter(|line| !["rain =", "rain_period", "dry_period"].iter().any(|key| line.starts_with(key)))
            .collect();
        assert_eq!(others.len(), 7);
        let others = others.join("\n");
        let runs = [Run::new(job, "", ""), Run::new(job, "", &others), Run::new(job, "", "erosion = 0.006")];
        let runs = han::run_all(&runs).expect("they run");
        assert_eq!(runs[0].ground(), runs[1].ground());
        assert_ne!(runs[0].ground(), runs[2].ground(), "the keys count");
    }
}
