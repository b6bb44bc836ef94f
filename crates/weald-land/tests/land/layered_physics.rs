//! Who yields first: hard and soft layers, springs and outlets, taluses, solubilities.

use crate::common::{field, hydraulic, landscape, materials, metres, run, worst_difference};
use weald_core::parameter::{LayerName, Nested};
use weald_core::{Field, Landscape, Size};
use weald_land::erode::dissolution_step::DissolutionStep;
use weald_land::erode::hydraulic::{Boundary, Hydraulic, StavaKeys};
use weald_land::erode::slippage_step::SlippageStep;
use weald_land::erode::springs::Spring;

#[test]
fn a_hard_layer_under_a_soft_one_protects_what_is_below() {
    let size = Size::new(60, 24).expect("small");
    let slope = Field::from_function(size, |x, _| 0.3 * (60 - x) as f32);
    let eroded = |hard: &str| {
        let mut land = landscape(slope.clone());
        land.materials = materials(&["sand", hard, "sand"]);
        land.materials[1].erodibility = 1e-6;
        land.materials[2].name = "cover".to_owned();
        land.insert(hard, "m", Field::filled(size, if hard == "rock" { 0.5 } else { 0.0 }));
        land.insert("cover", "m", Field::filled(size, 0.2));
        let boundary = Boundary::Open;
        let deposit = Some(LayerName::of("cover"));
        let model = StavaKeys { deposit, deposition: 0.0, ..StavaKeys::default() }.into();
        run(&Hydraulic { model, boundary, ..hydraulic(600) }, &mut land);
        land
    };
    let (protected, bare) = (eroded("rock"), eroded("clay"));
    let inner =
        |land: &Landscape, name: &str| -> Vec<f32> { (8..50).map(|x| field(land, name).at(x, 12)).collect() };
    let (cover, rock) = (inner(&protected, "cover"), inner(&protected, "rock"));
    let gone = cover.iter().filter(|&&left| left < 0.01).count();
    assert!(gone > 20, "the soft cover is gone in {gone} of 42 cells: {cover:?}");
    assert!(rock.iter().all(|&left| left > 0.3), "the hard layer stands: {rock:?}");
    let fallen = |land: &Landscape| -> f32 {
        let start = inner(land, "bedrock").into_iter().zip(8..50);
        start.map(|(now, x)| slope.at(x, 12) - 0.2 - now).sum::<f32>() / 42.0
    };
    assert!(fallen(&bare) > 0.1, "without it the water digs {} m deeper", fallen(&bare));
    assert!((fallen(&protected) - 0.5).abs() < 1e-5, "under it nothing moved: {}", fallen(&protected));
}

/// A valley floor with a bowl, whose outlet is a notch in its eastern rim.
fn basin() -> Landscape {
    let size = Size::new(60, 31).expect("small");
    let ground = Field::from_function(size, |x, y| {
        let away = ((x as f32 - 20.0).powi(2) + (y as f32 - 15.0).powi(2)).sqrt();
        let bowl = 10.0 + (away - 10.0).clamp(-6.0, 0.0);
        if y == 15 && x > 20 { bowl.min(9.0 - 0.2 * (x as f32 - 33.0).max(0.0)) } else { bowl }
    });
    landscape(ground)
}

#[test]
fn a_source_fills_a_basin_to_its_outlet_and_then_spills() {
    let mut land = basin();
    let sources = vec![Nested(Spring { x: 20.5, y: 15.5, radius: 2.0, rate: 0.05 })];
    let level = |land: &Landscape, x, y| field(land, "height").at(x, y) + field(land, "water").at(x, y);
    let filled = |land: &mut Landscape, iterations| {
        let sources = sources.clone();
        let [rain, evaporation] = [metres(0.0); 2];
        let keys = StavaKeys { sources, rain, evaporation, erosion: 0.0, ..StavaKeys::default() };
        let still = Hydraulic { model: keys.into(), boundary: Boundary::Open, ..hydraulic(iterations) };
        run(&still, land).budget.expect("a budget").water
    };
    let early = filled(&mut land, 300);
    assert_eq!(early.outgoing, 0.0, "the basin holds its water at first");
    assert!(level(&land, 20, 15) > 5.0 && level(&land, 20, 15) < 9.0, "{}", level(&land, 20, 15));
    let late = filled(&mut land, 4000);
    let (lake, sill) = (level(&land, 20, 15), 9.0);
    assert!((lake - sill).abs() < 0.6, "the lake stands at {lake} m, its outlet at {sill} m");
    assert!(late.outgoing > 0.5 * late.incoming, "it spills: {late:?}");
    assert!(field(&land, "water").at(50, 15) > 1e-3, "through the notch");
    assert!(field(&land, "water").at(5, 15) < 1e-3, "and nowhere else");
}

