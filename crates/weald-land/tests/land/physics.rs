//! What nature guarantees: budgets, rest, symmetry, finiteness.

use crate::common::{hydraulic, landscape, mei, metres, rough, run, symmetries, with, worst_difference};
use proptest::prelude::*;
use weald_core::grid::Mask;
use weald_core::parameter::{LayerName, Nested};
use weald_core::{Domain, Field, Landscape, Size};
use weald_land::erode::hydraulic::{Boundary, Hydraulic, Model, StavaKeys, Transport, UptakeLaw};
use weald_land::erode::thermal::Scheme;
use weald_land::erode::thermal_step::{Thermal, ThermalWithin};

fn assert_budgets_close(step: &Hydraulic, size: usize, tolerance: f64) {
    let mut land = landscape(rough(size, size, 50.0, 3));
    let before = land.field("height").expect("height").clone();
    let budget = run(step, &mut land).budget.expect("a budget");
    let moved = worst_difference(&before, land.field("height").expect("height"));
    assert!(moved > 0.01, "nothing moved, so a closed budget would mean nothing: {moved} m");
    let (water, solid) = (budget.water.error(), budget.solid.error());
    let model = step.model.word();
    println!("{model} {:?}: water {water:.1e}, solid {solid:.1e}, moved {moved} m", step.boundary);
    assert!(water.abs() <= tolerance, "water error {water:e}: {:?}", budget.water);
    assert!(solid.abs() <= tolerance, "solid error {solid:e}: {:?}", budget.solid);
    for name in ["water", "sediment"] {
        let (least, _) = land.field(name).expect("written").range(None).expect("cells");
        assert!(least >= 0.0, "{name} is {least} somewhere");
    }
}

#[test]
fn budgets_close_to_a_millionth_over_3600_steps_closed_and_open() {
    for model in [hydraulic(3600), mei(3600)] {
        for boundary in [Boundary::Closed, Boundary::Open] {
            let thermal = Some(Nested(ThermalWithin::default()));
            let step = with!(model.clone(), [Han Mei] { thermal: thermal, deposit_ratio: 0.3 });
            assert_budgets_close(&Hydraulic { boundary, ..step }, 256, 1e-6);
        }
    }
}

#[test]
fn water_leaves_over_an_open_edge_and_takes_sediment_along() {
    let mut land = landscape(rough(64, 64, 25.0, 5));
    let budget =
        run(&Hydraulic { boundary: Boundary::Open, ..hydraulic(600) }, &mut land).budget.expect("a budget");
    assert!(budget.water.outgoing > 0.2 * budget.water.incoming, "{:?}", budget.water);
    assert!(budget.solid.outgoing > 0.0, "{:?}", budget.solid);
}

#[test]
fn the_scheme_as_printed_keeps_its_budget_but_owes_water() {
    let step = with!(hydraulic(600), [Han] { limiter: false, flow_rate: 0.05 });
    let mut land = landscape(rough(128, 128, 25.0, 3));
    let budget = run(&step, &mut land).budget.expect("a budget");
    let (deepest_debt, _) = land.field("water").expect("written").range(None).expect("cells");
    assert!(deepest_debt < -0.01, "as printed, depths go negative; here the least is {deepest_debt}");
    assert!(budget.water.error().abs() < 1e-5, "{:?}", budget.water);
}

/// A bowl with a lake whose level stands 10 m over its floor. Heights are multiples of 1/64 m, so that depth
/// and ground add up to the level exactly: the water really is at rest.
fn lake(size: usize) -> Landscape {
    let grid = Size::square(size).expect("small");
    let middle = (size as f32 - 1.0) / 2.0;
    let ground = Field::from_function(grid, |x, y| {
        let bowl = 0.03 * ((x as f32 - middle).powi(2) + (y as f32 - middle).powi(2));
        ((bowl + ((x * 7 + y * 13) % 5) as f32 * 0.1) * 64.0).round() / 64.0
    });
    let water = Field::from_function(grid, |x, y| (10.0 - ground.at(x, y)).max(0.0));
    let mut land = Landscape::new(Domain::new(grid, 1.0));
    land.insert("height", "m", ground);
    land.insert("standing", "m", water);
    land
}

