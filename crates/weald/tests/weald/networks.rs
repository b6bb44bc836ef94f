//! The claims of Han 2015 by numbers: velocity makes rivers, fast dissolution does not, cones stay round.

use weald::analyse::contour::roundness;
use weald::analyse::network::{NetworkInput, NetworkMeasures, measure};
use weald::recipe::run_steps;
use weald::{Domain, Landscape, Size};

const SEEDS: [u64; 5] = [3, 5, 7, 11, 13];

/// 128² cells, 25 cells of relief, 2,400 steps: the end of a dry period.
fn eroded(seed: u64, keys: &str) -> NetworkMeasures {
    let mut land = Landscape::new(Domain::new(Size::square(128).expect("small"), 1.0));
    let keys = format!("iterations = 2400\n{keys}");
    let steps = [("diamond-square", "relief = 25.0\nroughness = 0.9"), ("hydraulic", &keys)];
    run_steps(&mut land, seed, &steps).expect("runs");
    let field = |name| land.field(name).expect("written");
    measure(&NetworkInput {
        ground: field("height"),
        before: None,
        depth: field("water"),
        mean_flux_x: field("flux_x"),
        mean_flux_y: field("flux_y"),
        mean_rain: 0.005,
        cell: 1.0,
        valid: None,
    })
}

/// Means of chan, reach and drains over the five seeds.
fn means(keys: &str) -> [f64; 3] {
    let all: Vec<NetworkMeasures> = SEEDS.iter().map(|&seed| eroded(seed, keys)).collect();
    let mean = |of: fn(&NetworkMeasures) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    let [chan, reach, drains] = [mean(|m| m.chan), mean(|m| m.reach), mean(|m| m.drains)];
    println!("{keys:?}: chan {chan:.4}, reach {reach:.3}, drains {drains:.3}");
    [chan, reach, drains]
}

#[test]
fn velocity_dependent_erosion_forms_networks_and_fast_dissolution_does_not() {
    let [water_alone, ..] = means("erosion = 0.0");
    let [chan, reach, drains] = means("");
    assert!(chan >= 2.0 * water_alone, "chan {chan} against {water_alone} of water alone");
    assert!(reach > 0.15, "reach {reach}");
    assert!(drains >= 0.3, "drains {drains}");
    let [chan, _, drains] = means("law = \"dissolution\"\ncapacity = 1.0\nerosion = 0.1");
    assert!(chan < 0.002, "dissolution: chan {chan}");
    assert!(drains < 0.1, "dissolution: drains {drains}");
}

/// A cone of slope 2 on 129² cells after 4,000 steps with talus 1: its roundness at half height.
fn slid_cone(scheme: &str) -> f64 {
    let mut land = Landscape::new(Domain::new(Size::square(129).expect("small"), 1.0));
    let keys = format!("scheme = {scheme:?}\ntalus = 1.0\nstrength = 0.2\niterations = 4000");
    run_steps(&mut land, 0, &[("cone", "peak = 64.0\nslope = 2.0"), ("thermal", &keys)]).expect("runs");
    let height = land.field("height").expect("written");
    let (low, high) = height.range(None).expect("cells");
    roundness(height, [64.0, 64.0], f64::from(low + high) / 2.0).expect("a closed contour")
}

#[test]
fn cones_stay_round_by_triangles_and_become_pyramids_by_axes() {
    for scheme in ["isotropic", "isotropic-symmetric"] {
        let round = slid_cone(scheme);
        assert!(round >= 0.98, "{scheme}: least over greatest radius is {round}");
    }
    let square = slid_cone("axis");
    assert!((0.79..0.83).contains(&square), "axis: {square} instead of 0.81");
}
