//! What nature guarantees where ground is made of materials: budgets, rest, symmetry, signs.

use crate::common::{error_of_what_moved, worst_difference};
use crate::common::{
    field, hydraulic, landscape, layered, materials, mei, metres, rough, run, spring, stava, symmetries, with,
};
use proptest::prelude::*;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Nested};
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::erode::dissolution_step::{DissolutionStep, DissolutionWithin};
use weald_land::erode::hydraulic::{Boundary, Hydraulic, Model, StavaKeys, Transport};
use weald_land::erode::slippage_step::{SlippageStep, SlippageWithin};
use weald_land::erode::springs::Spring;

/// Every layer that may not be negative.
const AMOUNTS: [&str; 6] = ["water", "sediment", "regolith", "clay", "soil", "sand"];

fn assert_nothing_is_negative(land: &Landscape) {
    for name in AMOUNTS {
        let Ok(layer) = land.field(name) else { continue };
        let (least, _) = layer.range(None).expect("cells");
        assert!(least >= 0.0, "{name} is {least} m somewhere");
    }
}

#[test]
fn budgets_of_water_and_solid_close_over_3000_steps_closed_and_open() {
    for boundary in [Boundary::Closed, Boundary::Open] {
        let mut land = layered(rough(128, 128, 50.0, 3));
        let before = land.clone();
        let (sources, drains) = (vec![spring(30.0, 40.0)], vec![spring(90.0, 80.0)]);
        let step = with!(stava(3000), [Stava] { sources: sources, drains: drains });
        let step = Hydraulic { boundary, ..step };
        let budget = run(&step, &mut land).budget.expect("a budget");
        let lowered = worst_difference(field(&before, "height"), field(&land, "height"));
        assert!(lowered > 0.5, "nothing moved, so a closed budget would mean nothing: {lowered} m");
        let moved = error_of_what_moved(&budget.solid, &before, &land);
        let (water, solid) = (budget.water.error(), budget.solid.error());
        println!("{boundary:?}: water {water:.1e}, solid {solid:.1e}, of what moved {moved:.1e}");
        assert!(water.abs() < 1e-5, "{:?}", budget.water);
        assert!(solid.abs() < 1e-6, "{:?}", budget.solid);
        assert!(moved.abs() < 1e-5, "{moved:e} of what moved is missing: {:?}", budget.solid);
        assert_nothing_is_negative(&land);
    }
}

#[test]
fn a_drain_takes_the_sediment_of_its_water_and_the_budget_counts_it() {
    let out = |drains: Vec<Nested<Spring>>| {
        let mut land = layered(rough(64, 64, 30.0, 3));
        let before = land.clone();
        let step = with!(stava(600), [Stava] { sources: vec![spring(20.0, 40.0)], drains: drains });
        let solid = run(&step, &mut land).budget.expect("a budget").solid;
        let moved = error_of_what_moved(&solid, &before, &land);
        assert!(moved.abs() < 1e-5, "{moved:e} of what moved is missing: {solid:?}");
        (solid.outgoing, field(&land, "sediment").sum())
    };
    let (some, none) = (out(vec![spring(45.0, 20.0)]), out(Vec::new()));
    println!("m³ out and left: {some:?} with a drain, {none:?} without");
    assert!(some.0 > 100.0 && some.1 < none.1, "a drain takes {} m³ of solid", some.0);
    assert!(none.0.abs() < 1e-9, "without one {} m³ leave", none.0);
}

#[test]
fn slippage_and_dissolution_alone_lose_no_solid() {
    let slippage =
        SlippageStep { strength: 0.06, softening: true, iterations: 2000, ..SlippageStep::default() };
    let water = LayerName::of("painted");
    let dissolution = DissolutionStep { water, iterations: 2000, ..DissolutionStep::default() };
    let steps: [&dyn Step; 2] = [&slippage, &dissolution];
    for step in steps {
        let mut land = layered(rough(96, 96, 60.0, 3));
        let before = land.clone();
        let solid = run(step, &mut land).budget.expect("a budget").solid;
        assert!(worst_difference(field(&before, "height"), field(&land, "height")) > 0.05, "{step:?}");
        let moved = error_of_what_moved(&solid, &before, &land);
        println!("{:.1e}, of what moved {moved:.1e}: {step:?}", solid.error());
        assert!(solid.error().abs() < 1e-6, "{step:?}: {solid:?}");
        assert_nothing_is_negative(&land);
    }
}

