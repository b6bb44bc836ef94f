//! Flux-corrected transport by lists of edges: upwind, then what antidiffusion may add.

use super::World;

/// Net flux of each edge from its first to its second cell, what of it antidiffusion would add, and whether
/// both cells hold data.
struct Face {
    cells: [usize; 2],
    net: f64,
    more: f64,
    inner: bool,
}

/// The sediment after the fluxes of a step; `depth` is the water before them.
pub fn carry(world: &World, depth: &[f64], epsilon: f64) -> Vec<f64> {
    let mut faces: Vec<Face> = world
        .edges
        .iter()
        .zip(&world.flux)
        .map(|(edge, flux)| {
            let inner = world.valid[edge.cells[0]] && world.valid[edge.cells[1]];
            Face { cells: edge.cells, net: flux[0] - flux[1], more: 0.0, inner }
        })
        .collect();
    let volume = volumes(&faces, depth, epsilon);
    let mixed: Vec<f64> = world.sediment.iter().zip(&volume).map(|(s, v)| s / v).collect();
    let (mut low, mut after) = (world.sediment.clone(), volume.clone());
    for face in &mut faces {
        let [a, b] = face.cells;
        let up = if face.net > 0.0 { a } else { b };
        low[a] -= face.net * mixed[up];
        low[b] += face.net * mixed[up];
        after[a] -= face.net;
        after[b] += face.net;
        if face.inner {
            face.more = face.net.abs() * (1.0 - face.net.abs() / volume[up]) * (mixed[b] - mixed[a]) / 2.0;
        }
    }
    let [gain, loss] = shares(&faces, &mixed, &low, &after);
    for face in &faces {
        let [a, b] = face.cells;
        let share = if face.more > 0.0 { f64::min(loss[a], gain[b]) } else { f64::min(gain[a], loss[b]) };
        low[a] -= face.more * share;
        low[b] += face.more * share;
    }
    low
}

fn volumes(faces: &[Face], depth: &[f64], epsilon: f64) -> Vec<f64> {
    let mut out = vec![0.0; depth.len()];
    for face in faces {
        out[face.cells[usize::from(face.net < 0.0)]] += face.net.abs();
    }
    depth.iter().zip(out).map(|(depth, out)| (depth.max(0.0) + epsilon).max(out)).collect()
}

/// Shares of the antidiffusive gains and losses of each cell that keep it within the concentrations around.
fn shares(faces: &[Face], mixed: &[f64], low: &[f64], after: &[f64]) -> [Vec<f64>; 2] {
    let own = |at: usize| [mixed[at], low[at] / after[at]];
    let mut least: Vec<f64> = (0..low.len()).map(|at| own(at)[0].min(own(at)[1])).collect();
    let mut most: Vec<f64> = (0..low.len()).map(|at| own(at)[0].max(own(at)[1])).collect();
    let (mut gained, mut lost) = (vec![0.0; low.len()], vec![0.0; low.len()]);
    for face in faces.iter().filter(|face| face.inner) {
        for [here, there] in [face.cells, [face.cells[1], face.cells[0]]] {
            least[here] = least[here].min(own(there)[0]).min(own(there)[1]);
            most[here] = most[here].max(own(there)[0]).max(own(there)[1]);
        }
        let [giver, taker] = if face.more > 0.0 { face.cells } else { [face.cells[1], face.cells[0]] };
        lost[giver] += face.more.abs();
        gained[taker] += face.more.abs();
    }
    let share = |room: f64, wanted: f64| if wanted > room { room.max(0.0) / wanted } else { 1.0 };
    let gain = (0..low.len()).map(|at| share(most[at] * after[at] - low[at], gained[at])).collect();
    let loss = (0..low.len()).map(|at| share(low[at] - least[at] * after[at], lost[at])).collect();
    [gain, loss]
}
