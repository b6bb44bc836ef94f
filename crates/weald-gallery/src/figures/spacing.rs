//! How far apart valleys lie, by the angle at which ground rests.

use super::han::{self, FinishedRun, Run, weathered};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts, views};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "spacing",
    title: "Spacing of valleys by talus",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, on Fig. 6",
    shows: "The smaller the angle of repose, the wider apart the valleys: as if one had come nearer.",
    seconds: 7,
    make: Make::Alone(make),
};

const TALUS: [f64; 3] = [1.6, 0.8, 0.4];

const SEEDS: [u64; 2] = [3, 7];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |talus: f64| Run::new(job, &format!("talus {talus}"), &weathered(talus));
    // Row by row of the picture: all slopes of a seed.
    let runs: Vec<Run> = TALUS.iter().map(|&talus| run(talus)).collect();
    let runs: Vec<Run> =
        SEEDS.iter().flat_map(|&seed| runs.iter().flat_map(move |run| run.for_seeds(&[seed]))).collect();
    let runs = han::run_all(&runs)?;
    let (width, side, corner) = job.choose((420, 160, 48), (32, 16, 8));
    let image = views::sheet(&runs, TALUS.len(), |landscape| {
        views::bare(&views::part(landscape, [corner; 2], side)?, width)
    })?;
    let caption = format!(
        "The middle {side} × {side} cells after {} steps, with tan φ of 1.6, 0.8 and 0.4; seed 3 above, 7 \
         below",
        runs[0].run.iterations
    );
    Ok(FigureOutput {
        plates: vec![Plate { name: "relief", caption, image }],
        measured: Measured {
            header: texts(["run", "seed", "channel heads", "valley spacing", "valley width"]),
            rows: runs.iter().map(row).collect(),
            remarks: texts([
                "Heads: where on the flooded ground 100 cells begin to drain through one. Spacing: length \
                 of all rows and columns over the number of valleys a cell deep or more on them; width: at \
                 half their depth; in cells.",
            ]),
        },
        claims: claims(&runs),
        ..FigureOutput::default()
    })
}

/// Spacing and width of the valleys in cells; infinitely wide where there are none.
fn form(ran: &FinishedRun) -> [f64; 2] {
    ran.measures.valleys.map_or([f64::INFINITY; 2], |form| [form.spacing, form.width])
}

fn row(ran: &FinishedRun) -> Vec<String> {
    let [spacing, width] = form(ran);
    vec![
        ran.run.name.clone(),
        ran.run.seed.to_string(),
        ran.measures.heads.to_string(),
        format!("{spacing:.1}"),
        format!("{width:.1}"),
    ]
}

fn claims(runs: &[FinishedRun]) -> Vec<Claim> {
    let of_seeds = || runs.chunks(TALUS.len());
    let both = |number: &dyn Fn(&FinishedRun) -> String| {
        let row = |runs: &[FinishedRun]| runs.iter().map(number).collect::<Vec<_>>().join(" → ");
        of_seeds().map(row).collect::<Vec<_>>().join(" and ")
    };
    let widens =
        |runs: &[FinishedRun]| runs.is_sorted_by(|a, b| form(a)[0] < form(b)[0] && form(a)[1] < form(b)[1]);
    let heads = |ran: &FinishedRun| ran.measures.heads;
    let fewer = |runs: &[FinishedRun]| heads(&runs[TALUS.len() - 1]) < heads(&runs[0]);
    let step_by_step = |runs: &[FinishedRun]| runs.is_sorted_by(|a, b| heads(a) > heads(b));
    vec![
        Claim::new(
            "The smaller tan φ, the wider apart the valleys",
            Verdict::of(of_seeds().all(widens)),
            format!(
                "spacing {} cells for tan φ 1.6 → 0.8 → 0.4 on the two seeds",
                both(&|ran| format!("{:.1}", form(ran)[0]))
            ),
        ),
        Claim::new(
            "The smaller tan φ, the fewer channels",
            Verdict::under(
                "from tan φ 1.6 to 0.4, not step by step",
                of_seeds().all(fewer),
                of_seeds().all(step_by_step),
            ),
            format!("channel heads {} on the two seeds", both(&|ran| heads(ran).to_string())),
        ),
    ]
}
