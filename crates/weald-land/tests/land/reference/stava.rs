//! Šťava et al. 2008 on a list of edges: columns of materials, regolith, painted weather.

use super::World;
use super::numbers::Numbers;
use weald_core::material::Material;
use weald_core::parameter::Nested;
use weald_land::erode::hydraulic::{Hydraulic, Model, StavaKeys, Transport};

/// A subdomain of stacked materials.
pub struct Column {
    /// Its bedrock, water and sediment; `piled` is all that lies on the bedrock.
    pub world: World,
    pub materials: Vec<Material>,
    /// Thickness of every material above the bedrock.
    pub layers: Vec<Vec<f64>>,
    pub regolith: Vec<f64>,
    /// Flow of regolith along each edge, both ways.
    creep: Vec<[f64; 2]>,
    pub rain_share: Vec<f64>,
    pub evaporation_share: Vec<f64>,
    pub source: Vec<f64>,
}

impl Column {
    /// Layers on a bedrock; the world's start is the whole ground.
    pub fn new(mut world: World, materials: Vec<Material>, layers: Vec<Vec<f64>>) -> Self {
        for layer in &layers {
            for (start, thickness) in world.start.iter_mut().zip(layer) {
                *start -= thickness;
            }
        }
        let cells = world.valid.len();
        let creep = vec![[0.0; 2]; world.edges.len()];
        let [ones, zeros] = [1.0, 0.0].map(|value| vec![value; cells]);
        let (rain_share, evaporation_share) = (ones.clone(), ones);
        let (regolith, source) = (zeros.clone(), zeros);
        let mut all =
            Self { world, materials, layers, regolith, creep, rain_share, evaporation_share, source };
        all.pile();
        all
    }

    fn pile(&mut self) {
        for (at, piled) in self.world.piled.iter_mut().enumerate() {
            *piled = self.regolith[at] + self.layers.iter().map(|layer| layer[at]).sum::<f64>();
        }
    }

    /// Height of the top of a material, bedrock 0.
    fn top(&self, material: usize) -> Vec<f64> {
        let bedrock = self.world.start.iter().zip(&self.world.change).map(|(start, change)| start + change);
        let lying = |at: usize| self.layers[..material].iter().map(|layer| layer[at]).sum::<f64>();
        bedrock.enumerate().map(|(at, bedrock)| bedrock + lying(at)).collect()
    }

    /// One step of a simulation by Šťava et al., all of whose numbers must be given.
    pub fn step(&mut self, step: &Hydraulic, number: u32) {
        let Model::Stava(own) = &step.model else { panic!("another model") };
        let keys = &Numbers::of(step);
        let dry = keys.dry_period;
        let raining = number % (keys.rain_period + dry) < keys.rain_period;
        let rain = if raining { keys.rain } else { 0.0 };
        let evaporation = if raining && dry > 0 { 0.0 } else { keys.evaporation };
        self.weather(rain, evaporation, keys.epsilon);
        let rained = self.world.depth.clone();
        self.pour(keys.flow_rate);
        self.world.limit(&rained);
        let mut flowed = rained.clone();
        self.world.carry(&mut flowed, |_| 1.0);
        let mut velocity = self.world.velocities_mei(keys, &rained, &flowed);
        if own.viscosity > 0.0 {
            (0..2).for_each(|_| velocity = self.diffused(&velocity, own.viscosity));
        }
        self.world.depth = flowed;
        self.erode(own, &velocity);
        self.dissolve(own);
        self.world.drain();
        self.transport(keys, &rained, &velocity);
        if let Some(Nested(within)) = &own.dissolution {
            self.creep(keys.flow_rate, 1.0 - within.damping);
        }
        if let Some(Nested(within)) = &own.slippage {
            self.slip(within.strength, within.softening);
        }
        self.pile();
    }