#[test]
fn a_lake_at_rest_stays_at_rest_for_ten_thousand_steps() {
    for still in [
        with!(hydraulic(10_000), [Han] { rain: metres(0.0), evaporation: metres(0.0) }),
        with!(mei(10_000), [Mei] { rain: metres(0.0), evaporation: 0.0 }),
    ] {
        let model = still.model.word();
        let mut land = lake(48);
        let (ground, water) =
            (land.field("height").expect("h").clone(), land.field("standing").expect("w").clone());
        run(&Hydraulic { initial_water: Some(LayerName::of("standing")), ..still }, &mut land);
        let fastest = land.field("flux_x").expect("written").values().iter().zip(water.values());
        let fastest = fastest.filter(|(_, depth)| **depth > 0.01).map(|(flux, depth)| (flux / depth).abs());
        let fastest = fastest.fold(0.0, f32::max);
        assert!(fastest < 1e-6, "{model}: water moves at {fastest} cells per step");
        let lowered = worst_difference(&water, land.field("water").expect("written"));
        assert!(lowered < 1e-5, "{model}: the level moved by {lowered} m");
        assert_eq!(land.field("height").expect("h"), &ground, "{model}: water at rest carves nothing");
    }
}

#[test]
fn ground_stays_to_the_bit_when_nothing_erodes() {
    let before = rough(64, 48, 800.0, 9);
    let mut land = landscape(before.clone());
    land.domain.cell = 20.0;
    run(&with!(hydraulic(500), [Han] { erosion: Some(0.0) }), &mut land);
    let (_, deepest) = land.field("water").expect("written").range(None).expect("cells");
    assert!(deepest > 0.1, "water flowed: {deepest} m");
    assert_eq!(land.field("height").expect("h"), &before);
}

/// Greatest difference between eroding a turned landscape and turning an eroded one, over all symmetries.
fn asymmetry(step: &dyn weald_engine::step::Step) -> f32 {
    let side = 40;
    let ground = rough(side, side, 20.0, 11);
    let mut straight = landscape(ground.clone());
    run(step, &mut straight);
    let straight = straight.field("height").expect("h");
    assert!(worst_difference(&ground, straight) > 0.01, "nothing moved");
    symmetries(side)
        .iter()
        .map(|turn| {
            let turned = |field: &Field| {
                Field::from_function(field.size(), |x, y| {
                    let (x, y) = turn(x, y);
                    field.at(x, y)
                })
            };
            let mut land = landscape(turned(&ground));
            run(step, &mut land);
            worst_difference(land.field("height").expect("h"), &turned(straight))
        })
        .fold(0.0, f32::max)
}

#[test]
fn erosion_commutes_with_the_eight_symmetries_of_the_square() {
    for step in [hydraulic(200), mei(200)] {
        assert_eq!(asymmetry(&step), 0.0, "{} without thermal weathering", step.model.word());
    }
    let dissolving = with!(hydraulic(200), [Han] { law: UptakeLaw::Dissolution });
    assert_eq!(asymmetry(&dissolving), 0.0, "dissolution");
}

#[test]
fn sliding_commutes_with_the_symmetries_unless_the_triangle_looks_one_way() {
    let slide = |scheme| Thermal { scheme, talus: 0.3, strength: 0.2, iterations: 100, ..Thermal::default() };
    assert_eq!(asymmetry(&slide(Scheme::Axis)), 0.0);
    assert_eq!(asymmetry(&slide(Scheme::IsotropicSymmetric)), 0.0);
    assert!(asymmetry(&slide(Scheme::Isotropic)) > 0.0, "the forward triangle prefers south-east");
}