#[test]
fn slippage_ends_with_every_material_on_its_talus() {
    let size = Size::square(48).expect("small");
    let away = |x: usize, y: usize| ((x as f32 - 23.5).powi(2) + (y as f32 - 23.5).powi(2)).sqrt();
    let mut land = landscape(Field::from_function(size, |x, y| 10.0 + (12.0 - away(x, y)).max(0.0) * 1.2));
    land.materials = materials(&["rock", "clay", "sand"]);
    land.insert("clay", "m", Field::from_function(size, |x, y| (8.0 - away(x, y)).max(0.0)));
    land.insert("sand", "m", Field::from_function(size, |x, y| (6.0 - away(x, y)).max(0.0) * 0.4));
    let before = land.clone();
    run(&SlippageStep { strength: 0.08, iterations: 6000, ..SlippageStep::default() }, &mut land);
    assert!(worst_difference(field(&before, "height"), field(&land, "height")) > 1.0, "something slid");
    let mut top = field(&land, "bedrock").clone();
    for material in &land.materials {
        if let Ok(layer) = land.field(&material.name) {
            top = Field::from_function(size, |x, y| top.at(x, y) + layer.at(x, y));
            let talus = (material.talus_deg as f32).to_radians().tan();
            let steepest = steepest_where(&top, layer);
            assert!(steepest < talus * 1.02, "{} lies at {steepest}, but rests at {talus}", material.name);
        }
    }
}

/// Steepest step down from a cell that holds some of a layer.
fn steepest_where(top: &Field, layer: &Field) -> f32 {
    let Size { columns, rows } = top.size();
    let inner = (1..rows - 1).flat_map(|y| (1..columns - 1).map(move |x| (x, y)));
    let drop = |(x, y): (usize, usize)| {
        let around = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        around.iter().map(|&(nx, ny)| top.at(x, y) - top.at(nx, ny)).fold(0.0, f32::max)
    };
    inner.filter(|&(x, y)| layer.at(x, y) > 0.01).map(drop).fold(0.0, f32::max)
}

/// Soil that falls eastward, under two metres of water in its western half.
fn shore(fall: f32) -> Landscape {
    let size = Size::square(32).expect("small");
    let mut land = landscape(Field::from_function(size, |x, _| 5.0 - fall * x as f32));
    land.insert("soil", "m", Field::filled(size, 1.0));
    land.insert("pond", "m", Field::from_function(size, |x, _| if x < 16 { 2.0 } else { 0.0 }));
    land
}

#[test]
fn dissolution_soaks_no_deeper_than_its_depth_and_what_creeps_ashore_settles() {
    let water = LayerName::of("pond");
    let step = DissolutionStep { depth: 0.3, water, iterations: 400, ..DissolutionStep::default() };
    let mut level = shore(0.0);
    run(&step, &mut level);
    let (_, most) = field(&level, "regolith").range(None).expect("cells");
    assert!(most > 0.29 && most <= 0.3 + 1e-6, "regolith stands {most} m deep");
    let (wet, dry) = (field(&level, "soil").at(3, 10), field(&level, "soil").at(28, 10));
    assert!((wet - (1.0 - most)).abs() < 1e-5, "it came out of the soil: {wet} m are left");
    assert_eq!(dry, 1.0, "dry ground does not dissolve");
    let mut falling = shore(0.1);
    run(&step, &mut falling);
    let (shore, inland) = (field(&falling, "soil").at(16, 10), field(&falling, "soil").at(28, 10));
    assert!(shore > 1.1, "what crept ashore settled there: {shore} m");
    assert!(inland < 1.0 + 0.5 * (shore - 1.0), "rather than beyond: {inland} m, {shore} m at the shore");
}

#[test]
fn solubility_and_cover_decide_what_dissolves() {
    let size = Size::new(30, 8).expect("small");
    let mut land = landscape(Field::filled(size, 5.0));
    land.materials = materials(&["rock", "soil"]);
    land.insert("soil", "m", Field::from_function(size, |x, _| if x < 15 { 2.0 } else { 0.0 }));
    land.insert("sea", "m", Field::filled(size, 3.0));
    let before = field(&land, "height").clone();
    let water = LayerName::of("sea");
    run(
        &DissolutionStep { depth: 0.2, damping: 1.0, water, iterations: 5, ..DissolutionStep::default() },
        &mut land,
    );
    let (soft, hard) = (field(&land, "regolith").at(3, 4), field(&land, "regolith").at(25, 4));
    assert!(soft > 20.0 * hard && hard > 0.0, "soil gives {soft} m, rock {hard} m");
    let covered = before.at(3, 4) - 2.0 - field(&land, "bedrock").at(3, 4);
    assert_eq!(covered, 0.0, "rock under soil stays");
}