    fn weather(&mut self, rain: f64, evaporation: f64, epsilon: f64) {
        for at in (0..self.world.valid.len()).filter(|&at| self.world.valid[at]) {
            let wet = self.world.depth[at] + rain * self.rain_share[at] + self.source[at].max(0.0);
            let dried = evaporation * self.evaporation_share[at] - self.source[at].min(0.0);
            let drained = (-self.source[at]).max(0.0).min(wet);
            self.world.sediment[at] *= 1.0 - drained / (wet + epsilon);
            self.world.depth[at] = (wet - dried).max(0.0);
        }
    }

    fn pour(&mut self, flow_rate: f64) {
        let (ground, world) = (self.world.ground(), &self.world);
        let poured = world.edges.iter().zip(&world.flux).map(|(edge, flux)| {
            let [a, b] = edge.cells;
            let rim = world.rim(edge);
            let drop = match rim {
                Some((inner, sign)) => sign * world.depth[inner],
                None => ground[a] + world.depth[a] - ground[b] - world.depth[b],
            };
            let mut poured = [(flux[0] + flow_rate * drop).max(0.0), (flux[1] - flow_rate * drop).max(0.0)];
            if let Some((_, sign)) = rim {
                poured[usize::from(sign > 0.0)] = 0.0;
            }
            poured
        });
        self.world.flux = poured.collect();
    }

    /// One Jacobi sweep; beyond walls stands the cell's own velocity.
    fn diffused(&self, velocity: &[[f64; 2]], viscosity: f64) -> Vec<[f64; 2]> {
        let c = 1.0 / viscosity;
        let mut sums: Vec<[f64; 2]> = velocity.iter().map(|v| v.map(|v| (4.0 + c) * v)).collect();
        for edge in self.world.edges.iter().filter(|edge| self.world.rim(edge).is_none()) {
            let [a, b] = edge.cells;
            for axis in 0..2 {
                sums[a][axis] += velocity[b][axis] - velocity[a][axis];
                sums[b][axis] += velocity[a][axis] - velocity[b][axis];
            }
        }
        sums.into_iter().map(|sum| sum.map(|sum| sum / (4.0 + c))).collect()
    }

    /// Takes from the column of a cell from the top down, or lays down; gives what came out of it.
    fn dig(&mut self, at: usize, room: f64, share: impl Fn(&Material) -> f64, deposit: (usize, f64)) -> f64 {
        if room < 0.0 {
            let settled = -room * deposit.1;
            match deposit.0 {
                0 => self.world.change[at] += settled,
                material => self.layers[material - 1][at] += settled,
            }
            return -settled;
        }
        let (mut above, mut taken) = (0.0, 0.0);
        for material in (0..self.materials.len()).rev() {
            if above >= room {
                break;
            }
            let wanted = share(&self.materials[material]) * (room - above);
            if material == 0 {
                self.world.change[at] -= wanted;
                taken += wanted;
            } else {
                let thickness = &mut self.layers[material - 1][at];
                above += *thickness;
                taken += wanted.min(*thickness);
                *thickness -= wanted.min(*thickness);
            }
        }
        taken
    }

    fn deposit(&self, keys: &StavaKeys) -> usize {
        let named = |material: &Material| keys.deposit.as_ref().is_some_and(|name| name.0 == material.name);
        self.materials.iter().position(named).unwrap_or(self.materials.len() - 1)
    }

    fn erode(&mut self, keys: &StavaKeys, velocity: &[[f64; 2]]) {
        let (capacity, erosion) = (keys.capacity, keys.erosion);
        let (sines, deposit) = (self.world.sines(), self.deposit(keys));
        for at in self.world.yielding() {
            let speed = velocity[at][0].hypot(velocity[at][1]);
            let room = capacity * sines[at].max(0.1) * speed - self.world.sediment[at];
            let share = |material: &Material| (material.erodibility * erosion).min(1.0);
            self.world.sediment[at] += self.dig(at, room, share, (deposit, keys.deposition));
        }
    }

    fn dissolve(&mut self, keys: &StavaKeys) {
        let Some(Nested(within)) = &keys.dissolution else { return };
        let deposit = self.deposit(keys);
        for at in self.world.yielding() {
            let missing = self.world.depth[at].min(within.depth) - self.regolith[at];
            self.regolith[at] += self.dig(at, missing, |material| material.solubility, (deposit, 1.0));
        }
    }