/// A bowl of rock under soil with a lake. Heights are multiples of 1/64 m, so that ground and depth add up to
/// the level exactly.
fn lake() -> Landscape {
    let grid = Size::square(48).expect("small");
    let coarse = |height: f32| (height * 64.0).round() / 64.0;
    let ground = Field::from_function(grid, |x, y| {
        let bowl = 0.03 * ((x as f32 - 23.5).powi(2) + (y as f32 - 23.5).powi(2));
        coarse(bowl + ((x * 7 + y * 13) % 5) as f32 * 0.1)
    });
    let water = Field::from_function(grid, |x, y| (10.0 - ground.at(x, y)).max(0.0));
    let soil = Field::from_function(grid, |x, y| coarse(((x * 3 + y * 5) % 7) as f32 * 0.3));
    let mut land = landscape(ground);
    land.insert("standing", "m", water);
    land.insert("soil", "m", soil);
    land
}

#[test]
fn a_lake_on_layers_stays_at_rest_for_three_thousand_steps() {
    let mut land = lake();
    let before = land.clone();
    let step = with!(stava(3000), [Stava] {
        rain: metres(0.0),
        evaporation: metres(0.0),
        dissolution: None,
        slippage: Some(Nested(SlippageWithin { strength: 0.1, softening: false })),
    });
    let step = Hydraulic { initial_water: Some(LayerName::of("standing")), ..step };
    // Steeper than the bowl, so that it rests.
    land.materials = materials(&["rock", "soil"]);
    land.materials[1].talus_deg = 85.0;
    land.materials[0].talus_deg = 85.0;
    run(&step, &mut land);
    let lowered = worst_difference(field(&before, "standing"), field(&land, "water"));
    assert!(lowered < 1e-5, "the level moved by {lowered} m");
    assert_eq!(field(&land, "height"), field(&before, "height"), "water at rest carves nothing");
    assert_eq!(field(&land, "soil"), field(&before, "soil"), "and moves no soil");
}

#[test]
fn layers_stay_to_the_bit_when_nothing_takes_them() {
    let before = layered(rough(64, 48, 800.0, 9));
    let mut land = before.clone();
    land.domain.cell = 20.0;
    let model = StavaKeys { erosion: 0.0, ..StavaKeys::default() }.into();
    let gentle = Hydraulic { model, ..hydraulic(500) };
    run(&gentle, &mut land);
    let (_, deepest) = field(&land, "water").range(None).expect("cells");
    assert!(deepest > 0.1, "water flowed: {deepest} m");
    for name in ["height", "clay", "soil", "sand"] {
        assert_eq!(field(&land, name), field(&before, name), "{name}");
    }
}

#[test]
fn layers_and_water_commute_with_the_eight_symmetries_of_the_square() {
    let slippage =
        SlippageStep { strength: 0.06, softening: true, iterations: 100, ..SlippageStep::default() };
    let water = LayerName::of("painted");
    let dissolution = DissolutionStep { water, iterations: 100, ..DissolutionStep::default() };
    let steps: [&dyn Step; 3] = [&stava(200), &slippage, &dissolution];
    for step in steps {
        let ground = layered(rough(40, 40, 20.0, 11));
        let mut straight = ground.clone();
        run(step, &mut straight);
        assert!(worst_difference(field(&ground, "height"), field(&straight, "height")) > 0.01, "{step:?}");
        for turn in symmetries(40) {
            let turned = |field: &Field| {
                Field::from_function(field.size(), |x, y| {
                    let (x, y) = turn(x, y);
                    field.at(x, y)
                })
            };
            let mut land = ground.clone();
            for (name, layer) in ground.layers() {
                land.insert(name, &layer.unit, turned(&layer.field));
            }
            run(step, &mut land);
            for name in ["height", "bedrock", "clay", "soil", "sand"] {
                assert_eq!(field(&land, name), &turned(field(&straight, name)), "{name}: {step:?}");
            }
        }
    }
}

