//! The published equations once more, as plainly as they can be written: `f64`, one list of edges, no rows in
//! flight, no fusing, nothing shared with the engine. Slow, and meant to be compared with.
#![allow(
    dead_code,
    unreachable_pub,
    reason = "the modules of a test belong to it alone, and it uses its own part"
)]

pub mod advection;
pub mod flux_corrected;
pub mod numbers;
pub mod stava;
pub mod thermal;

use weald_core::parameter::Nested;
use weald_land::erode::hydraulic::{Boundary, Hydraulic, Model, Slope, Transport, UptakeLaw};

use numbers::Numbers;

/// Two neighbouring cells, the western or northern first, and whether they lie side by side in a row.
pub struct Edge {
    pub cells: [usize; 2],
    pub across: bool,
}

/// Ground, water and sediment of a subdomain with cells of 1 m.
pub struct World {
    pub columns: usize,
    pub valid: Vec<bool>,
    pub edges: Vec<Edge>,
    pub start: Vec<f64>,
    pub change: Vec<f64>,
    /// What lies on the bedrock, where `start` and `change` are the bedrock alone.
    pub piled: Vec<f64>,
    pub depth: Vec<f64>,
    pub sediment: Vec<f64>,
    /// Flow through each edge from its first to its second cell, and the other way round. Han has one signed
    /// flux, which stands in the first.
    pub flux: Vec<[f64; 2]>,
}

/// What the water of a step leaves for the settling.
struct Moved {
    /// Velocity of each cell, east and south.
    velocity: Vec<[f64; 2]>,
    found: Vec<f64>,
}

impl World {
    pub fn new(columns: usize, start: Vec<f64>, land: Vec<bool>, boundary: Boundary) -> Self {
        let open = boundary == Boundary::Open;
        let mut edges = Vec::new();
        for at in 0..land.len() {
            let east = ((at + 1) % columns != 0).then_some((at + 1, true));
            let south = (at + columns < land.len()).then_some((at + columns, false));
            for (next, across) in [east, south].into_iter().flatten() {
                if land[at] && land[next] || open && land[at] != land[next] {
                    edges.push(Edge { cells: [at, next], across });
                }
            }
        }
        let zeros = vec![0.0; land.len()];
        let flux = vec![[0.0; 2]; edges.len()];
        let [change, piled, depth, sediment] = [(); 4].map(|()| zeros.clone());
        Self { columns, valid: land, edges, start, change, piled, depth, sediment, flux }
    }

    /// One step of a simulation, all of whose numbers must be given.
    pub fn step(&mut self, step: &Hydraulic, number: u32) {
        let keys = &Numbers::of(step);
        let dry = keys.dry_period;
        let raining = number % (keys.rain_period + dry) < keys.rain_period;
        let rain = if raining { keys.rain } else { 0.0 };
        let evaporation = keys.evaporation;
        match step.model {
            Model::Han(_) => self.han(keys, rain, if raining { 0.0 } else { evaporation }),
            Model::Mei(_) => self.mei(keys, rain, evaporation),
            Model::Stava(_) => unreachable!("the layers of stava are in a module of their own"),
        }
        if let Some(Nested(thermal)) = &keys.thermal {
            thermal::slide(self, thermal.scheme, thermal.talus, thermal.strength);
        }
    }

    fn ground(&self) -> Vec<f64> {
        (0..self.start.len()).map(|at| self.start[at] + self.change[at] + self.piled[at]).collect()
    }

    /// The edge's cell with data, where it has but one, and the sign of a flux out of it.
    fn rim(&self, edge: &Edge) -> Option<(usize, f64)> {
        let [a, b] = edge.cells;
        match (self.valid[a], self.valid[b]) {
            (true, false) => Some((a, 1.0)),
            (false, true) => Some((b, -1.0)),
            _ => None,
        }
    }