    fn transport(&mut self, keys: &Numbers, rained: &[f64], velocity: &[[f64; 2]]) {
        if keys.transport != Transport::Upwind {
            return self.world.advect(keys, velocity, rained);
        }
        let mut carried = self.world.sediment.clone();
        let concentration = self.world.concentration(&self.world.sediment, rained, keys);
        self.world.carry(&mut carried, |giver| concentration[giver]);
        self.world.sediment = carried;
    }

    fn inner_edges(&self) -> Vec<usize> {
        let edges = self.world.edges.iter().enumerate();
        edges.filter(|(_, edge)| self.world.rim(edge).is_none()).map(|(number, _)| number).collect()
    }

    fn creep(&mut self, flow_rate: f64, kept: f64) {
        self.pile();
        let (surface, mut out) = (self.world.ground(), vec![0.0; self.regolith.len()]);
        let inner = self.inner_edges();
        for &number in &inner {
            let [a, b] = self.world.edges[number].cells;
            let gained = flow_rate * (surface[a] - surface[b]);
            let flow = self.creep[number];
            self.creep[number] = [(kept * flow[0] + gained).max(0.0), (kept * flow[1] - gained).max(0.0)];
            out[a] += self.creep[number][0];
            out[b] += self.creep[number][1];
        }
        let before = self.regolith.clone();
        let share = |cell: usize| if out[cell] > before[cell] { before[cell] / out[cell] } else { 1.0 };
        for number in inner {
            let [a, b] = self.world.edges[number].cells;
            let flow = &mut self.creep[number];
            *flow = [flow[0] * share(a), flow[1] * share(b)];
            self.regolith[a] += flow[1] - flow[0];
            self.regolith[b] += flow[0] - flow[1];
        }
    }

    fn slip(&mut self, strength: f64, softening: bool) {
        let tops: Vec<_> = (0..self.materials.len()).map(|material| self.top(material)).collect();
        for (material, top) in tops.iter().enumerate() {
            let talus = self.talus(material, top, softening);
            let mut slides = Vec::new();
            let mut out = vec![0.0; top.len()];
            for number in self.inner_edges() {
                let [a, b] = self.world.edges[number].cells;
                let excess = (top[a] - top[b]).abs() - f64::midpoint(talus[a], talus[b]);
                let (from, to) = if top[a] > top[b] { (a, b) } else { (b, a) };
                if excess > 0.0 {
                    slides.push((from, to, strength * excess));
                    out[from] += strength * excess;
                }
            }
            let Some(layer) = material.checked_sub(1) else {
                for (from, to, amount) in slides {
                    self.world.change[from] -= amount;
                    self.world.change[to] += amount;
                }
                continue;
            };
            let before = self.layers[layer].clone();
            for (from, to, amount) in slides {
                let share = if out[from] > before[from] { before[from] / out[from] } else { 1.0 };
                self.layers[layer][from] -= amount * share;
                self.layers[layer][to] += amount * share;
            }
        }
    }

    fn talus(&self, material: usize, top: &[f64], softening: bool) -> Vec<f64> {
        let talus = self.materials[material].talus_deg.to_radians().tan();
        let (mut sum, mut count) = (vec![0.0; top.len()], vec![0.0; top.len()]);
        for number in self.inner_edges() {
            let [a, b] = self.world.edges[number].cells;
            for (here, there) in [(a, b), (b, a)] {
                sum[here] += top[there] - top[here];
                count[here] += 1.0;
            }
        }
        let rough = sum.iter().zip(count).map(|(sum, count): (&f64, f64)| (sum / count.max(1.0)).abs());
        let softened = rough.map(|rough| (talus - 10.0 * (rough - 0.01 * talus).max(0.0)).max(0.0));
        softened.map(|softened| if softening { softened } else { talus }).collect()
    }
}
