//! The scheme as printed, in which a wet cell gives more water than it has.

use super::han::{self, FinishedRun, MEANING, RULE, Run, header, row};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Verdict, texts, views};
use weald_core::error::Error;

pub(super) const FIGURE: Figure = Figure {
    id: "printed",
    title: "The scheme as printed",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, equations 4 to 9",
    shows: "As printed, flux starts by differences in level and is stopped only where a cell is dry, so that depths go \
            below zero. Weald scales fluxes to the water there is.",
    seconds: 8,
    make: Make::Alone(make),
};

/// Name and keys of each variant of the printed scheme.
const VARIANTS: [(&str, &str); 6] = [
    ("as printed, k 0.4", "flow_rate = 0.4"),
    ("as printed, k 0.2", "flow_rate = 0.2"),
    ("as printed, k 0.05", "flow_rate = 0.05"),
    ("as printed, k 0.01", "flow_rate = 0.01"),
    ("as printed, k 0.2, E 0.015", "flow_rate = 0.2\nevaporation = 0.015"),
    ("as printed, k 0.05, E 0.015", "flow_rate = 0.05\nevaporation = 0.015"),
];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let as_printed = |(name, keys): (&str, &str)| Run::new(job, name, &format!("{keys}\nlimiter = false"));
    let limited = Run::new(job, "limited, k 0.4", "");
    let water = Run::new(job, "water only, limited", "erosion = 0.0");
    let runs = han::run_all(&[vec![water, limited], VARIANTS.map(as_printed).to_vec()].concat())?;
    let drawn = [&runs[1..3], &runs[4..5]].concat();
    let width = job.choose(480, 32);
    let flow = views::sheet(&drawn, 3, |landscape| views::flow(landscape, width))?;
    let relief = views::sheet(&drawn, 3, |landscape| views::relief(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", &drawn, relief),
            views::plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                &drawn,
                flow,
            ),
        ],
        measured: measured(&runs)?,
        claims: claims(&runs),
        ..FigureOutput::default()
    })
}

fn measured(runs: &[FinishedRun]) -> Result<Measured, Error> {
    let row = |ran: &FinishedRun| -> Result<Vec<String>, Error> {
        let water = ran.landscape.field("water")?;
        let (lowest, _) = water.range(None).unwrap_or((0.0, 0.0));
        let share = |of: &dyn Fn(f32) -> bool| {
            let cells = water.values().iter().filter(|&&depth| of(depth)).count();
            format!("{:.0} %", 100.0 * cells as f64 / water.size().cells() as f64)
        };
        let more = [format!("{lowest:.2}"), share(&|depth| depth < -1e-6), share(&|depth| depth > 0.5)];
        Ok([row(ran), more.to_vec()].concat())
    };
    Ok(Measured {
        header: [header(), texts(["least depth", "below zero", "flooded"])].concat(),
        rows: runs.iter().map(row).collect::<Result<_, _>>()?,
        remarks: texts([
            MEANING,
            "Least depth of water in cells; shares of the cells whose depth is below zero, and above half a cell.",
        ]),
    })
}

fn claims(runs: &[FinishedRun]) -> Vec<Claim> {
    let (water, limited, printed) = (&runs[0], &runs[1], &runs[2..]);
    let networks: Vec<&str> =
        printed.iter().filter(|ran| ran.is_network(water)).map(|ran| ran.run.name.as_str()).collect();
    let best = printed.iter().map(|ran| ran.measures.chan).fold(0.0, f64::max);
    vec![Claim::new(
        "The scheme as printed forms networks of rivers",
        Verdict::under(&networks.join("; "), !networks.is_empty(), networks.len() == printed.len()),
        format!(
            "{} of {} runs as printed are networks, with `chan` of at most {best:.4}; with fluxes scaled to the water \
             there is it is {:.4}; {RULE}, here {:.4}",
            networks.len(),
            printed.len(),
            limited.measures.chan,
            water.measures.chan
        ),
    )]
}