#[test]
fn what_lies_outside_a_region_stands_still_for_every_model() {
    for step in [hydraulic(200), mei(200), stava(200)] {
        let mut land = layered(rough(48, 40, 20.0, 5));
        let size = land.domain.size;
        land.insert("here", "1", Field::from_function(size, |x, y| f32::from(u8::from(x + y > 40))));
        land.insert("pond", "m", Field::filled(size, 0.3));
        let before = land.clone();
        let region = Some(LayerName::of("here"));
        let initial_water = Some(LayerName::of("pond"));
        let budget =
            run(&Hydraulic { region, initial_water, ..step.clone() }, &mut land).budget.expect("a budget");
        assert!(budget.water.error().abs() < 1e-5 && budget.solid.error().abs() < 1e-5, "{budget:?}");
        let still = |name: &str, from: &str| {
            let (old, new) = (field(&before, from), field(&land, name));
            let cells = (0..size.cells()).filter(|&at| field(&land, "here").values()[at] < 0.5);
            cells.filter(|&at| old.values()[at].to_bits() != new.values()[at].to_bits()).count()
        };
        let mut layers = vec![("height", "height"), ("water", "pond")];
        if matches!(step.model, Model::Stava(_)) {
            layers.extend([("clay", "clay"), ("soil", "soil"), ("sand", "sand")]);
        }
        for (name, from) in layers {
            assert_eq!(still(name, from), 0, "{}: cells outside where {name} changed", step.model.word());
        }
        let moved = worst_difference(field(&before, "height"), field(&land, "height"));
        assert!(moved > 0.01, "{}: nothing moved inside: {moved} m", step.model.word());
    }
}

#[test]
fn a_region_alone_becomes_what_it_becomes_beside_another_far_away() {
    for step in [hydraulic(150), mei(150), stava(150)] {
        let eroded = |corners: &[[usize; 2]]| {
            let mut land = layered(rough(60, 44, 20.0, 5));
            let inside = |x: usize, y: usize| {
                corners
                    .iter()
                    .any(|[left, top]| (*left..left + 20).contains(&x) && (*top..top + 18).contains(&y))
            };
            let here = Field::from_function(land.domain.size, |x, y| f32::from(u8::from(inside(x, y))));
            land.insert("here", "1", here);
            let mut step = step.clone();
            if let Model::Stava(keys) = &mut step.model {
                keys.sources = vec![spring(12.0, 13.0)];
            }
            let region = Some(LayerName::of("here"));
            run(&Hydraulic { region, ..step }, &mut land);
            land
        };
        let (alone, both) = (eroded(&[[5, 6]]), eroded(&[[5, 6], [38, 24]]));
        assert!(
            worst_difference(field(&alone, "height"), field(&both, "height")) > 0.01,
            "the other is elsewhere"
        );
        for name in ["height", "water", "sediment", "flux_x"] {
            for (x, y) in (5..25).flat_map(|x| (6..24).map(move |y| (x, y))) {
                let [alone, both] = [&alone, &both].map(|land| field(land, name).at(x, y).to_bits());
                assert_eq!(alone, both, "{}: {name} at {x}, {y}", step.model.word());
            }
        }
    }
}

#[test]
fn a_region_that_holds_no_cell_leaves_all_as_it_is_and_is_told() {
    let mut land = layered(rough(16, 16, 5.0, 1));
    land.insert("here", "1", Field::filled(land.domain.size, 0.4));
    let before = land.clone();
    for step in [hydraulic(5), mei(5), stava(5)] {
        let step = Hydraulic { region: Some(LayerName::of("here")), ..step };
        let notes = run(&step, &mut land).notes.join("\n");
        assert!(notes.contains("`here` is below 0.5 everywhere"), "{notes}");
        assert_eq!(field(&before, "height"), field(&land, "height"));
    }
}

