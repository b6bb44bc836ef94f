//! Every process, and the grounds that all engines run them on.

use weald::erode::hydraulic::{Boundary, Hydraulic, Model, Slope, Transport, UptakeLaw};
use weald::erode::thermal::Scheme;
use weald::erode::thermal_step::ThermalWithin;
use weald::grid::Mask;
use weald::recipe::parameter::{LayerName, Nested};
use weald::step::Step;
use weald::{Landscape, Size};

use crate::common::{self, layered, metres, rough, spring, with};

const COLUMNS: usize = 70;
const ROWS: usize = 90;

/// No multiple of the steps of a time block.
const STEPS: u32 = 21;

/// Seasons so short that two of them pass, and that some steps count into the means, which go through the ground one
/// at a time, and others do not, which go several at once.
fn with_short_seasons(step: Hydraulic) -> Hydraulic {
    with!(Hydraulic { rain_period: 4, ..step }, [Han Mei Stava] { dry_period: 3 })
}

fn hydraulic(iterations: u32) -> Hydraulic {
    with_short_seasons(common::hydraulic(iterations))
}

fn mei(iterations: u32) -> Hydraulic {
    with_short_seasons(common::mei(iterations))
}

fn stava(iterations: u32) -> Hydraulic {
    with_short_seasons(common::stava(iterations))
}

/// Every process in every variant that has code of its own: those that run alone, and the models of water.
pub(crate) fn processes() -> Vec<Box<dyn Step>> {
    let mut all = weald::erode::processes();
    let schemes = [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric];
    for model in [hydraulic(STEPS), mei(STEPS)] {
        for transport in [Transport::Upwind, Transport::SemiLagrangian, Transport::MacCormack] {
            for boundary in [Boundary::Closed, Boundary::Open] {
                let step = with!(model.clone(), [Han Mei] { transport: transport });
                all.push(Box::new(Hydraulic { boundary, ..step }));
            }
        }
        for boundary in [Boundary::Closed, Boundary::Open] {
            let transport = Transport::MacCormack;
            let step = with!(model.clone(), [Han Mei] { transport: transport, conserve: false });
            all.push(Box::new(Hydraulic { boundary, ..step }));
        }
        for scheme in schemes {
            let thermal = Some(Nested(ThermalWithin { scheme, talus: 0.3, ..ThermalWithin::default() }));
            let step = with!(model.clone(), [Han Mei] { thermal: thermal, deposit_ratio: 0.3 });
            all.push(Box::new(step));
        }
        all.push(Box::new(with!(model, [Han Mei] { limiter: false, flow_rate: 0.05 })));
    }
    all.push(Box::new(with!(hydraulic(STEPS), [Han] { law: UptakeLaw::Dissolution })));
    for boundary in [Boundary::Closed, Boundary::Open] {
        let step = with!(mei(STEPS), [Mei] { slope: Slope::Central });
        all.push(Box::new(Hydraulic { boundary, ..step }));
    }
    all.push(Box::new(Hydraulic { region: Some(LayerName::of("painted")), ..hydraulic(STEPS) }));
    all.extend(processes_of_stava());
    all
}

/// All of stava, each of its processes alone, and each transport.
fn processes_of_stava() -> Vec<Box<dyn Step>> {
    // Heavy rain and few steps: these are many, and something must move.
    let stava = with!(stava(15), [Stava] { rain: metres(0.05) });
    let Model::Stava(all_of_it) = stava.model.clone() else { unreachable!("it is Stava's") };
    let alone = with!(stava.clone(), [Stava] { dissolution: None, slippage: None, viscosity: 0.0 });
    let slipping = with!(alone.clone(), [Stava] { slippage: all_of_it.slippage });
    let painted = Some(LayerName::of("painted"));
    let (rain_layer, region) = (painted.clone(), painted);
    let mut all = vec![
        stava.clone(),
        Hydraulic { boundary: Boundary::Open, ..stava.clone() },
        Hydraulic { region, ..stava.clone() },
        alone.clone(),
        with!(alone.clone(), [Stava] { viscosity: 0.7 }),
        with!(alone.clone(), [Stava] { dissolution: all_of_it.dissolution }),
        Hydraulic { boundary: Boundary::Open, ..slipping },
        with!(alone, [Stava] {
            rain_layer: rain_layer,
            sources: vec![spring(12.0, 30.0)],
            drains: vec![spring(50.0, 20.0)],
        }),
    ];
    for transport in [Transport::Upwind, Transport::SemiLagrangian] {
        for viscosity in [0.0, 0.7] {
            all.push(with!(stava.clone(), [Stava] { transport: transport, viscosity: viscosity }));
        }
    }
    all.into_iter().map(|step| -> Box<dyn Step> { Box::new(step) }).collect()
}

/// Each model once, with thermal weathering or all of its processes.
pub(crate) fn whole_models() -> Vec<Box<dyn Step>> {
    let thermal = Some(Nested(ThermalWithin { talus: 0.3, ..ThermalWithin::default() }));
    let han = with!(hydraulic(STEPS), [Han] { thermal: thermal.clone() });
    let mei = with!(mei(STEPS), [Mei] { thermal: thermal });
    let stava = with!(stava(STEPS), [Stava] { rain: metres(0.05) });
    vec![Box::new(han), Box::new(mei), Box::new(stava)]
}

/// Rough ground of three materials.
pub(crate) fn whole() -> Landscape {
    layered(rough(COLUMNS, ROWS, 25.0, 3))
}

/// The same with cells that hold no data.
pub(crate) fn masked() -> Landscape {
    let mut masked = whole();
    let size = Size::new(COLUMNS, ROWS).expect("small");
    let valid = (0..size.cells()).map(|at| at % 31 != 7 && at % COLUMNS > 3).collect();
    masked.domain.valid = Mask::new(size, valid);
    masked
}

/// Wide ground.
pub(crate) fn wide() -> Landscape {
    layered(rough(1000, 40, 25.0, 5))
}
