//! Deposits that stand higher than the water they settled from, and the ratio that shrinks them.

use super::han::{self, FinishedRun, Run};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, texts, views};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "deposits",
    title: "Land in lakes, and the deposit ratio",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, section 3.3.4 and Fig. 7",
    shows: "At a large capacity water carries more sediment than its own volume; where it dries up the deposit stands \
            higher than the water did, and lakes become land. Deposits that shrink by a ratio r do not.",
    seconds: 4,
    make: Make::Alone(make),
};

const RATIOS: [f64; 3] = [1.0, 0.5, 0.2];

/// Water deeper than this, in cells, is a lake.
const LAKE_DEPTH: f32 = 0.5;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let run = |ratio: f64| Run::new(job, &format!("r = {ratio}"), &format!("deposit_ratio = {ratio:?}"));
    let water = Run::new(job, "water only", "erosion = 0.0");
    let runs = han::run_all(&[vec![water], RATIOS.map(run).to_vec()].concat())?;
    let width = job.choose(400, 32);
    let image = views::sheet(&runs, 4, |landscape| views::relief(landscape, width))?;
    let fills = runs.iter().map(|ran| Fill::of(ran, &runs[0])).collect::<Result<Vec<_>, _>>()?;
    Ok(FigureOutput {
        plates: vec![views::plate("relief", "Ground and water", &runs, image)],
        measured: Measured {
            header: texts(["run", "highest fill", "of lakes became land", "lakes left", "shrunk away"]),
            rows: runs.iter().zip(&fills).map(|(ran, fill)| fill.row(&ran.run.name)).collect(),
            remarks: texts([
                "Lakes are where water stands deeper than half a cell without erosion. Highest fill: how far their \
                 ground rose, in cells. Land: cells whose ground stands above the level that the lake had. Lakes left: \
                 cells with as deep water, in all. Shrunk away: solid that deposits lost, in cells of height over \
                 the whole ground.",
            ]),
        },
        claims: claims(&fills[1..]),
        ..FigureOutput::default()
    })
}

/// What became of the lakes.
struct Fill {
    highest: f32,
    /// Share of their cells that became land.
    land: f64,
    left: usize,
    shrunk: f64,
}

impl Fill {
    /// The lakes are those of `water`, which does not erode.
    fn of(ran: &FinishedRun, water: &FinishedRun) -> Result<Self, Error> {
        let (bottom, depth) = (water.ground().values(), water.landscape.field("water")?.values());
        let ground = ran.ground().values();
        let lake: Vec<usize> = (0..ground.len()).filter(|&cell| depth[cell] > LAKE_DEPTH).collect();
        let land = lake.iter().filter(|&&cell| ground[cell] > bottom[cell] + depth[cell]).count();
        let sediment = ran.landscape.field("sediment")?;
        let gone = ran.before.sum() - ran.ground().sum() - sediment.sum();
        let now = ran.landscape.field("water")?.values();
        Ok(Self {
            highest: lake.iter().map(|&cell| ground[cell] - bottom[cell]).fold(0.0, f32::max),
            land: land as f64 / lake.len().max(1) as f64,
            left: now.iter().filter(|&&depth| depth > LAKE_DEPTH).count(),
            shrunk: gone / ground.len() as f64,
        })
    }

    fn row(&self, name: &str) -> Vec<String> {
        vec![
            name.to_owned(),
            format!("{:.1}", self.highest),
            format!("{:.1} %", 100.0 * self.land),
            self.left.to_string(),
            format!("{:.2}", f64::max(self.shrunk, 0.0)),
        ]
    }
}

fn claims(fills: &[Fill]) -> Vec<Claim> {
    let [whole, least] = [&fills[0], &fills[fills.len() - 1]];
    let percent = |fill: &Fill| format!("{:.1} %", 100.0 * fill.land);
    vec![
        Claim::new(
            "With deposits of full volume lakes become land",
            Verdict::of(whole.land > 0.05),
            format!("{} of the lakes' cells, filled by up to {:.1} cells", percent(whole), whole.highest),
        ),
        Claim::new(
            "A deposit ratio r below 1 removes that land",
            Verdict::of(fills.is_sorted_by(|a, b| a.land > b.land) && least.land < 0.1 * whole.land),
            format!(
                "{} of the lakes' cells become land at r = 0.2; the highest fill is {:.1} cells",
                percent(least),
                least.highest
            ),
        ),
    ]
}
