//! The same landscapes young and old.

use super::han::{self, FinishedRun, Run, weathered};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts, views};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_picture::Image;

pub(super) const FIGURE: Figure = Figure {
    id: "ages",
    title: "A longer run",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 7",
    shows: "The longer the simulation runs, the wider the rivers, and the simpler their tributaries.",
    seconds: 32,
    make: Make::Alone(make),
};

/// Those of the first two are drawn; what all four show decides.
const SEEDS: [u64; 4] = [3, 7, 11, 19];
const DRAWN: usize = 2;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let ages = job.choose([2400, 4800, 9600], [120, 240, 480]);
    let keys = format!("deposit_ratio = 0.3\n{}", weathered(0.8));
    let run = |iterations: u32| Run { iterations, ..Run::new(job, &format!("{iterations} steps"), &keys) };
    // Row by row of the picture: all ages of a seed.
    let runs: Vec<Run> = SEEDS.iter().flat_map(|&seed| ages.map(|age| Run { seed, ..run(age) })).collect();
    let runs = han::run_all(&runs)?;
    let width = job.choose(380, 32);
    let plate =
        |name, what: &str, draw: fn(&Landscape, u32) -> Result<Image, Error>| -> Result<Plate, Error> {
            let [young, middle, old] = ages;
            let caption = format!("{what} after {young}, {middle} and {old} steps; seed 3 above, 7 below");
            let drawn = &runs[..DRAWN * ages.len()];
            let image = views::sheet(drawn, ages.len(), |landscape| draw(landscape, width))?;
            Ok(Plate { name, caption, image })
        };
    Ok(FigureOutput {
        plates: vec![
            plate("relief", "Ground and water", views::relief)?,
            plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                views::flow,
            )?,
        ],
        measured: Measured {
            header: texts(["run", "seed", "channel heads", "river width", "valley width", "valley spacing"]),
            rows: runs.iter().map(row).collect(),
            remarks: texts([
                "Heads: where on the flooded ground 100 cells begin to drain through one. Rivers: cells \
                 outside lakes that carry the runoff of 100 cells or more; their area over their length. \
                 Valleys as rows and columns of the grid cut them, where they are a cell deep or more: \
                 mean width at half the depth, and length of line a valley. All in cells.",
            ]),
        },
        claims: claims(&runs, ages.len()),
        ..FigureOutput::default()
    })
}

/// Spacing and width of the valleys in cells; 0 where there are none.
fn form(ran: &FinishedRun) -> [f64; 2] {
    ran.measures.valleys.map_or([0.0; 2], |form| [form.spacing, form.width])
}

/// Width of the rivers in cells; 0 where there are none.
fn river(ran: &FinishedRun) -> f64 {
    ran.measures.river_width.unwrap_or(0.0)
}

fn row(ran: &FinishedRun) -> Vec<String> {
    let [spacing, width] = form(ran);
    vec![
        ran.run.name.clone(),
        ran.run.seed.to_string(),
        ran.measures.heads.to_string(),
        format!("{:.2}", river(ran)),
        format!("{width:.1}"),
        format!("{spacing:.1}"),
    ]
}

fn claims(runs: &[FinishedRun], ages: usize) -> Vec<Claim> {
    let seeds: Vec<&[FinishedRun]> = runs.chunks(ages).collect();
    let rows = |number: &dyn Fn(&FinishedRun) -> String| {
        let row = |runs: &&[FinishedRun]| runs.iter().map(number).collect::<Vec<_>>().join(" → ");
        seeds.iter().map(row).collect::<Vec<_>>().join(" and ")
    };
    let young_and_old = || seeds.iter().map(|runs| [&runs[0], &runs[ages - 1]]);
    let valleys = young_and_old().all(|[young, old]| form(young)[1] < form(old)[1]);
    let rivers = young_and_old().all(|[young, old]| river(young) < river(old));
    let mut fewer = young_and_old().map(|[young, old]| young.measures.heads > old.measures.heads);
    let (always, sometimes) = (fewer.clone().all(|it| it), fewer.any(|it| it));
    vec![
        Claim::new(
            "The longer the run, the wider the rivers",
            Verdict::under("of valleys, not of the water in them", valleys, valleys && rivers),
            format!(
                "on the four seeds rivers are {} and valleys {} cells wide",
                rows(&|ran| format!("{:.2}", river(ran))),
                rows(&|ran| format!("{:.1}", form(ran)[1]))
            ),
        ),
        Claim::new(
            "The longer the run, the simpler the tributaries",
            Verdict::under("on some seeds, not on all", sometimes, always),
            format!("channel heads {} on the four seeds", rows(&|ran| ran.measures.heads.to_string())),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};
    use weald_land::analyse::network::ValleyForm;

    #[test]
    fn rivers_and_valleys_that_widen_and_heads_that_vanish_are_shown_and_others_are_not() {
        let flat = Field::filled(Size::square(2).expect("small"), 0.0);
        let aged = |river: f64, valley: f64, heads: usize| {
            let mut ran = han::finished(flat.clone());
            ran.measures.river_width = Some(river);
            ran.measures.valleys = Some(ValleyForm { spacing: 9.0, width: valley, shape: 0.5, depth: 4.0 });
            ran.measures.heads = heads;
            ran
        };
        let verdicts =
            |runs: [FinishedRun; 2]| claims(&runs, 2).into_iter().map(|claim| claim.verdict).collect();
        let found: Vec<_> = verdicts([aged(1.0, 3.0, 9), aged(2.0, 5.0, 4)]);
        assert_eq!(found, [Verdict::Shown, Verdict::Shown]);
        let found: Vec<_> = verdicts([aged(2.0, 3.0, 9), aged(2.0, 5.0, 9)]);
        assert_eq!(
            found,
            [Verdict::ShownIf("of valleys, not of the water in them".into()), Verdict::NotReproduced]
        );
    }
}