#[test]
fn ground_below_its_talus_does_not_move() {
    let size = Size::new(30, 20).expect("small");
    let plane = Field::from_function(size, |x, y| 0.5 * x as f32 + 0.25 * y as f32);
    for scheme in [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric] {
        let mut land = landscape(plane.clone());
        run(&Thermal { scheme, talus: 0.6, strength: 0.25, iterations: 50, ..Thermal::default() }, &mut land);
        assert_eq!(land.field("height").expect("h"), &plane, "{scheme:?}");
    }
}

#[test]
fn cells_without_data_take_no_part() {
    let size = Size::new(50, 40).expect("small");
    let land_flags: Vec<bool> =
        (0..size.cells()).map(|at| (at % 50 + at / 50) > 20 && at % 50 < 45).collect();
    let mask = Mask::new(size, land_flags).expect("some cells have no data");
    let eroded = |outside: f32, boundary| {
        let inside = rough(50, 40, 15.0, 2);
        let ground =
            Field::from_function(size, |x, y| if mask.is_valid(x, y) { inside.at(x, y) } else { outside });
        let mut land = landscape(ground);
        land.domain.valid = Some(mask.clone());
        let thermal = Some(Nested(ThermalWithin::default()));
        let step = with!(hydraulic(300), [Han] { thermal: thermal });
        let budget = run(&Hydraulic { boundary, ..step }, &mut land).budget.expect("a budget");
        let height = land.field("height").expect("h");
        let values: Vec<f32> =
            (0..size.cells()).filter(|&at| mask.is_valid_at(at)).map(|at| height.values()[at]).collect();
        (values, budget)
    };
    for boundary in [Boundary::Closed, Boundary::Open] {
        let (low, budget) = eroded(-9999.0, boundary);
        let (high, _) = eroded(1e6, boundary);
        assert!(low == high, "{boundary:?}: what stands in no-data cells reached the land");
        assert!(budget.water.error().abs() < 1e-5 && budget.solid.error().abs() < 1e-5, "{budget:?}");
        assert!(budget.water.outgoing > budget.water.incoming * 0.5, "water evaporates or leaves");
    }
}

#[test]
fn advection_reports_the_sediment_it_loses() {
    for transport in [Transport::SemiLagrangian, Transport::MacCormack] {
        for model in [mei(600), Hydraulic { model: StavaKeys::default().into(), ..hydraulic(600) }] {
            let mut land = landscape(rough(64, 64, 25.0, 4));
            let step = with!(model, [Mei Stava] { transport: transport, conserve: false });
            let outcome = run(&step, &mut land);
            let error = outcome.budget.expect("a budget").solid.error();
            assert!(error.abs() > 1e-7, "{transport:?} should lose something: {error:e}");
            let note = &outcome.notes[0];
            assert!(note.contains("does not conserve sediment") && note.contains("m³ of solid"), "{note}");
            assert!(land.field("sediment").expect("s").range(None).expect("cells").0 >= 0.0);
        }
    }
}

/// Flat ground has no solid above its lowest cell, against which the rounding of what is dug could count.
#[test]
fn the_relative_error_of_solid_means_something_on_flat_ground() {
    let mut land = landscape(Field::filled(Size { columns: 48, rows: 48 }, 300.0));
    let outcome = run(&Hydraulic { boundary: Boundary::Open, ..mei(300) }, &mut land);
    let solid = outcome.budget.expect("a budget").solid;
    assert_eq!(solid.start, 0.0);
    assert!(solid.moved > solid.outgoing && solid.outgoing > 20.0, "{solid:?}");
    assert!(solid.error().abs() < 1e-8, "{:e}: {solid:?}", solid.error());
}

