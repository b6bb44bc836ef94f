//! One body runs every process on every engine: threads, bands and a resumed run give the same bits.

mod common;

use std::sync::Mutex;

use common::{hydraulic, landscape, layered, rough, run_on, spring, stava, worst_difference};
use weald::engine::{Engine, Job, SavedSimulation, Watcher};
use weald::erode::dissolution_step::DissolutionStep;
use weald::erode::hydraulic::{Boundary, Hydraulic, Model, Transport, UptakeLaw};
use weald::erode::slippage_step::SlippageStep;
use weald::erode::thermal::Scheme;
use weald::erode::thermal_step::{Thermal, ThermalWithin};
use weald::grid::Mask;
use weald::recipe::parameter::{LayerName, Nested};
use weald::step::{Outcome, Step};
use weald::{Error, Field, Landscape, Size};

const COLUMNS: usize = 70;
const ROWS: usize = 90;

/// Every process in every variant that has code of its own.
fn processes() -> Vec<Box<dyn Step>> {
    let mut all: Vec<Box<dyn Step>> = Vec::new();
    let schemes = [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric];
    for scheme in schemes {
        all.push(Box::new(Thermal {
            scheme,
            iterations: 43,
            talus: 0.3,
            strength: 0.2,
            ..Thermal::default()
        }));
    }
    for model in [Model::Han, Model::Mei] {
        for transport in [Transport::Upwind, Transport::SemiLagrangian, Transport::MacCormack] {
            for boundary in [Boundary::Closed, Boundary::Open] {
                all.push(Box::new(Hydraulic { model, transport, boundary, ..hydraulic(43) }));
            }
        }
        for boundary in [Boundary::Closed, Boundary::Open] {
            let transport = Transport::MacCormack;
            all.push(Box::new(Hydraulic {
                model,
                transport,
                conserve: Some(false),
                boundary,
                ..hydraulic(43)
            }));
        }
        for scheme in schemes {
            let thermal = Some(Nested(ThermalWithin { scheme, talus: 0.3, ..ThermalWithin::default() }));
            all.push(Box::new(Hydraulic { model, thermal, deposit_ratio: 0.3, ..hydraulic(43) }));
        }
        all.push(Box::new(Hydraulic { model, limiter: false, flow_rate: Some(0.05), ..hydraulic(43) }));
    }
    all.push(Box::new(Hydraulic { law: UptakeLaw::Dissolution, ..hydraulic(43) }));
    all.push(Box::new(Hydraulic { region: Some(LayerName::of("painted")), ..hydraulic(43) }));
    all.extend(processes_of_stava());
    all
}

/// All of stava, each of its processes alone, and each transport.
fn processes_of_stava() -> Vec<Box<dyn Step>> {
    // Heavy rain and few steps: these are many, and something must move.
    let stava = Hydraulic { rain: Some(0.05), ..stava(15) };
    let alone = Hydraulic { dissolution: None, slippage: None, viscosity: 0.0, ..stava.clone() };
    let painted = Some(LayerName::of("painted"));
    let (rain_layer, region) = (painted.clone(), painted);
    let mut all = vec![
        stava.clone(),
        Hydraulic { boundary: Boundary::Open, ..stava.clone() },
        Hydraulic { region, ..stava.clone() },
        alone.clone(),
        Hydraulic { viscosity: 0.7, ..alone.clone() },
        Hydraulic { dissolution: stava.dissolution.clone(), ..alone.clone() },
        Hydraulic { slippage: stava.slippage.clone(), boundary: Boundary::Open, ..alone.clone() },
        Hydraulic {
            rain_layer,
            sources: vec![spring(12.0, 30.0)],
            drains: vec![spring(50.0, 20.0)],
            ..alone
        },
    ];
    for transport in [Transport::SemiLagrangian, Transport::MacCormack] {
        for viscosity in [0.0, 0.7] {
            all.push(Hydraulic { transport, viscosity, ..stava.clone() });
        }
    }
    let mut all: Vec<Box<dyn Step>> =
        all.into_iter().map(|step| -> Box<dyn Step> { Box::new(step) }).collect();
    for softening in [false, true] {
        all.push(Box::new(SlippageStep {
            strength: 0.06,
            softening,
            iterations: 15,
            ..SlippageStep::default()
        }));
    }
    let water = LayerName::of("painted");
    all.push(Box::new(DissolutionStep { water, iterations: 15, ..DissolutionStep::default() }));
    all
}

/// Rough ground of three materials, with and without cells that hold no data, and wide ground.
fn grounds() -> [Landscape; 3] {
    let whole = layered(rough(COLUMNS, ROWS, 25.0, 3));
    let mut masked = whole.clone();
    let size = Size::new(COLUMNS, ROWS).expect("small");
    masked.domain.land =
        Mask::new(size, (0..size.cells()).map(|at| at % 31 != 7 && at % COLUMNS > 3).collect());
    [whole, masked, layered(rough(1000, 40, 25.0, 5))]
}

