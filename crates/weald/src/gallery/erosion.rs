//! Rivers by velocity-dependent erosion, without and with thermal weathering; and dissolution alone, which
//! makes none.

use super::start::start_terrain;
use super::{Figure, FigureOutput, GalleryJob, Measured, Plate, run_steps};
use crate::analyse::network::{NetworkInput, NetworkMeasures, measure};
use crate::error::Error;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::picture::{Image, Map, Picture, Relief, Scale};
use crate::recipe::parameter::LayerName;

pub(super) const WEATHERING: Figure = Figure {
    id: "erosion",
    title: "Rivers, without and with thermal weathering",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Figs. 5 and 6",
    shows: "Erosion that depends on the velocity of water cuts a network of channels; thermal weathering opens \
            them into V-shaped valleys with mountains between.",
    make: weathering,
};

pub(super) const DISSOLUTION: Figure = Figure {
    id: "dissolution",
    title: "Dissolution alone",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 8, after Mei, Decaudin and Hu 2007, doi 10.1109/PG.2007.15",
    shows: "Erosion that only fills water up to its capacity does not form rivers. This holds where dissolution \
            is fast; slow dissolution depends on discharge again and does form them.",
    make: dissolution,
};

/// Rain a step while it rains, and the periods of rain and of evaporation in steps: the defaults of the
/// method, stated here because the measures divide by the mean rain.
const RAIN: f64 = 0.01;
const PERIOD: u32 = 60;

/// One run of a figure: its name on the page and the keys it adds to the method's defaults.
struct Run {
    name: &'static str,
    keys: &'static str,
}

fn weathering(job: GalleryJob) -> Result<FigureOutput, Error> {
    let runs = [
        Run { name: "water only", keys: "erosion = 0.0" },
        Run { name: "erosion", keys: "" },
        Run {
            name: "erosion and weathering",
            keys: "thermal = { scheme = \"isotropic\", talus = 0.8, strength = 0.05 }",
        },
    ];
    make(job, &runs)
}

fn dissolution(job: GalleryJob) -> Result<FigureOutput, Error> {
    let runs = [
        Run { name: "fast dissolution, 0.1", keys: "law = \"dissolution\"\ncapacity = 1.0\nerosion = 0.1" },
        Run { name: "slow dissolution, 0.01", keys: "law = \"dissolution\"\ncapacity = 1.0\nerosion = 0.01" },
    ];
    make(job, &runs)
}

fn make(job: GalleryJob, runs: &[Run]) -> Result<FigureOutput, Error> {
    let (side, iterations) = job.choose((256, 3600), (32, 120));
    let (mut reliefs, mut flows, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    for run in runs {
        let landscape = erode(side, iterations, run)?;
        reliefs
            .push(Relief { width: Some(640), contours: Some(0.0), ..Relief::default() }.render(&landscape)?);
        flows.push(flow_map(&landscape)?);
        rows.push(row(run.name, &network(&landscape)?));
    }
    let names = runs.iter().map(|run| run.name).collect::<Vec<_>>().join("; ");
    let plate = |name, what: &str, images: &[Image]| Plate {
        name,
        caption: format!("{what} after {iterations} steps: {names}"),
        image: Image::beside(images, 10),
    };
    Ok(FigureOutput {
        plates: vec![plate("relief", "Ground and water", &reliefs), plate("flow", "Mean discharge", &flows)],
        measured: Measured { header: header(), rows, remarks: vec![MEANING.to_owned()] },
    })
}

fn erode(side: usize, iterations: u32, run: &Run) -> Result<Landscape, Error> {
    let mut landscape = start_terrain(side)?;
    let keys = format!(
        "model = \"han\"\niterations = {iterations}\nrain = {RAIN:?}\nrain_period = {PERIOD}\ndry_period = {PERIOD}\n{}",
        run.keys
    );
    run_steps(&mut landscape, 0, &[("hydraulic", &keys)])?;
    Ok(landscape)
}

fn network(landscape: &Landscape) -> Result<NetworkMeasures, Error> {
    Ok(measure(&NetworkInput {
        ground: landscape.field("height")?,
        depth: landscape.field("water")?,
        mean_flux_x: landscape.field("flux_x")?,
        mean_flux_y: landscape.field("flux_y")?,
        mean_rain: RAIN / 2.0,
        cell: landscape.domain.cell,
    }))
}

/// Mean discharge on a logarithmic scale.
fn flow_map(landscape: &Landscape) -> Result<Image, Error> {
    let (x, y) = (landscape.field("flux_x")?, landscape.field("flux_y")?);
    let strength = |(&x, &y): (&f32, &f32)| (x * x + y * y).sqrt();
    let flow = x.values().iter().zip(y.values()).map(strength).collect();
    let mut only = Landscape::new(landscape.domain.clone());
    only.insert("flow", "m³/step", Field::from_values(x.size(), flow));
    let (low, high) = (Some(RAIN), Some(RAIN * 5000.0));
    Map {
        of: LayerName::of("flow"),
        width: Some(512),
        ramp: Scale::Water,
        logarithmic: true,
        low,
        high,
        legend: false,
    }
    .render(&only)
}

fn header() -> Vec<String> {
    ["run", "chan", "reach", "drains", "pits"].map(str::to_owned).to_vec()
}

const MEANING: &str = "`chan`: share of cells that carry the runoff of 100 cells or more. `reach`: length of the \
    longest connected valley over the side. `drains`: share of the land from which water reaches a lake or the \
    border without crossing a pit deeper than half a cell. `pits`: cells without a lower neighbour.";

fn row(name: &str, measures: &NetworkMeasures) -> Vec<String> {
    let NetworkMeasures { chan, reach, drains, pits, .. } = *measures;
    vec![
        name.to_owned(),
        format!("{chan:.4}"),
        format!("{reach:.2}"),
        format!("{drains:.2}"),
        pits.to_string(),
    ]
}