#[test]
fn too_much_slippage_for_so_many_materials_is_refused() {
    let mut land = layered(rough(16, 16, 5.0, 1));
    let step = SlippageStep { strength: 0.1, ..SlippageStep::default() };
    let error = step.run(&mut land, &Job::unwatched(1)).expect_err("unstable").to_string();
    assert!(error.contains("`strength` is 0.1, but must be at most 0.25 / 4 = 0.0625"), "{error}");
}

/// Landscapes of one to eight materials, thick and thin.
fn any_ground() -> impl Strategy<Value = Landscape> {
    let sides = (2_usize..20, 2_usize..20);
    let numbers = prop::collection::vec((0.0..=1.0, 0.0..=1.0, 0.0..=89.9, 0.0..3.0), 1..=8);
    (sides, numbers, 0_u64..100, 0.2..=50.0).prop_map(|((columns, rows), numbers, seed, cell)| {
        let height = rough(columns, rows, 10.0, seed);
        let mut land = Landscape::new(Domain::new(height.size(), cell));
        land.insert("height", "m", height);
        let material = |(at, (erodibility, solubility, talus_deg, thickness)): (usize, _)| Material {
            name: format!("material-{at}"),
            erodibility,
            solubility,
            talus_deg,
            colour: [0.5; 3],
            thickness,
            bottom: None,
        };
        land.materials = numbers.into_iter().enumerate().map(material).collect();
        land
    })
}

fn any_stava() -> impl Strategy<Value = Hydraulic> {
    let transports =
        prop_oneof![Just(Transport::Upwind), Just(Transport::SemiLagrangian), Just(Transport::MacCormack)];
    let boundaries = prop_oneof![Just(Boundary::Closed), Just(Boundary::Open)];
    let rates = (1e-4..=0.5, 0.0..=1.0, 0.0..=1.0, 0.0..=1.0);
    let loads = (0.0..=100.0, 0.0..=1.0, 0.0..=50.0, 1e-6..=1.0);
    let dissolution = prop::option::of((0.0..=3.0, 0.0..=1.0));
    let slippage = prop::option::of((0.0..=0.03, any::<bool>()));
    (transports, boundaries, rates, loads, dissolution, slippage, 0_u32..20).prop_map(
        |(transport, boundary, rates, loads, dissolution, slippage, dry_period)| {
            let keys = StavaKeys {
                transport,
                flow_rate: rates.0,
                rain: metres(rates.1),
                evaporation: metres(rates.2),
                deposition: rates.3,
                capacity: loads.0,
                erosion: loads.1,
                viscosity: loads.2,
                velocity_epsilon: metres(loads.3),
                dry_period,
                dissolution: dissolution.map(|(depth, damping)| Nested(DissolutionWithin { depth, damping })),
                slippage: slippage
                    .map(|(strength, softening)| Nested(SlippageWithin { strength, softening })),
                ..StavaKeys::default()
            };
            Hydraulic { model: keys.into(), boundary, rain_period: 7, ..hydraulic(60) }
        },
    )
}

fn dissolves(step: &Hydraulic) -> bool {
    matches!(&step.model, Model::Stava(keys) if keys.dissolution.is_some())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_legal_parameters_make_anything_negative_or_break_the_budget(step in any_stava(), start in any_ground()) {
        let mut land = start;
        let budget = run(&step, &mut land).budget.expect("a budget");
        prop_assert!(budget.water.error().abs() < 1e-5, "{:?}", budget.water);
        if step.transport() != Transport::SemiLagrangian {
            let (solid, cell) = (budget.solid, land.domain.cell.powi(2));
            let left = solid.start - solid.ground - solid.layers - solid.suspended - solid.outgoing;
            // Rules without measure dig kilometres deep on ground of a few metres: of what lies in the water single
            // precision keeps its own digits.
            let bound = 1e-4 * solid.start.max(cell) + 1e-6 * solid.suspended.max(0.0);
            prop_assert!(left.abs() < bound, "{solid:?}");
        }
        let names = land.materials[1..].iter().map(|material| material.name.as_str());
        for name in names.chain(["water", "sediment"]).chain(dissolves(&step).then_some("regolith")) {
            let (least, _) = field(&land, name).range(None).expect("cells");
            prop_assert!(least >= 0.0, "{name} is {least} m somewhere");
        }
    }
}
