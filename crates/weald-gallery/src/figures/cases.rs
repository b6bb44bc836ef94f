//! Two cases of capacity and strength, large.

use super::han::{self, MEANING, RULE, Run, header, row, share};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, views};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "cases",
    title: "Two cases of capacity and strength",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 5",
    shows: "Good capacities and strengths make networks of rivers. A small strength makes many fine valleys, a larger \
            one fewer and deeper ones. The pairs are two of those in the table that make networks.",
    seconds: 4,
    make: Make::Alone(make),
};

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let runs = [
        Run::new(job, "K_c 10, K_v 0.003", "capacity = 10.0\nerosion = 0.003"),
        Run::new(job, "K_c 10, K_v 0.01", "capacity = 10.0\nerosion = 0.01"),
        Run::new(job, "water only", "erosion = 0.0"),
    ];
    let runs = han::run_all(&runs)?;
    let (cases, water) = (&runs[..2], &runs[2]);
    let width = job.choose(640, 32);
    let relief = views::sheet(cases, 2, |landscape| views::relief(landscape, width))?;
    let flow = views::sheet(cases, 2, |landscape| views::flow(landscape, width))?;
    let networks = cases.iter().all(|ran| ran.is_network(water));
    let chans: Vec<String> = runs.iter().map(|ran| share(ran.measures.chan)).collect();
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", cases, relief),
            views::plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                cases,
                flow,
            ),
        ],
        measured: Measured {
            header: header(),
            rows: runs.iter().map(row).collect(),
            remarks: vec![MEANING.to_owned()],
        },
        claims: vec![Claim::new(
            "Both form networks of rivers",
            Verdict::of(networks),
            format!(
                "`chan` {}; {RULE}",
                han::list(runs.iter().map(|ran| format!("{}:", ran.run.name)), &chans)
            ),
        )],
        ..FigureOutput::default()
    })
}
