//! The engine, with its fused rows and single precision, against the published equations written down
//! plainly: what every key does, by amount and sign.

use crate::common::{landscape, metres, rough, run, with};
use crate::reference::World;
use crate::reference::numbers::Numbers;
use weald_core::grid::Mask;
use weald_core::parameter::Nested;
use weald_core::{Field, Landscape, Size};
use weald_land::erode::hydraulic::{Boundary, HanKeys, Hydraulic, MeiKeys, Slope, Transport, UptakeLaw};
use weald_land::erode::thermal::Scheme;
use weald_land::erode::thermal_step::{Thermal, ThermalWithin};

const COLUMNS: usize = 17;
const ROWS: usize = 13;

/// The models of which the reference has the equations.
#[derive(Clone, Copy, PartialEq)]
enum Published {
    Han,
    Mei,
}

/// Two whole cycles of rain and sun, with no number at its default.
fn keys(model: Published) -> Hydraulic {
    Hydraulic {
        model: match model {
            Published::Han => of_han().into(),
            Published::Mei => of_mei().into(),
        },
        iterations: 14,
        rain_period: 5,
        epsilon: metres(0.004),
        ..Hydraulic::default()
    }
}

fn of_han() -> HanKeys {
    HanKeys {
        flow_rate: 0.17,
        rain: metres(0.03),
        evaporation: metres(0.02),
        dry_period: 2,
        capacity: Some(3.0),
        erosion: Some(0.02),
        deposit_ratio: 0.6,
        velocity_epsilon: metres(0.07),
        ..HanKeys::default()
    }
}

fn of_mei() -> MeiKeys {
    MeiKeys {
        flow_rate: 0.17,
        rain: metres(0.03),
        evaporation: 0.02,
        dry_period: 2,
        capacity: 0.11,
        erosion: 0.23,
        deposition: 0.37,
        deposit_ratio: 0.6,
        velocity_epsilon: metres(0.02),
        ..MeiKeys::default()
    }
}

/// Every rule that has equations of its own.
fn variants(model: Published) -> Vec<Hydraulic> {
    // Unlimited outflows leave water so thin that velocities in it would be rounding errors.
    let velocity_epsilon = metres(if model == Published::Mei { 0.05 } else { 0.07 });
    let unlimited = with!(keys(model), [Han Mei] {
        limiter: false, flow_rate: 0.05, velocity_epsilon: velocity_epsilon,
    });
    let mut all = vec![keys(model), unlimited];
    for transport in [Transport::SemiLagrangian, Transport::MacCormack] {
        all.push(with!(keys(model), [Han Mei] { transport: transport }));
    }
    all.push(with!(keys(model), [Han Mei] { transport: Transport::MacCormack, conserve: false }));
    for scheme in [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric] {
        let thermal = ThermalWithin { scheme, talus: 0.4, strength: 0.13 };
        all.push(with!(keys(model), [Han Mei] { thermal: Some(Nested(thermal)) }));
    }
    if model == Published::Mei {
        all.push(with!(keys(model), [Mei] { slope: Slope::Central }));
    }
    if model == Published::Han {
        all.push(with!(keys(model), [Han] { law: UptakeLaw::Dissolution, erosion: Some(0.3) }));
    }
    all
}

/// Rough ground, whole or with a lake of cells without data.
fn ground(masked: bool) -> Landscape {
    let mut land = landscape(rough(COLUMNS, ROWS, 8.0, 3));
    if masked {
        let size = land.domain.size;
        let has_data = |at: usize| !(5..8).contains(&(at % COLUMNS)) || !(4..9).contains(&(at / COLUMNS));
        land.domain.valid = Mask::new(size, (0..size.cells()).map(has_data).collect());
    }
    land
}

/// The same world for the reference, within a ring of cells without data.
fn ringed(land: &Landscape, boundary: Boundary) -> World {
    let (height, mask) = (land.field("height").expect("h"), land.domain.valid.as_ref());
    let columns = COLUMNS + 2;
    let inside = |at: usize| {
        let (x, y) = ((at % columns).checked_sub(1)?, (at / columns).checked_sub(1)?);
        (x < COLUMNS && y < ROWS && mask.is_none_or(|mask| mask.is_valid(x, y))).then_some((x, y))
    };
    let cells = 0..columns * (ROWS + 2);
    let start = cells.clone().map(|at| inside(at).map_or(0.0, |(x, y)| f64::from(height.at(x, y)))).collect();
    World::new(columns, start, cells.map(|at| inside(at).is_some()).collect(), boundary)
}

