//! The `fluvial` step on ground of several materials, under maps of rain and erodibility, and with rivers that flow in.

use weald_core::Landscape;
use weald_core::grid::Field;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Nested};
use weald_engine::{Job, step::Step};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::springs::Source;

use crate::common::field;
use crate::fluvial::{land, run, square, water_alone};
use crate::fluvial_grid::hills;

/// Hills of materials with these erodibilities and thicknesses on the first, all of which rest alike.
fn layered(materials: &[(&str, f64, f64)]) -> Landscape {
    let mut land = hills(64);
    let rock = Material::built_in("rock").expect("built in");
    land.materials = materials
        .iter()
        .map(|&(name, erodibility, thickness)| Material {
            name: name.to_owned(),
            erodibility,
            thickness,
            talus_deg: 35.0,
            ..rock.clone()
        })
        .collect();
    land
}

/// A flood over them. Bare rock does not creep, so that nothing may creep where ground of one material is compared.
fn over_materials() -> Fluvial {
    let talus = libm::tan(35.0_f64.to_radians());
    Fluvial { materials: true, creep: 0.0, talus, flow_time: 0.5, duration: 3000.0, ..Fluvial::default() }
}

fn assert_same(a: &Landscape, b: &Landscape) {
    for layer in ["height", "water", "sediment", "flux_x", "flux_y"] {
        let differs = field(a, layer).values().iter().zip(field(b, layer).values()).filter(|(a, b)| a != b);
        assert_eq!(differs.count(), 0, "cells of `{layer}` that differ");
    }
}

#[test]
fn ground_wears_as_the_erodibility_of_its_stratum_says() {
    let one = Fluvial { materials: false, ..over_materials() };
    // (materials, what all that is worn has for an erodibility over that of the bedrock)
    let alike: &[(&str, f64, f64)] = &[("rock", 0.01, 0.0), ("bed", 0.01, 9.0), ("sand", 0.01, 0.5)];
    let soft: &[(&str, f64, f64)] = &[("rock", 0.01, 0.0), ("bed", 0.02, 9999.0), ("sand", 0.02, 0.5)];
    let deep: &[(&str, f64, f64)] =
        &[("rock", 0.01, 0.0), ("core", 0.07, 50.0), ("bed", 0.005, 999.0), ("sand", 0.005, 0.0)];
    for (materials, factor) in [(alike, 1.0), (soft, 2.0), (deep, 0.5)] {
        let (mut several, mut single) = (layered(materials), hills(64));
        run(&over_materials(), &mut several);
        run(&Fluvial { erodibility: one.erodibility * factor, ..one.clone() }, &mut single);
        assert_same(&several, &single);
    }
}

#[test]
fn every_material_keeps_its_books() {
    let stack = [("rock", 0.005, 0.0), ("shale", 0.05, 4.0), ("lime", 0.01, 3.0), ("sand", 0.1, 0.2)];
    for levels in [1, 2] {
        let mut land = layered(&stack);
        let start = field(&land, "height").clone();
        let budget = run(&Fluvial { levels, ..over_materials() }, &mut land);
        assert!(budget.solid.error().abs() < 1e-7, "{:?}", budget.solid);
        let (mut bare, mut laid) = (0, 0);
        for cell in 0..64 * 64 {
            let at = |layer: &str| f64::from(field(&land, layer).values()[cell]);
            let [shale, lime, sand] = ["shale", "lime", "sand"].map(at);
            assert!((0.0..=4.0).contains(&shale) && (0.0..=3.0).contains(&lime) && sand >= 0.0);
            assert!(lime == 0.0 || shale == 4.0, "shale is worn under {lime} m of lime");
            let pile = at("bedrock") + shale + lime + sand;
            assert!(
                (pile - at("height")).abs() < 1e-3,
                "{pile} m of material in {} m of ground",
                at("height")
            );
            let worn = f64::from(start.values()[cell]) - 7.2 - at("bedrock");
            assert!(worn > -1e-3 && (worn < 1e-3 || shale == 0.0), "rock is worn by {worn} m under shale");
            bare += usize::from(shale == 0.0);
            laid += usize::from(sand > 1.0);
        }
        println!("{levels} levels: {bare} cells worn to the rock, {laid} under a metre of sand and more");
        assert!(bare > 40 && laid > 40, "{bare} cells worn to the rock, {laid} under sand");
    }
}

#[test]
fn maps_multiply_rain_and_erodibility() {
    let step = Fluvial { flow_time: 0.5, ..Fluvial::default() };
    let mut mapped = hills(64);
    mapped.insert("two", "1", Field::filled(square(64), 2.0));
    let two = || Some(LayerName::of("two"));
    run(&Fluvial { rain_map: two(), erodibility_map: two(), ..step.clone() }, &mut mapped);
    let mut doubled = hills(64);
    run(&Fluvial { rain: 80.0, erodibility: 6.0, ..step }, &mut doubled);
    assert_same(&mapped, &doubled);
    let step = Fluvial { rain_map: two(), erodibility_map: two(), flow_time: 0.1, ..Fluvial::default() };
    let [below, none] = [-1.0, 0.0].map(|least| {
        let mut land = hills(64);
        let map = Field::from_function(square(64), |x, y| if (x, y) == (3, 5) { least } else { 1.0 });
        land.insert("two", "1", map);
        let notes = step.run(&mut land, &Job::unwatched(1)).expect("it runs").notes.join("\n");
        assert_eq!(notes.contains("layer `two` goes down to -1"), least < 0.0, "{notes}");
        land
    });
    assert_same(&below, &none);
}

#[test]
fn a_river_brings_its_discharge() {
    let mut land = land(square(60), 20.0, |x, y| (60 - x) as f64 + (y as f64 - 29.5).abs());
    let source = Source { x: 300.0, y: 600.0, radius: 30.0, discharge: 25.0 };
    let step = Fluvial { sources: vec![Nested(source)], rain: 0.0, flow_time: 0.5, ..water_alone() };
    let water = run(&step, &mut land).water;
    let expected = 25.0 * 0.5 * 3600.0;
    assert!((water.incoming / expected - 1.0).abs() < 1e-4, "{} m³ came, not {expected}", water.incoming);
    // All of it runs down the valley.
    let across: f64 = (0..60).map(|y| f64::from(field(&land, "flux_x").at(40, y))).sum();
    assert!((across / 25.0 - 1.0).abs() < 0.01, "{across} m³/s run down the valley");
}
