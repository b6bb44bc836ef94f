//! Forms of the ground for each sediment capacity K_c and erosion strength K_v.

use super::han::{self, FinishedRun, MEANING, RULE, Run};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, views};
use weald_core::error::Error;
use weald_picture::Image;

pub(super) const FIGURE: Figure = Figure {
    id: "forms",
    title: "Forms by capacity and strength",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Table 2",
    shows: "There are a capacity K_c and a strength K_v at which a network of rivers forms. With too small \
            a strength little happens; with too large a one the ground breaks up into short gullies.",
    seconds: 30,
    make: Make::Alone(make),
};

const CAPACITIES: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

const STRENGTHS: [f64; 6] = [3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |capacity: f64, strength: f64| {
        let name = format!("K_c {capacity}, K_v {strength}");
        Run::new(job, &name, &format!("capacity = {capacity:?}\nerosion = {strength:?}"))
    };
    let table = CAPACITIES.iter().flat_map(|&capacity| STRENGTHS.map(|strength| run(capacity, strength)));
    let runs: Vec<Run> = table.chain([Run::new(job, "water only", "erosion = 0.0")]).collect();
    let mut runs = han::run_all(&runs)?;
    let water = runs.pop().expect("it was asked for");
    let width = job.choose(208, 32);
    let plates = [
        (
            "relief",
            "Ground and water",
            views::sheet(&runs, STRENGTHS.len(), |land| views::relief(land, width))?,
        ),
        (
            "flow",
            "Rivers and lakes, rivers as wide as the root of their mean discharge,",
            views::sheet(&runs, STRENGTHS.len(), |land| views::flow(land, width))?,
        ),
    ];
    Ok(FigureOutput {
        plates: plates.map(|(name, what, image)| plate(name, what, &runs, image)).into(),
        measured: measured(&runs),
        claims: claims(&runs, &water),
        ..FigureOutput::default()
    })
}

fn plate(name: &'static str, what: &str, runs: &[FinishedRun], image: Image) -> Plate {
    let steps = runs[0].run.iterations;
    Plate {
        name,
        caption: format!("{what} after {steps} steps; K_c grows downward, K_v to the right"),
        image,
    }
}

fn measured(runs: &[FinishedRun]) -> Measured {
    let strengths = STRENGTHS.iter().map(|strength| format!("K_v {strength}"));
    let row = |(capacity, runs): (&f64, &[FinishedRun])| {
        let cells = runs.iter().map(|ran| format!("{:.3} / {:.2}", ran.measures.chan, ran.measures.reach));
        std::iter::once(format!("K_c {capacity}")).chain(cells).collect()
    };
    Measured {
        header: std::iter::once("`chan` / `reach`".to_owned()).chain(strengths).collect(),
        rows: CAPACITIES.iter().zip(runs.chunks(STRENGTHS.len())).map(row).collect(),
        remarks: vec![MEANING.to_owned()],
    }
}

fn claims(runs: &[FinishedRun], water: &FinishedRun) -> Vec<Claim> {
    let by_capacity: Vec<&[FinishedRun]> = runs.chunks(STRENGTHS.len()).collect();
    let networks: Vec<&FinishedRun> = runs.iter().filter(|ran| ran.is_network(water)).collect();
    let names = networks.iter().map(|ran| format!("({})", ran.run.name)).collect::<Vec<_>>();
    let most = |column: usize| by_capacity.iter().map(|row| row[column].measures.chan).fold(0.0, f64::max);
    let weakest = most(0);
    let strongest = most(STRENGTHS.len() - 1);
    let best = (0..STRENGTHS.len()).map(most).fold(0.0, f64::max);
    let longest = by_capacity.iter().map(|row| row[STRENGTHS.len() - 1].measures.reach).fold(0.0, f64::max);
    vec![
        Claim::new(
            "There are K_c and K_v at which networks form",
            Verdict::of(!networks.is_empty() && networks.len() < runs.len()),
            format!("{}; {RULE}, here {:.4}", names.join(", "), water.measures.chan),
        ),
        Claim::new(
            "With too small a K_v forms come slowly",
            Verdict::of(weakest < 2.0 * water.measures.chan && weakest < 0.6 * most(2)),
            format!(
                "`chan` is at most {weakest:.3} at K_v 0.0003 after {} steps, {:.3} at 0.003",
                water.run.iterations,
                most(2)
            ),
        ),
        Claim::new(
            "With too large a K_v only short gullies form",
            Verdict::of(strongest < 0.1 * best),
            format!(
                "`chan` is at most {strongest:.4} and `reach` at most {longest:.2} at K_v 0.1; the best \
                 `chan` is {best:.4}"
            ),
        ),
    ]
}