    /// What flows out of each cell.
    fn outflow(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.valid.len()];
        for (edge, flux) in self.edges.iter().zip(&self.flux) {
            let [a, b] = edge.cells;
            out[a] += flux[0].max(0.0) + (-flux[1]).max(0.0);
            out[b] += flux[1].max(0.0) + (-flux[0]).max(0.0);
        }
        out
    }

    /// Scales every flux to what its giving cell can give.
    fn limit(&mut self, depth: &[f64]) {
        let available =
            |(depth, out): (&f64, f64)| if out > depth.max(0.0) { depth.max(0.0) / out } else { 1.0 };
        let share: Vec<f64> = depth.iter().zip(self.outflow()).map(available).collect();
        for (edge, flux) in self.edges.iter().zip(&mut self.flux) {
            let [a, b] = edge.cells;
            flux[0] *= share[if flux[0] > 0.0 { a } else { b }];
            flux[1] *= share[b];
        }
    }

    /// Moves `amount` a unit of flux out of the giving cells.
    fn carry(&self, into: &mut [f64], amount: impl Fn(usize) -> f64) {
        for (edge, flux) in self.edges.iter().zip(&self.flux) {
            let [a, b] = edge.cells;
            let moved = flux[0] * amount(if flux[0] > 0.0 { a } else { b }) - flux[1] * amount(b);
            into[a] -= moved;
            into[b] += moved;
        }
    }

    /// Sediment in a unit of flux: what stands in the water, and no more than the cell has.
    fn concentration(&self, sediment: &[f64], depth: &[f64], keys: &Numbers) -> Vec<f64> {
        let out = self.outflow();
        let epsilon = keys.epsilon;
        let thick = |at: usize| {
            let wet = depth[at].max(0.0) + epsilon;
            if keys.limiter { wet } else { wet.max(out[at]) }
        };
        (0..depth.len()).map(|at| sediment[at] / thick(at)).collect()
    }

    /// Mean sine of the slopes to the neighbours with data.
    fn sines(&self) -> Vec<f64> {
        let ground = self.ground();
        let (mut sum, mut count) = (vec![0.0; ground.len()], vec![0.0; ground.len()]);
        for edge in self.edges.iter().filter(|edge| self.rim(edge).is_none()) {
            let rise: f64 = ground[edge.cells[1]] - ground[edge.cells[0]];
            for cell in edge.cells {
                sum[cell] += rise.abs() / (1.0 + rise * rise).sqrt();
                count[cell] += 1.0;
            }
        }
        sum.iter().zip(count).map(|(sum, count): (_, f64)| sum / count.max(1.0)).collect()
    }

    /// Sine of the tilt: means of the rises along both axes, to the neighbours with data.
    fn tilts(&self) -> Vec<f64> {
        let ground = self.ground();
        let (mut sum, mut count) = (vec![[0.0; 2]; ground.len()], vec![[0.0_f64; 2]; ground.len()]);
        for edge in self.edges.iter().filter(|edge| self.rim(edge).is_none()) {
            for cell in edge.cells {
                sum[cell][usize::from(!edge.across)] += ground[edge.cells[1]] - ground[edge.cells[0]];
                count[cell][usize::from(!edge.across)] += 1.0;
            }
        }
        let tilt = |(sum, count): ([f64; 2], [f64; 2])| {
            (sum[0] / count[0].max(1.0)).hypot(sum[1] / count[1].max(1.0)).atan().sin()
        };
        sum.into_iter().zip(count).map(tilt).collect()
    }

    /// Cells whose ground water may change: those with data that do not lie along open edges.
    fn yielding(&self) -> Vec<usize> {
        let rims = |cell: usize| {
            self.edges.iter().any(|edge| edge.cells.contains(&cell) && self.rim(edge).is_some())
        };
        (0..self.valid.len()).filter(|&cell| self.valid[cell] && !rims(cell)).collect()
    }

    fn drain(&mut self) {
        for at in (0..self.valid.len()).filter(|&at| !self.valid[at]) {
            (self.depth[at], self.sediment[at]) = (0.0, 0.0);
        }
    }

    /// Han 2015, stages 1 to 5.
    fn han(&mut self, keys: &Numbers, rain: f64, evaporation: f64) {
        self.accelerate(keys.flow_rate);
        if keys.limiter {
            self.limit(&self.depth.clone());
        }
        let sines = self.sines();
        let mut found = self.sediment.clone();
        if keys.transport == Transport::Upwind {
            let concentration = self.concentration(&self.sediment, &self.depth, keys);
            self.carry(&mut found, |giver| concentration[giver]);
        }
        let mut depth = self.depth.clone();
        self.carry(&mut depth, |_| 1.0);
        let before = self.depth.clone();
        for (depth, _) in depth.iter_mut().zip(&self.valid).filter(|(_, land)| **land) {
            *depth += rain - depth.max(0.0).min(evaporation);
        }
        self.depth = depth;
        self.sediment.clone_from(&found);
        self.drain();
        let moved = Moved { velocity: self.face_velocities(keys), found: self.sediment.clone() };
        self.settle_han(keys, &sines, &moved);
        self.advect(keys, &moved.velocity, &before);
    }

    /// Eq. 4 to 6, and the free fall over open edges.
    fn accelerate(&mut self, flow_rate: f64) {
        let ground = self.ground();
        let surface = |at: usize| ground[at] + self.depth[at];
        let mut flux = self.flux.clone();
        for (edge, flux) in self.edges.iter().zip(&mut flux) {
            let [a, b] = edge.cells;
            if let Some((inner, sign)) = self.rim(edge) {
                let gained = flux[0] + sign * flow_rate * (self.depth[inner] + self.change[inner]);
                flux[0] = if gained * sign > 0.0 { gained } else { 0.0 };
                continue;
            }
            let drop = surface(a) - surface(b);
            if self.depth[if drop > 0.0 { a } else { b }] > 0.0 {
                flux[0] += flow_rate * drop;
            }
            if self.depth[if flux[0] > 0.0 { a } else { b }] <= 0.0 {
                flux[0] = 0.0;
            }
        }
        self.flux = flux;
    }

    /// Eq. 11: flux over the cross-section between two cells; a cell has the mean of its faces.
    fn face_velocities(&self, keys: &Numbers) -> Vec<[f64; 2]> {
        let mut velocity = vec![[0.0; 2]; self.valid.len()];
        for (edge, flux) in self.edges.iter().zip(&self.flux) {
            let thick = edge.cells.map(|cell| self.depth[cell].max(0.0)).iter().sum::<f64>() / 2.0;
            let speed = flux[0] / (thick + keys.velocity_epsilon);
            for cell in edge.cells {
                velocity[cell][usize::from(!edge.across)] += speed / 2.0;
            }
        }
        velocity
    }

    /// Eq. 10 and 12 to 16.
    fn settle_han(&mut self, keys: &Numbers, sines: &[f64], moved: &Moved) {
        let (capacity, erosion) = (keys.capacity, keys.erosion);
        for at in self.yielding() {
            let speed = moved.velocity[at][0].hypot(moved.velocity[at][1]);
            let most = capacity * speed * sines[at] * self.depth[at].max(0.0);
            let found = moved.found[at];
            let uptake = match keys.law {
                UptakeLaw::Velocity => erosion * speed,
                UptakeLaw::Dissolution => erosion * (most - found).max(0.0),
            };
            let net = (found + uptake).min(most) - found;
            self.sediment[at] = found + net;
            self.change[at] -= if net > 0.0 { net } else { net * keys.deposit_ratio };
        }
    }

    /// Mei et al. 2007, steps 1 to 5.
    fn mei(&mut self, keys: &Numbers, rain: f64, evaporation: f64) {
        let land = self.valid.iter().zip(&self.depth);
        let rained: Vec<f64> = land.map(|(&land, depth)| depth + if land { rain } else { 0.0 }).collect();
        self.pour(keys.flow_rate, &rained);
        if keys.limiter {
            self.limit(&rained);
        }
        let mut flowed = rained.clone();
        self.carry(&mut flowed, |_| 1.0);
        let velocity = self.velocities_mei(keys, &rained, &flowed);
        self.depth = flowed.iter().map(|depth| depth * (1.0 - evaporation)).collect();
        let sines = match keys.slope {
            Slope::MeanSine => self.sines(),
            Slope::Central => self.tilts(),
        };
        self.exchange(keys, &sines, &velocity);
        self.drain();
        if keys.transport == Transport::Upwind {
            let mut carried = self.sediment.clone();
            let concentration = self.concentration(&self.sediment, &rained, keys);
            self.carry(&mut carried, |giver| concentration[giver]);
            self.sediment = carried;
        } else {
            self.advect(keys, &velocity, &rained);
        }
    }

    fn pour(&mut self, flow_rate: f64, depth: &[f64]) {
        let ground = self.ground();
        let mut flux = self.flux.clone();
        for (edge, flux) in self.edges.iter().zip(&mut flux) {
            let [a, b] = edge.cells;
            let drop = match self.rim(edge) {
                Some((inner, sign)) => sign * (depth[inner] + self.change[inner]),
                None => ground[a] + depth[a] - ground[b] - depth[b],
            };
            *flux = [(flux[0] + flow_rate * drop).max(0.0), (flux[1] - flow_rate * drop).max(0.0)];
            if let Some((_, sign)) = self.rim(edge) {
                flux[usize::from(sign > 0.0)] = 0.0;
            }
        }
        self.flux = flux;
    }

    fn velocities_mei(&self, keys: &Numbers, before: &[f64], after: &[f64]) -> Vec<[f64; 2]> {
        let mut velocity = vec![[0.0; 2]; self.valid.len()];
        for (edge, flux) in self.edges.iter().zip(&self.flux) {
            for cell in edge.cells {
                let mean_depth = f64::midpoint(before[cell], after[cell]);
                if mean_depth > keys.velocity_epsilon {
                    velocity[cell][usize::from(!edge.across)] += (flux[0] - flux[1]) / 2.0 / mean_depth;
                }
            }
        }
        velocity
    }

    fn exchange(&mut self, keys: &Numbers, sines: &[f64], velocity: &[[f64; 2]]) {
        let (capacity, erosion) = (keys.capacity, keys.erosion);
        for at in self.yielding() {
            let speed = velocity[at][0].hypot(velocity[at][1]);
            let room = capacity * sines[at].max(0.05) * speed - self.sediment[at];
            let net = room * if room > 0.0 { erosion } else { keys.deposition };
            self.sediment[at] += net;
            self.change[at] -= if net > 0.0 { net } else { net * keys.deposit_ratio };
        }
    }

    fn advect(&mut self, keys: &Numbers, velocity: &[[f64; 2]], depth_before: &[f64]) {
        self.sediment = match keys.transport {
            Transport::Upwind => return,
            Transport::MacCormack if keys.conserve => flux_corrected::carry(self, depth_before, keys.epsilon),
            Transport::SemiLagrangian => advection::depart(self, &self.sediment, velocity, 1.0),
            Transport::MacCormack => advection::maccormack(self, velocity),
        };
    }
}
