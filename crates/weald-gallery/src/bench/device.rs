//! Rates of the simulations on a device, beside the rate at which it could carry the bytes of their passes.

use std::fmt::Display;
use std::sync::Arc;

use super::rate::{Baseline, RUNS, Rate};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::Nested;
use weald_engine::Engine;
use weald_engine::device::Device;
use weald_engine::device_machine::most_cells;
use weald_engine::generator::Generator;
use weald_land::erode::dissolution_step::DissolutionWithin;
use weald_land::erode::hydraulic::{HanKeys, Hydraulic, MeiKeys, StavaKeys};
use weald_land::erode::slippage_step::SlippageWithin;
use weald_land::erode::thermal_step::ThermalWithin;
use weald_land::generate::diamond_square::DiamondSquare;

/// Seconds that one run should take: some submissions.
const SECONDS: f64 = 0.5;

/// Steps of the first run that tells how many steps take that long, and most steps of a run.
const STEPS: [u32; 2] = [4, 5000];

/// Metres of each material above the bedrock.
const THICKNESS: f64 = 2.0;

/// Measures every model at each size; `report` is called with each rate as it is known, and each size that the device's
/// memory does not hold whole. `bandwidth` is what the device reads and writes while it copies, in bytes per
/// second.
///
/// # Errors
/// [`Error::Limit`] for sizes that no grid may have, [`Error::Device`] where the device fails.
pub fn run_on(
    device: &Arc<dyn Device>,
    bandwidth: f64,
    sides: &[usize],
    report: &mut dyn FnMut(&dyn Display),
) -> Result<(), Error> {
    for &side in sides {
        let landscape = landscape(Size::square(side)?)?;
        for (name, step) in contenders() {
            match rate(name, &step, &landscape, (device, bandwidth))? {
                Some(rate) => report(&rate),
                None => report(&format!("{name:<24} {side} × {side} takes more than the GPU memory")),
            }
        }
    }
    Ok(())
}

fn contenders() -> [(&'static str, Hydraulic); 4] {
    let han = Hydraulic::default();
    let mei = Hydraulic { model: MeiKeys::default().into(), ..han.clone() };
    let layered = StavaKeys {
        dissolution: Some(Nested(DissolutionWithin::default())),
        slippage: Some(Nested(SlippageWithin::default())),
        ..StavaKeys::default()
    };
    let stava = Hydraulic { model: layered.into(), ..han.clone() };
    let thermal = Some(Nested(ThermalWithin::default()));
    let sliding = HanKeys { thermal, ..HanKeys::default() };
    [
        ("han", han.clone()),
        ("han with thermal", Hydraulic { model: sliding.into(), ..han }),
        ("mei", mei),
        ("stava, four materials", stava),
    ]
}

/// Rough ground of four materials.
fn landscape(size: Size) -> Result<Landscape, Error> {
    let mut landscape = Landscape::new(Domain::new(size, 1.0));
    let ground = DiamondSquare { relief: size.columns as f64 / 5.0, ..DiamondSquare::default() };
    landscape.insert("height", "m", ground.fill(&landscape.domain, 7)?);
    let materials = ["rock", "clay", "soil", "sand"].into_iter().filter_map(Material::built_in);
    landscape.materials = materials.map(|material| Material { thickness: THICKNESS, ..material }).collect();
    Ok(landscape)
}

/// The rate of a model, where the device holds it whole.
fn rate(
    name: &str,
    step: &Hydraulic,
    landscape: &Landscape,
    (device, bandwidth): (&Arc<dyn Device>, f64),
) -> Result<Option<Rate>, Error> {
    let (size, program) = (landscape.domain.size, step.program(landscape)?);
    if size.cells() as u64 > most_cells(&program, &**device) {
        return Ok(None);
    }
    let engine = Engine::Device(Arc::clone(device));
    let seconds_of = |iterations| Hydraulic { iterations, ..step.clone() }.seconds(landscape, &engine);
    let iterations = enough(seconds_of)?;
    let mut seconds = f64::INFINITY;
    for _ in 0..RUNS {
        seconds = seconds.min(seconds_of(iterations)? / f64::from(iterations));
    }
    let millions = size.cells() as f64 / seconds / 1e6;
    let beside = Baseline::Copies { bytes: program.bytes_per_cell_step(), bandwidth };
    Ok(Some(Rate { name: name.to_owned(), size, threads: None, millions, beside }))
}

/// Steps of a run that takes long enough. A device's submissions begin small and grow, so that a few steps tell too
/// little of many: each run tells of one at most so many times as long.
fn enough(seconds_of: impl Fn(u32) -> Result<f64, Error>) -> Result<u32, Error> {
    const GROWTH: f64 = 8.0;
    let [few, most] = STEPS;
    let mut iterations = few;
    loop {
        let wanted = SECONDS / seconds_of(iterations)?;
        if wanted < 2.0 || iterations == most {
            return Ok(iterations);
        }
        iterations = ((f64::from(iterations) * wanted.min(GROWTH)) as u32).min(most);
    }
}
