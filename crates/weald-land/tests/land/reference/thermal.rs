//! Eq. 17 to 21 of Han 2015, edge by edge and triangle by triangle.

use super::World;
use weald_land::erode::thermal::Scheme;

/// One step of sliding.
pub fn slide(world: &mut World, scheme: Scheme, talus: f64, strength: f64) {
    let ground = world.ground();
    let mut change = world.change.clone();
    match scheme {
        Scheme::Axis => {
            for edge in world.edges.iter().filter(|edge| world.rim(edge).is_none()) {
                let [a, b] = edge.cells;
                let step = ground[a] - ground[b];
                let excess = (step.abs() - talus).max(0.0) * step.signum() * strength;
                change[a] -= excess;
                change[b] += excess;
            }
        }
        Scheme::Isotropic => triangles(world, &ground, [1, 1], (talus, strength), &mut change),
        Scheme::IsotropicSymmetric => {
            for towards in [[1, 1], [1, -1], [-1, 1], [-1, -1]] {
                triangles(world, &ground, towards, (talus, strength / 4.0), &mut change);
            }
        }
    }
    world.change = change;
}

/// The triangles of all cells with their neighbours in two directions.
fn triangles(world: &World, ground: &[f64], towards: [i64; 2], rule: (f64, f64), change: &mut [f64]) {
    let (talus, strength) = rule;
    let (columns, rows) = (world.columns as i64, (ground.len() / world.columns) as i64);
    for at in 0..ground.len() as i64 {
        let (x, y) = (at % columns + towards[0], at / columns + towards[1]);
        if !(0..columns).contains(&x) || !(0..rows).contains(&y) {
            continue;
        }
        let [here, aside, below] = [at, at + towards[0], at + columns * towards[1]].map(|cell| cell as usize);
        if ![here, aside, below].iter().all(|&cell| world.valid[cell]) {
            continue;
        }
        let (dx, dy) = (ground[here] - ground[aside], ground[here] - ground[below]);
        let slope = dx.hypot(dy);
        if slope > talus {
            let share = strength * (slope - talus) / slope;
            change[here] -= share * (dx + dy);
            change[aside] += share * dx;
            change[below] += share * dy;
        }
    }
}
