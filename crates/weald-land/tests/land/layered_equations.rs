//! The model of layers, with its fused rows and single precision, against its equations written down plainly:
//! what every key does, by amount and sign.

use crate::common::{landscape, metres, rough, run, with};
use crate::reference::World;
use crate::reference::stava::Column;
use weald_core::grid::Mask;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Nested};
use weald_core::{Field, Landscape, Size};
use weald_land::erode::dissolution_step::DissolutionWithin;
use weald_land::erode::hydraulic::{Boundary, Hydraulic, Model, StavaKeys, Transport};
use weald_land::erode::slippage_step::SlippageWithin;
use weald_land::erode::springs::Spring;

const COLUMNS: usize = 17;
const ROWS: usize = 13;
const STEPS: u32 = 14;

/// Two whole cycles of rain and sun, with no number at its default.
fn keys() -> Hydraulic {
    let keys = StavaKeys {
        flow_rate: 0.17,
        rain: metres(0.03),
        evaporation: metres(0.02),
        dry_period: 2,
        capacity: 0.31,
        erosion: 3.0,
        deposition: 0.37,
        velocity_epsilon: metres(0.02),
        ..StavaKeys::default()
    };
    let model = keys.into();
    Hydraulic { model, iterations: STEPS, rain_period: 5, epsilon: metres(0.004), ..Hydraulic::default() }
}

fn own(step: &Hydraulic) -> &StavaKeys {
    match &step.model {
        Model::Stava(keys) => keys,
        other => panic!("model {}", other.word()),
    }
}

/// Every process alone, and all of them.
fn variants() -> Vec<Hydraulic> {
    let dissolution = Some(Nested(DissolutionWithin { depth: 0.05, damping: 0.6 }));
    let slippage = |softening| Some(Nested(SlippageWithin { strength: 0.07, softening }));
    let sources = vec![Nested(Spring { x: 4.0, y: 5.5, radius: 1.7, rate: 0.11 })];
    let drains = vec![Nested(Spring { x: 12.0, y: 8.0, radius: 1.1, rate: 0.07 })];
    let [rain_layer, evaporation_layer, source_layer] =
        ["wetness", "sunshine", "seepage"].map(|name| Some(LayerName::of(name)));
    let painted = with!(keys(), [Stava] {
        rain_layer: rain_layer, evaporation_layer: evaporation_layer, source_layer: source_layer,
    });
    vec![
        keys(),
        Hydraulic { rain_period: 7, ..with!(keys(), [Stava] { dry_period: 0 }) },
        with!(keys(), [Stava] { viscosity: 0.8 }),
        with!(keys(), [Stava] { deposit: Some(LayerName::of("rock")) }),
        with!(keys(), [Stava] { transport: Transport::Upwind }),
        with!(keys(), [Stava] { transport: Transport::MacCormack, conserve: false }),
        with!(keys(), [Stava] { dissolution: dissolution.clone() }),
        with!(keys(), [Stava] { slippage: slippage(false) }),
        with!(keys(), [Stava] { slippage: slippage(true) }),
        with!(painted, [Stava] { sources: sources.clone(), drains: drains }),
        with!(keys(), [Stava] {
            viscosity: 0.8,
            transport: Transport::SemiLagrangian,
            deposit: Some(LayerName::of("clay")),
            dissolution: dissolution,
            slippage: slippage(false),
            sources: sources,
        }),
    ]
}

/// Rough ground of rock, clay and sand, whole or with a lake of cells without data.
fn ground(masked: bool) -> Landscape {
    let mut land = landscape(rough(COLUMNS, ROWS, 8.0, 3));
    let size = land.domain.size;
    let material = |name, erodibility, solubility, talus_deg| Material {
        erodibility,
        solubility,
        talus_deg,
        ..Material::built_in(name).expect("built in")
    };
    land.materials = vec![
        material("rock", 0.02, 0.1, 40.0),
        material("clay", 0.07, 0.3, 30.0),
        material("sand", 0.2, 0.6, 20.0),
    ];
    for (name, unit, least, most) in [
        ("clay", "m", -0.05, 0.3),
        ("sand", "m", -0.1, 0.2),
        ("wetness", "1", 0.2, 1.7),
        ("sunshine", "1", 0.1, 2.0),
        ("seepage", "m/iteration", -0.03, 0.02),
    ] {
        let raw = rough(COLUMNS, ROWS, most - least, 50 + name.len() as u64);
        let floor = if unit == "m" { 0.0 } else { least };
        land.insert(name, unit, Field::from_function(size, |x, y| (raw.at(x, y) + least).max(floor)));
    }
    if masked {
        let has_data = |at: usize| !(5..8).contains(&(at % COLUMNS)) || !(4..9).contains(&(at / COLUMNS));
        land.domain.valid = Mask::new(size, (0..size.cells()).map(has_data).collect());
    }
    land
}