/// The reference's values on the cells of the landscape.
fn unringed(values: &[f64]) -> Field {
    let size = Size::new(COLUMNS, ROWS).expect("small");
    Field::from_function(size, |x, y| values[(y + 1) * (COLUMNS + 2) + x + 1] as f32)
}

fn assert_alike(name: &str, got: &Field, expected: &Field, keys: &dyn std::fmt::Debug) {
    let greatest = expected.values().iter().fold(0.0_f32, |most, value| most.max(value.abs()));
    assert!(greatest > 1e-3, "nothing happened to {name}, so agreement would mean nothing: {keys:?}");
    for (at, (got, expected)) in got.values().iter().zip(expected.values()).enumerate() {
        assert!(
            (got - expected).abs() <= 5e-5 * greatest,
            "{name} at column {}, row {}: {got}, but {expected} by the equations: {keys:?}",
            at % COLUMNS,
            at / COLUMNS,
        );
    }
}

/// Runs both and compares all that they know. The fluxes are means over the last whole cycle.
fn compare(keys: &Hydraulic, masked: bool) {
    let mut land = ground(masked);
    let mut world = ringed(&land, keys.boundary);
    let cycle = keys.rain_period + Numbers::of(keys).dry_period;
    let mut means = [(); 2].map(|()| vec![0.0; world.valid.len()]);
    for number in 0..keys.iterations {
        world.step(keys, number);
        if number >= keys.iterations - cycle {
            for (edge, flux) in world.edges.iter().zip(&world.flux) {
                means[usize::from(!edge.across)][edge.cells[0]] += (flux[0] - flux[1]) / f64::from(cycle);
            }
        }
    }
    for at in (0..world.valid.len()).filter(|&at| !world.valid[at]) {
        world.sediment[at] = 0.0;
        for mean in &mut means {
            mean[at] = 0.0;
        }
    }
    run(keys, &mut land);
    let layer = |name| land.field(name).expect("written");
    assert_alike("water", layer("water"), &unringed(&world.depth), keys);
    assert_alike("flux_x", layer("flux_x"), &unringed(&means[0]), keys);
    assert_alike("flux_y", layer("flux_y"), &unringed(&means[1]), keys);
    assert_alike("sediment", layer("sediment"), &unringed(&world.sediment), keys);
    let [erosion, deposition] = [-1.0, 1.0].map(|sign| {
        unringed(&world.change.iter().map(|change| (sign * change).max(0.0)).collect::<Vec<_>>())
    });
    assert_alike("erosion", layer("erosion"), &erosion, keys);
    assert_alike("deposition", layer("deposition"), &deposition, keys);
}

#[test]
fn hydraulic_erosion_does_what_the_equations_say() {
    for model in [Published::Han, Published::Mei] {
        for keys in variants(model) {
            compare(&keys, false);
            compare(&keys, true);
        }
    }
}

#[test]
fn water_falls_over_open_edges_as_the_equations_say() {
    for model in [Published::Han, Published::Mei] {
        // Sliding moves the ground along the edges too, where water may not.
        let sliding = ThermalWithin { scheme: Scheme::Axis, talus: 0.4, strength: 0.13 };
        for thermal in [None, Some(Nested(sliding))] {
            for masked in [false, true] {
                let thermal = thermal.clone();
                let sliding = with!(keys(model), [Han Mei] { thermal: thermal });
                compare(&Hydraulic { boundary: Boundary::Open, ..sliding }, masked);
            }
        }
    }
}

#[test]
fn thermal_weathering_does_what_the_equations_say() {
    for scheme in [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric] {
        for masked in [false, true] {
            let mut land = ground(masked);
            let mut world = ringed(&land, Boundary::Closed);
            let step = Thermal { scheme, talus: 0.5, strength: 0.21, iterations: 9, ..Thermal::default() };
            (0..9).for_each(|_| crate::reference::thermal::slide(&mut world, scheme, 0.5, 0.21));
            let before = land.field("height").expect("h").clone();
            run(&step, &mut land);
            let after = land.field("height").expect("h");
            let moved = Field::from_function(after.size(), |x, y| after.at(x, y) - before.at(x, y));
            assert_alike("the change", &moved, &unringed(&world.change), &step);
        }
    }
}