#[test]
fn maccormack_transport_in_its_conserving_form_loses_nothing_in_3000_steps() {
    for step in [hydraulic(3000), mei(3000)] {
        for boundary in [Boundary::Closed, Boundary::Open] {
            let model = step.model.word();
            let mut land = landscape(rough(96, 96, 25.0, 4));
            let step = with!(step.clone(), [Han Mei] { transport: Transport::MacCormack });
            let outcome = run(&Hydraulic { boundary, ..step }, &mut land);
            let budget = outcome.budget.expect("a budget");
            let lost = budget.solid.lost();
            let moved: f64 = land.field("erosion").expect("e").values().iter().map(|&e| f64::from(e)).sum();
            let volume = moved * land.domain.cell * land.domain.cell;
            println!(
                "{model} {boundary:?}: solid {:.1e}, of what moved {:.1e}",
                budget.solid.error(),
                lost / volume
            );
            assert!(volume > 1.0, "nothing moved: {volume}");
            assert!(lost.abs() < 1e-5 * volume, "{model} {boundary:?}: {budget:?}");
            assert_eq!(outcome.notes, Vec::<String>::new());
        }
    }
}

fn any_hydraulic() -> impl Strategy<Value = Hydraulic> {
    let models = prop_oneof![Just(hydraulic(80)), Just(mei(80))];
    let transports =
        prop_oneof![Just(Transport::Upwind), Just(Transport::SemiLagrangian), Just(Transport::MacCormack)];
    let boundaries = prop_oneof![Just(Boundary::Closed), Just(Boundary::Open)];
    let schemes = prop_oneof![
        Just(None),
        Just(Some(Scheme::Axis)),
        Just(Some(Scheme::Isotropic)),
        Just(Some(Scheme::IsotropicSymmetric))
    ];
    let rates = (1e-4..=0.5, 0.0..=1.0, 0.0..=1.0, 0.0..=1.0);
    let loads = (0.0..=100.0, 0.0..=1.0, 0.0..=1.0, 1e-6..=1.0);
    let periods = (1_u32..20, 0_u32..20);
    (models, transports, boundaries, schemes, rates, loads, periods, 0.0..=0.25).prop_map(
        |(model, transport, boundary, scheme, rates, loads, periods, strength)| {
            let thermal = |scheme| Nested(ThermalWithin { scheme, strength, ..ThermalWithin::default() });
            let mut step = with!(model, [Han Mei] {
                transport: transport,
                flow_rate: rates.0,
                rain: metres(rates.1),
                deposit_ratio: loads.2,
                velocity_epsilon: metres(loads.3),
                dry_period: periods.1,
                thermal: scheme.map(thermal),
            });
            match &mut step.model {
                Model::Mei(keys) => {
                    (keys.evaporation, keys.deposition) = (rates.2, rates.3);
                    (keys.capacity, keys.erosion) = (loads.0, loads.1);
                }
                Model::Han(keys) => {
                    keys.evaporation = metres(rates.2);
                    (keys.capacity, keys.erosion) = (Some(loads.0), Some(loads.1));
                }
                Model::Stava(_) => unreachable!("it is not drawn"),
            }
            Hydraulic { boundary, rain_period: periods.0, ..step }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_legal_parameters_make_negative_water_or_break_the_budget(
        step in any_hydraulic(), columns in 1_usize..24, rows in 1_usize..24, seed in 0_u64..100,
    ) {
        let mut land = landscape(rough(columns.max(2), rows.max(2), 10.0, seed));
        let budget = run(&step, &mut land).budget.expect("a budget");
        prop_assert!(budget.water.error().abs() < 1e-5, "{:?}", budget.water);
        if step.transport() != Transport::SemiLagrangian {
            prop_assert!(budget.solid.error().abs() < 1e-4, "{:?}", budget.solid);
        }
        for name in ["water", "sediment"] {
            let (least, _) = land.field(name).expect("written").range(None).expect("cells");
            prop_assert!(least >= 0.0, "{name} is {least} somewhere");
        }
    }
}