/// Column and row of a cell of the ringed world, where it holds data.
fn inside(land: &Landscape, at: usize) -> Option<(usize, usize)> {
    let columns = COLUMNS + 2;
    let (x, y) = ((at % columns).checked_sub(1)?, (at / columns).checked_sub(1)?);
    let has_data = |mask: &Mask| mask.is_valid(x, y);
    (x < COLUMNS && y < ROWS && land.domain.valid.as_ref().is_none_or(has_data)).then_some((x, y))
}

/// Values within a ring of cells without data.
fn ringed(land: &Landscape, value: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let cells = 0..(COLUMNS + 2) * (ROWS + 2);
    cells.map(|at| inside(land, at).map_or(0.0, |(x, y)| value(x, y))).collect()
}

fn layer(land: &Landscape, name: &str) -> Vec<f64> {
    let field = land.field(name).expect("written");
    ringed(land, |x, y| f64::from(field.at(x, y)))
}

/// The same world for the reference.
fn reference_of(land: &Landscape, step: &Hydraulic) -> Column {
    let keys = own(step);
    let has_data = (0..(COLUMNS + 2) * (ROWS + 2)).map(|at| inside(land, at).is_some()).collect();
    let world = World::new(COLUMNS + 2, layer(land, "height"), has_data, step.boundary);
    let layers = ["clay", "sand"].map(|name| layer(land, name)).into();
    let mut reference = Column::new(world, land.materials.clone(), layers);
    let painted = |name: &Option<LayerName>, values: &mut Vec<f64>| {
        if let Some(name) = name {
            *values = layer(land, &name.0);
        }
    };
    painted(&keys.rain_layer, &mut reference.rain_share);
    painted(&keys.evaporation_layer, &mut reference.evaporation_share);
    painted(&keys.source_layer, &mut reference.source);
    for (springs, sign) in [(&keys.sources, 1.0), (&keys.drains, -1.0)] {
        for Nested(Spring { x: middle_x, y: middle_y, radius, rate }) in springs {
            let given = ringed(land, |x, y| {
                let away = (x as f64 + 0.5 - middle_x).powi(2) + (y as f64 + 0.5 - middle_y).powi(2);
                let share = (-away / (radius * radius)).exp();
                if share < 1e-6 { 0.0 } else { sign * rate * share }
            });
            reference.source.iter_mut().zip(given).for_each(|(source, given)| *source += given);
        }
    }
    reference
}

fn assert_alike(name: &str, got: &[f64], expected: &[f64], keys: &Hydraulic) {
    let greatest = expected.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    assert!(greatest > 1e-3, "nothing happened to {name}, so agreement would mean nothing: {keys:?}");
    for (at, (got, expected)) in got.iter().zip(expected).enumerate() {
        assert!(
            (got - expected).abs() <= 5e-5 * greatest,
            "{name} at column {}, row {}: {got}, but {expected} by the equations: {keys:?}",
            at % (COLUMNS + 2),
            at / (COLUMNS + 2),
        );
    }
}

fn compare(keys: &Hydraulic, masked: bool) {
    let before = ground(masked);
    let mut reference = reference_of(&before, keys);
    (0..STEPS).for_each(|number| reference.step(keys, number));
    let mut after = before.clone();
    run(keys, &mut after);
    let land = &reference.world.valid;
    let sediment: Vec<_> =
        reference.world.sediment.iter().zip(land).map(|(s, land)| if *land { *s } else { 0.0 }).collect();
    assert_alike("water", &layer(&after, "water"), &reference.world.depth, keys);
    assert_alike("sediment", &layer(&after, "sediment"), &sediment, keys);
    if own(keys).dissolution.is_some() {
        assert_alike("regolith", &layer(&after, "regolith"), &reference.regolith, keys);
    }
    let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    for (name, thickness) in ["clay", "sand"].iter().zip(&reference.layers) {
        let start = layer(&before, name);
        assert_alike(name, &difference(&layer(&after, name), &start), &difference(thickness, &start), keys);
    }
    let height = difference(&layer(&after, "height"), &layer(&before, "height"));
    let start =
        reference.world.start.iter().zip(layer(&before, "height")).map(|(bedrock, top)| bedrock - top);
    let raised: Vec<f64> = start
        .zip(reference.world.change.iter().zip(&reference.world.piled))
        .map(|(start, (change, piled))| start + change + piled)
        .collect();
    assert_alike("height", &height, &raised, keys);
}

#[test]
fn layers_do_what_the_equations_say() {
    for keys in variants() {
        compare(&keys, false);
        compare(&keys, true);
    }
}

#[test]
fn layers_at_open_edges_do_what_the_equations_say() {
    for keys in variants() {
        for masked in [false, true] {
            compare(&Hydraulic { boundary: Boundary::Open, ..keys.clone() }, masked);
        }
    }
}

#[test]
fn the_ground_of_the_comparison_has_materials_that_are_missing_in_places() {
    let land = ground(false);
    let size = Size::new(COLUMNS, ROWS).expect("small");
    for name in ["clay", "sand"] {
        let missing = land.field(name).expect("laid").values().iter().filter(|&&thick| thick == 0.0).count();
        assert!(missing > 3 && missing < size.cells() / 2, "{name} is missing in {missing} cells");
    }
}
