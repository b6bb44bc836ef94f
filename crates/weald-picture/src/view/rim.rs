//! The line along which land meets what has no data, as pieces of straight walls.
//!
//! Marching squares (Lorensen and Cline 1987, doi 10.1145/37402.37422, in the plane) over looks at the share of land, half
//! a cell apart; the line is where the share is a half.

use rayon::prelude::*;

use super::lit_scene::LitScene;
use super::surface::Surface;
use super::vector::Vector;

/// Looks a cell along each axis.
const SAMPLES_PER_CELL: usize = 2;

/// A piece of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Its ends, as places: in cells, of which the north-western corner is at 0.5.
    pub ends: [[f32; 2]; 2],
    /// Outward level normals at its ends, eastward and northward, of length 1.
    pub normals: [[f32; 2]; 2],
}

impl LitScene {
    /// All pieces, row by row; none where all is land.
    pub fn rims(&self) -> Vec<Rim> {
        let terrain = &self.setting.terrain;
        let (Some(land), Some(outline)) = (&terrain.land, &terrain.outline) else { return Vec::new() };
        let size = land.size();
        let rows = (0..SAMPLES_PER_CELL * size.rows).into_par_iter().map(|y| {
            let pieces = (0..SAMPLES_PER_CELL * size.columns).flat_map(|x| square(land, [x, y]));
            pieces
                .map(|ends| Rim { ends, normals: ends.map(|end| normal(outline, terrain.spacing, end)) })
                .collect()
        });
        rows.collect::<Vec<Vec<Rim>>>().concat()
    }
}

/// Pieces of the line within a square of four looks.
fn square(land: &Surface, [x, y]: [usize; 2]) -> Vec<[[f32; 2]; 2]> {
    let place =
        |dx: usize, dy: usize| [x + dx, y + dy].map(|look| 0.5 + look as f32 / SAMPLES_PER_CELL as f32);
    let corners = [place(0, 0), place(1, 0), place(1, 1), place(0, 1)];
    let shares = corners.map(|corner| land.at(corner) - 0.5);
    let crossings: Vec<[f32; 2]> = (0..4)
        .filter_map(|at| {
            let (from, to) = (at, (at + 1) % 4);
            let crosses = (shares[from] >= 0.0) != (shares[to] >= 0.0);
            crosses.then(|| {
                let share = shares[from] / (shares[from] - shares[to]);
                [0, 1].map(|axis| corners[from][axis] + share * (corners[to][axis] - corners[from][axis]))
            })
        })
        .collect();
    match crossings[..] {
        [a, b] => vec![[a, b]],
        // Two opposite corners are land: each pair of neighbouring crossings cuts one corner off.
        [a, b, c, d] if shares[0] >= 0.0 => vec![[a, b], [c, d]],
        [a, b, c, d] => vec![[d, a], [b, c]],
        _ => Vec::new(),
    }
}

fn normal(outline: &Surface, spacing: [f32; 2], place: [f32; 2]) -> [f32; 2] {
    let [_, east, south] = outline.with_slope(place);
    let outward: Vector = [-east / spacing[0], south / spacing[1], 0.0];
    let length = (outward[0] * outward[0] + outward[1] * outward[1]).sqrt().max(1e-12);
    [outward[0] / length, outward[1] / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;
    use weald_core::domain::Domain;
    use weald_core::grid::{Field, Mask, Size};
    use weald_core::landscape::Landscape;

    #[test]
    fn the_rim_of_a_round_island_goes_once_round_it_and_faces_outward() {
        let size = Size::square(40).expect("small");
        let away = |cell: usize| {
            let [x, y] = [cell % 40, cell / 40].map(|at| at as f32 - 19.5);
            (x * x + y * y).sqrt()
        };
        let mut domain = Domain::new(size, 10.0);
        domain.valid = Mask::new(size, (0..1600).map(|cell| away(cell) < 12.0).collect());
        let mut landscape = Landscape::new(domain);
        landscape.insert("height", "m", Field::filled(size, 5.0));
        let rims = LitScene::new(&View::default(), &landscape).expect("it can be drawn").rims();
        let (mut round, mut middle) = (0.0, [0.0_f32; 2]);
        for Rim { ends: [a, b], normals } in &rims {
            round += (a[0] - b[0]).hypot(a[1] - b[1]);
            let from = [a[0] - 20.5, a[1] - 20.5];
            let outward = (from[0] * normals[0][0] - from[1] * normals[0][1]) / from[0].hypot(from[1]);
            assert!(outward > 0.9, "{a:?} faces {:?}", normals[0]);
            for (sum, axis) in middle.iter_mut().zip([0, 1]) {
                *sum += 0.5 * (a[axis] + b[axis]) - 20.5;
            }
        }
        let expected = std::f32::consts::TAU * 12.0;
        assert!((round / expected - 1.0).abs() < 0.06, "{round} cells instead of {expected}");
        assert!(
            middle.iter().all(|sum| sum.abs() < 0.05 * rims.len() as f32),
            "{middle:?} of {}",
            rims.len()
        );
    }
}
