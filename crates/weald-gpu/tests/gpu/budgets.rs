//! A device loses nothing either: over thousands of steps budgets of water and solid close as on the CPU.

use std::sync::Arc;

use crate::common::{
    error_of_what_moved, field, hydraulic, landscape, layered, mei, rough, run_on, spring, stava, with,
};
use weald::Landscape;
use weald::engine::{Budget, Engine};
use weald::erode::hydraulic::{Boundary, Hydraulic, Transport};
use weald_gpu::Gpu;

const STEPS: u32 = 3000;
const SIDE: usize = 32;

/// Share of the water, and of the solid that moved, that may be missing: as on the CPU.
const SHARE: f64 = 1e-5;

fn run(step: &Hydraulic, land: &mut Landscape, gpu: &Gpu) -> Budget {
    let outcome = run_on(step, land, Engine::Device(Arc::new(gpu.clone())));
    assert_eq!(outcome.notes, Vec::<String>::new());
    outcome.budget.expect("a simulation has a budget")
}

/// Budgets close, and what may not be negative is not.
fn assert_closed(name: &str, land: &Landscape, budget: &Budget, moved: f64) {
    let water = budget.water.error();
    println!("{name}: water {water:.1e}, solid of what moved {moved:.1e}");
    assert!(water.abs() < SHARE, "{name}: {:?}", budget.water);
    assert!(moved.abs() < SHARE, "{name}: {moved:e} of what moved is missing: {:?}", budget.solid);
    for layer in ["water", "sediment", "regolith", "clay", "soil", "sand"] {
        let least = land.field(layer).map_or(0.0, |field| field.range(None).expect("cells").0);
        assert!(least >= 0.0, "{name}: {layer} is {least} m somewhere");
    }
}

#[test]
fn conserving_transport_loses_nothing_in_3000_steps() {
    let Some(gpu) = crate::programs::gpu() else { return };
    for (step, boundary) in [(hydraulic(STEPS), Boundary::Open), (mei(STEPS), Boundary::Closed)] {
        let model = step.model.word();
        let mut land = landscape(rough(SIDE, SIDE, 25.0, 4));
        let step = with!(step, [Han Mei] { transport: Transport::MacCormack });
        let step = Hydraulic { boundary, ..step };
        let budget = run(&step, &mut land, &gpu);
        let eroded: f64 = field(&land, "erosion").values().iter().map(|&e| f64::from(e)).sum();
        assert!(eroded > 1.0, "nothing moved, so a closed budget would mean nothing: {eroded} m³");
        let moved = budget.solid.lost() / eroded;
        assert_closed(&format!("{model} {boundary:?}"), &land, &budget, moved);
    }
}

#[test]
fn all_processes_of_stava_lose_nothing_in_3000_steps() {
    let Some(gpu) = crate::programs::gpu() else { return };
    for boundary in [Boundary::Closed, Boundary::Open] {
        let mut land = layered(rough(SIDE, SIDE, 50.0, 3));
        let before = land.clone();
        let (sources, drains) = (vec![spring(8.0, 11.0)], vec![spring(23.0, 20.0)]);
        let transport = Transport::MacCormack;
        let step = with!(stava(STEPS), [Stava] { transport: transport, sources: sources, drains: drains });
        let step = Hydraulic { boundary, ..step };
        let budget = run(&step, &mut land, &gpu);
        let lowered = crate::common::worst_difference(field(&before, "height"), field(&land, "height"));
        assert!(lowered > 0.5, "nothing moved, so a closed budget would mean nothing: {lowered} m");
        let moved = error_of_what_moved(&budget.solid, &before, &land);
        assert_closed(&format!("Stava {boundary:?}"), &land, &budget, moved);
    }
}
