//! Transport alone: what is carried stays as much as it was, between what it was, and arrives where water goes.

use crate::common::{rough, run, run_on, worst_difference};
use proptest::prelude::*;
use weald_core::grid::Mask;
use weald_core::parameter::{LayerName, Length};
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::Engine;
use weald_land::erode::transport_step::{Carry, Scheme};

const SIDE: usize = 48;

/// Water 1 m deep that turns around the middle without piling up anywhere, and a layer `dye` as given.
fn whirl(dye: impl Fn(usize, usize) -> f32) -> Landscape {
    let size = Size::new(SIDE, SIDE).expect("small");
    let mut land = Landscape::new(Domain::new(size, 1.0));
    // A stream function on the corners of cells: its differences are flows without sources or sinks.
    let stream = |x: usize, y: usize| {
        let [dx, dy] = [x, y].map(|at| at as f32 / SIDE as f32);
        80.0 * dx * dx * (1.0 - dx) * (1.0 - dx) * dy * dy * (1.0 - dy) * (1.0 - dy) * SIDE as f32 / 4.0
    };
    land.insert("water", "m", Field::filled(size, 1.0));
    land.insert(
        "flux_x",
        "m³/step",
        Field::from_function(size, |x, y| stream(x + 1, y + 1) - stream(x + 1, y)),
    );
    land.insert(
        "flux_y",
        "m³/step",
        Field::from_function(size, |x, y| stream(x, y + 1) - stream(x + 1, y + 1)),
    );
    land.insert("dye", "m", Field::from_function(size, dye));
    land
}

fn carry(scheme: Scheme, conserve: bool, iterations: u32) -> Carry {
    Carry { layer: LayerName::of("dye"), scheme, conserve, iterations, ..Carry::default() }
}

fn total(field: &Field) -> f64 {
    field.values().iter().map(|&value| f64::from(value)).sum()
}

fn block(x: usize, y: usize) -> f32 {
    if (8..20).contains(&x) && (18..30).contains(&y) { 3.0 } else { 1.0 }
}

#[test]
fn a_carried_block_stays_within_its_values_in_every_scheme_and_keeps_its_sum_where_that_is_promised() {
    for (scheme, conserve) in
        [(Scheme::SemiLagrangian, false), (Scheme::MacCormack, false), (Scheme::MacCormack, true)]
    {
        let start = whirl(block);
        let mut land = start.clone();
        run(&carry(scheme, conserve, 300), &mut land);
        let (before, after) = (start.field("dye").expect("d"), land.field("dye").expect("d"));
        assert!(worst_difference(before, after) > 1.0, "{scheme:?}: the block moved");
        let (least, most) = after.range(None).expect("cells");
        assert!(least >= 1.0 - 1e-5 && most <= 3.0 + 1e-5, "{scheme:?} {conserve}: {least} to {most}");
        let lost = (total(after) - total(before)) / total(before);
        println!("{scheme:?} conserve {conserve}: {lost:.1e} of the sum, {least} to {most}");
        assert_eq!(lost.abs() < 1e-6, conserve, "{scheme:?} {conserve}: {lost:e}");
    }
}

#[test]
fn the_corrected_flux_keeps_a_smooth_hill_far_higher_than_the_semi_lagrangian_scheme() {
    let hill = |x: usize, y: usize| {
        let (dx, dy) = (x as f32 - 14.0, y as f32 - 24.0);
        (-(dx * dx + dy * dy) / 18.0).exp()
    };
    let top = |scheme| {
        let mut land = whirl(hill);
        run(&carry(scheme, true, 400), &mut land);
        land.field("dye").expect("d").range(None).expect("cells").1
    };
    let (corrected, plain) = (top(Scheme::MacCormack), top(Scheme::SemiLagrangian));
    println!("top of the hill after 400 steps: corrected {corrected}, semi-Lagrangian {plain}");
    assert!(corrected > 1.5 * plain, "corrected {corrected}, semi-Lagrangian {plain}");
}

#[test]
fn water_that_stands_carries_nothing() {
    let mut land = whirl(block);
    let still = Field::filled(land.domain.size, 0.0);
    land.insert("flux_x", "m³/step", still.clone());
    land.insert("flux_y", "m³/step", still);
    let before = land.clone();
    for scheme in [Scheme::SemiLagrangian, Scheme::MacCormack] {
        run(&carry(scheme, true, 50), &mut land);
        assert_eq!(before.field("dye").expect("d"), land.field("dye").expect("d"), "{scheme:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Any flow, however much it empties or fills its cells, any load, holes in the ground.
    #[test]
    fn the_conserving_form_keeps_its_sum_and_never_goes_below_zero(
        seed in 0_u64..1000, speed in 0.0_f32..3.0, epsilon in 1e-4_f64..1.0, holes in any::<bool>(), steps in 1_u32..40,
    ) {
        let size = Size::new(23, 19).expect("small");
        let mut land = Landscape::new(Domain::new(size, 1.0));
        if holes {
            land.domain.valid = Mask::new(size, (0..size.cells()).map(|at| at % 7 != 3).collect());
        }
        let field = |relief: f32, seed| rough(23, 19, relief, seed);
        let signed = |field: &Field| Field::from_function(size, |x, y| field.at(x, y) - speed * 0.5);
        land.insert("water", "m", field(1.0, seed));
        land.insert("flux_x", "m³/step", signed(&field(speed, seed + 1)));
        land.insert("flux_y", "m³/step", signed(&field(speed, seed + 2)));
        let dye = field(5.0, seed + 3);
        let on_land = |x: usize, y: usize| land.domain.valid.as_ref().is_none_or(|mask| mask.is_valid(x, y));
        let dye = Field::from_function(size, |x, y| if on_land(x, y) { dye.at(x, y) } else { 0.0 });
        land.insert("dye", "m", dye.clone());
        let step = Carry { epsilon: Length::Metres(epsilon), ..carry(Scheme::MacCormack, true, steps) };
        let start = land.clone();
        run(&step, &mut land);
        let after = land.field("dye").expect("d");
        prop_assert!((total(after) - total(&dye)).abs() < 1e-5 * total(&dye));
        prop_assert!(after.range(None).expect("cells").0 >= 0.0, "{:?}", after.range(None));
        let mut tiled = start;
        let outcome = run_on(&step, &mut tiled, Engine::Tiles(Size::new(9, 8).expect("small")));
        prop_assert_eq!(outcome.notes, ["ran tile by tile: 9 tiles of up to 9 x 8 cells"]);
        prop_assert_eq!(after, tiled.field("dye").expect("d"));
    }
}