fn assert_same_bits(step: &dyn Step, expected: &Landscape, got: &Landscape, engine: &str) {
    for ((name, expected), (_, got)) in expected.layers().zip(got.layers()) {
        let same =
            expected.field.values().iter().zip(got.field.values()).all(|(a, b)| a.to_bits() == b.to_bits());
        let worst = worst_difference(&expected.field, &got.field);
        assert!(same, "{engine}: `{name}` differs by up to {worst}: {step:?}");
    }
}

/// Tiles add the same numbers in another order, in 64 bits.
fn assert_same_budget(expected: &Outcome, got: &Outcome) {
    let (Some(expected), Some(got)) = (expected.budget, got.budget) else {
        panic!("a simulation has a budget")
    };
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs().max(1.0);
    assert!(near(expected.water.incoming, got.water.incoming), "{expected:?} {got:?}");
    assert!(near(expected.water.outgoing, got.water.outgoing), "{expected:?} {got:?}");
    assert!(near(expected.solid.outgoing, got.solid.outgoing), "{expected:?} {got:?}");
    assert_eq!(expected.water.stored, got.water.stored);
    assert_eq!(expected.solid.ground, got.solid.ground);
}

#[test]
fn threads_bands_and_tiles_give_the_same_bits_for_every_process() {
    for step in processes() {
        for ground in grounds() {
            let on_threads = |threads: usize, engine| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                let mut land = ground.clone();
                let outcome = pool.install(|| run_on(&*step, &mut land, engine));
                (land, outcome)
            };
            let (expected, outcome) = on_threads(1, Engine::Cpu);
            let moved =
                worst_difference(ground.field("height").expect("h"), expected.field("height").expect("h"));
            assert!(moved > 1e-4, "nothing moved, so agreement would mean nothing: {moved} m, {step:?}");
            for threads in [2, 3] {
                let (got, same) = on_threads(threads, Engine::Cpu);
                assert_same_bits(&*step, &expected, &got, &format!("{threads} threads"));
                assert_eq!(outcome, same, "{threads} threads: {step:?}");
            }
            for bands in [1, 2, 3, 7] {
                let (got, same) = on_threads(2, Engine::Bands(bands));
                assert_same_bits(&*step, &expected, &got, &format!("{bands} bands"));
                assert_eq!(outcome, same, "{bands} bands: {step:?}");
            }
            for (columns, rows) in [(37, 41), (1000, 17)] {
                let size = Size::new(columns, rows).expect("small");
                let (got, same) = on_threads(2, Engine::Tiles(size));
                assert_same_bits(&*step, &expected, &got, &format!("{columns} x {rows} tiles"));
                assert_same_budget(&outcome, &same);
            }
        }
    }
}

/// Stops the simulation at its first look, and keeps what it saved.
#[derive(Default)]
struct Stopper {
    saved: Mutex<Option<SavedSimulation>>,
}

impl Watcher for Stopper {
    fn cancelled(&self) -> bool {
        true
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        *self.saved.lock().expect("one thread") = Some(state.clone());
        Ok(())
    }
}

#[test]
fn a_stopped_and_resumed_run_ends_with_the_same_bits() {
    for model in [hydraulic(600), Hydraulic { model: Model::Mei, ..hydraulic(600) }, stava(600)] {
        // Longer than the 256 steps between two looks, and stopped within the steps that means are taken of.
        let step = Hydraulic { rain_period: 400, dry_period: Some(100), ..model };
        let start = layered(rough(48, 40, 20.0, 8));
        let mut whole = start.clone();
        let outcome = run_on(&step, &mut whole, Engine::Cpu);
        let stopper = Stopper::default();
        let job = Job { seed: 7, engine: Engine::Cpu, watcher: &stopper, resume: None };
        let stopped = step.run(&mut start.clone(), &job).expect_err("it was stopped");
        assert!(matches!(stopped, Error::Interrupted(_)), "{stopped}");
        let saved = stopper.saved.lock().expect("one thread").take().expect("a state was saved");
        assert!((1..600).contains(&saved.iteration), "stopped on the way: {}", saved.iteration);
        let mut resumed = start.clone();
        let job = Job {
            seed: 7,
            engine: Engine::Bands(3),
            watcher: &weald::engine::Unwatched,
            resume: Some(saved),
        };
        let again = step.run(&mut resumed, &job).expect("it goes on");
        assert_same_bits(&step, &whole, &resumed, "resumed");
        assert_eq!(outcome, again);
    }
}

#[test]
fn a_wide_landscape_gives_the_bits_of_a_tall_one_turned() {
    for model in [Model::Han, Model::Mei, Model::Stava] {
        let step = if model == Model::Stava { stava(60) } else { Hydraulic { model, ..hydraulic(60) } };
        let ground = rough(1300, 40, 30.0, 6);
        let turned = |field: &Field| {
            let Size { columns, rows } = field.size();
            Field::from_function(Size { columns: rows, rows: columns }, |x, y| field.at(y, x))
        };
        let (mut wide, mut tall) = (landscape(ground.clone()), landscape(turned(&ground)));
        run_on(&step, &mut wide, Engine::Cpu);
        run_on(&step, &mut tall, Engine::Cpu);
        let height = wide.field("height").expect("h");
        assert!(worst_difference(&ground, height) > 0.01, "something moved");
        assert_eq!(height, &turned(tall.field("height").expect("h")), "{model:?}");
    }
}
