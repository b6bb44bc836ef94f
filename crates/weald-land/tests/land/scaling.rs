//! Land in cells twice as wide, with everything twice as high, is the same land: all lengths that it gets are twice as
//! long, and flows eight times as large, to the bit.

use crate::common::{hydraulic, landscape, mei, rough, run};
use weald_core::parameter::LayerName;
use weald_core::{Domain, Field, Landscape};
use weald_engine::step::Step;
use weald_land::erode::transport_step::{Carry, Scheme};

/// The same land with lengths twice as long.
fn doubled(land: &Landscape) -> Landscape {
    let mut doubled = Landscape::new(Domain::new(land.domain.size, 2.0 * land.domain.cell));
    for (name, layer) in land.layers() {
        let factor = match layer.unit.as_str() {
            "m" => 2.0,
            "m³/step" => 8.0,
            "1" => 1.0,
            unit => panic!("{name} is in {unit}"),
        };
        let values = layer.field.values().iter().map(|value| factor * value).collect();
        doubled.insert(name, &layer.unit, Field::from_values(land.domain.size, values));
    }
    doubled
}

fn ensure_scales(step: &dyn Step, land: &Landscape) -> Landscape {
    let (mut small, mut large) = (land.clone(), doubled(land));
    run(step, &mut small);
    run(step, &mut large);
    for (name, layer) in doubled(&small).layers() {
        assert!(layer.field == large.field(name).expect("both have it").clone(), "{name} is of another size");
    }
    small
}

#[test]
fn rain_carves_and_carries_alike_at_every_size() {
    for step in [hydraulic(90), mei(90)] {
        let after = ensure_scales(&step, &landscape(rough(24, 20, 12.0, 5)));
        for name in ["sediment", "flux_x", "flux_y", "erosion", "deposition"] {
            let (_, most) = after.field(name).expect("written").range(None).expect("cells");
            assert!(most > 0.0, "there is no {name}");
        }
    }
}

#[test]
fn water_carries_a_layer_alike_at_every_size() {
    let mut land = landscape(rough(24, 20, 12.0, 5));
    run(&hydraulic(60), &mut land);
    let dye = Field::from_function(land.domain.size, |x, _| if x < 12 { 1.0 } else { 0.0 });
    land.insert("dye", "1", dye.clone());
    for scheme in [Scheme::SemiLagrangian, Scheme::MacCormack] {
        let carry = Carry { layer: LayerName::of("dye"), scheme, iterations: 40, ..Carry::default() };
        let after = ensure_scales(&carry, &land);
        assert!(after.field("dye").expect("carried") != &dye, "nothing moved");
    }
}
