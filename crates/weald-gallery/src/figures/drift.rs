//! Soil that transport by velocity makes or loses.

use super::ground::{SEED, start_terrain};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts, views};
use weald::recipe::run_steps;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

pub(super) const FIGURE: Figure = Figure {
    id: "drift",
    title: "Soil that is lost on the way",
    source: "Mei, Decaudin and Hu 2007, doi 10.1109/PG.2007.15, as cited by Han 2015",
    shows: "Sediment that is looked up where the flow came from is counted twice or not at all, so soil is not \
            conserved. Sediment that goes with the fluxes of the water is.",
    seconds: 4,
    make: Make::Alone(make),
};

/// Name and keys of each way of transport.
const VARIANTS: [(&str, &str); 3] = [
    ("semi-Lagrangian, as published", "transport = \"semi-lagrangian\""),
    ("MacCormack", "transport = \"maccormack\"\nconserve = false"),
    ("upwind fluxes", "transport = \"upwind\""),
];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (side, iterations) = job.choose((128, 3000), (32, 120));
    let start = start_terrain(side, SEED)?;
    let before = start.field("height")?;
    let run = |(_, keys): (&str, &str)| -> Result<Landscape, Error> {
        let mut landscape = start.clone();
        let keys = format!("model = \"mei\"\ncapacity = 0.01\niterations = {iterations}\n{keys}");
        run_steps(&mut landscape, 0, &[("hydraulic", &keys)])?;
        Ok(landscape)
    };
    let lands = VARIANTS.map(run).into_iter().collect::<Result<Vec<_>, _>>()?;
    let soils = lands.iter().map(|land| Soil::of(land, before)).collect::<Result<Vec<_>, _>>()?;
    let width = job.choose(480, 32);
    let titled = |(name, _): (&str, &str), land| Ok(views::relief(land, width)?.titled(name));
    let images = VARIANTS.into_iter().zip(&lands).map(|(variant, land)| titled(variant, land));
    let images = images.collect::<Result<Vec<_>, Error>>()?;
    let names = VARIANTS.map(|(name, _)| name);
    let caption = format!("Ground and water after {iterations} steps: {}", names.join("; "));
    Ok(FigureOutput {
        plates: vec![Plate { name: "relief", caption, image: views::laid_out(&images, 3) }],
        measured: Measured {
            header: texts(["transport", "soil made or lost", "mean change", "share of it"]),
            rows: names.iter().zip(&soils).map(|(name, soil)| soil.row(name)).collect(),
            remarks: texts([
                "In cells of height over the whole ground. Made or lost: what lies on the ground and is \
                 carried, less what was there before; all edges are closed. Mean change: of the ground, up \
                 or down.",
            ]),
        },
        claims: claims(&soils),
        ..FigureOutput::default()
    })
}

/// Where the soil went, in cells of height over the whole ground.
struct Soil {
    made: f64,
    changed: f64,
}

impl Soil {
    fn of(landscape: &Landscape, before: &Field) -> Result<Self, Error> {
        let (height, sediment) = (landscape.field("height")?, landscape.field("sediment")?);
        let cells = before.size().cells() as f64;
        let change = |(&after, &before): (&f32, &f32)| f64::from(after) - f64::from(before);
        let changes = || height.values().iter().zip(before.values()).map(change);
        Ok(Self {
            made: (changes().sum::<f64>() + sediment.sum()) / cells,
            changed: changes().map(f64::abs).sum::<f64>() / cells,
        })
    }

    fn share(&self) -> f64 {
        self.made.abs() / self.changed
    }

    fn row(&self, name: &str) -> Vec<String> {
        vec![
            name.to_owned(),
            signed(self.made),
            format!("{:.3}", self.changed),
            format!("{:.2} %", 100.0 * self.share()),
        ]
    }
}

/// With its sign, unless it rounds to 0.
fn signed(number: f64) -> String {
    if number.abs() < 5e-6 { "0".to_owned() } else { format!("{number:+.3}") }
}

fn claims(soils: &[Soil]) -> Vec<Claim> {
    let [published, _, fluxes] = [&soils[0], &soils[1], &soils[2]];
    vec![
        Claim::new(
            "Semi-Lagrangian transport does not conserve soil",
            Verdict::of(published.share() > 0.01),
            format!("it amounts to {:.1} % of what the ground changed by", 100.0 * published.share()),
        ),
        Claim::new(
            "Transport with the fluxes does",
            Verdict::of(fluxes.changed > 0.0 && fluxes.share() < 1e-3),
            format!("{:.4} %", 100.0 * fluxes.share()),
        ),
    ]
}
