//! The fused streams against literal transcriptions of the papers' equations: whole arrays, `f64`, one loop a
//! stage, no thought of speed. Lengths in cells.

mod common;

use common::{hydraulic, landscape, rough, run};
use weald::Field;
use weald::erode::hydraulic::{Hydraulic, Model};
use weald::erode::thermal_step::ThermalWithin;
use weald::recipe::parameter::Nested;

const COLUMNS: usize = 37;
const ROWS: usize = 29;

/// A plane with a margin of zeros on all sides, so that every cell has neighbours.
#[derive(Clone)]
struct Plane(Vec<f64>);

impl Plane {
    fn new(value: impl Fn(i64, i64) -> f64) -> Self {
        let mut plane = Self(vec![0.0; (COLUMNS + 2) * (ROWS + 2)]);
        for (x, y) in cells() {
            plane.set(x, y, value(x, y));
        }
        plane
    }

    fn at(&self, x: i64, y: i64) -> f64 {
        self.0[(y + 1) as usize * (COLUMNS + 2) + (x + 1) as usize]
    }

    fn set(&mut self, x: i64, y: i64, value: f64) {
        self.0[(y + 1) as usize * (COLUMNS + 2) + (x + 1) as usize] = value;
    }
}

fn cells() -> impl Iterator<Item = (i64, i64)> {
    (0..ROWS as i64).flat_map(|y| (0..COLUMNS as i64).map(move |x| (x, y)))
}

fn inside(x: i64, y: i64) -> bool {
    (0..COLUMNS as i64).contains(&x) && (0..ROWS as i64).contains(&y)
}

/// Mean sine of the slopes to the neighbours that exist.
fn mean_sine(b: &Plane, x: i64, y: i64) -> f64 {
    let around = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
    let sines: Vec<f64> = around
        .into_iter()
        .filter(|&(i, j)| inside(i, j))
        .map(|(i, j)| b.at(i, j) - b.at(x, y))
        .map(|q| q.abs() / (1.0 + q * q).sqrt())
        .collect();
    sines.iter().sum::<f64>() / sines.len() as f64
}

/// Han 2015, eq. 18–21: the isotropic scheme on the forward triangle.
fn slide(b: &Plane, talus: f64, strength: f64) -> Plane {
    let mut after = b.clone();
    for (x, y) in cells().filter(|&(x, y)| inside(x + 1, y + 1)) {
        let (dx, dy) = (b.at(x, y) - b.at(x + 1, y), b.at(x, y) - b.at(x, y + 1));
        let slope = (dx * dx + dy * dy).sqrt();
        if slope > talus {
            let c = strength * (slope - talus) / slope;
            after.set(x, y, after.at(x, y) - c * (dx + dy));
            after.set(x + 1, y, after.at(x + 1, y) + c * dx);
            after.set(x, y + 1, after.at(x, y + 1) + c * dy);
        }
    }
    after
}

/// Ground, depth, sediment and fluxes of Han 2015.
struct Han {
    b: Plane,
    d: Plane,
    s: Plane,
    fx: Plane,
    fy: Plane,
}

const K: f64 = 0.4;
const EPSILON: f64 = 0.001;
const VELOCITY_EPSILON: f64 = 0.1;

impl Han {
    fn edge(&self, old: f64, here: (i64, i64), next: (i64, i64)) -> f64 {
        if !inside(next.0, next.1) {
            return 0.0;
        }
        let depth = |(x, y)| self.d.at(x, y);
        let surface = |(x, y)| self.b.at(x, y) + self.d.at(x, y);
        let drop = surface(here) - surface(next);
        let dry = (drop > 0.0 && depth(here) <= 0.0) || (drop < 0.0 && depth(next) <= 0.0);
        let flux = old + if dry { 0.0 } else { K * drop };
        let dry = (flux > 0.0 && depth(here) <= 0.0) || (flux < 0.0 && depth(next) <= 0.0);
        if dry { 0.0 } else { flux }
    }

    fn step(&mut self, raining: bool, thermal: Option<(f64, f64)>) {
        let wanted_x = Plane::new(|x, y| self.edge(self.fx.at(x, y), (x, y), (x + 1, y)));
        let wanted_y = Plane::new(|x, y| self.edge(self.fy.at(x, y), (x, y), (x, y + 1)));
        let share = Plane::new(|x, y| {
            let out = wanted_x.at(x, y).max(0.0)
                + (-wanted_x.at(x - 1, y)).max(0.0)
                + wanted_y.at(x, y).max(0.0)
                + (-wanted_y.at(x, y - 1)).max(0.0);
            if out > 0.0 { (self.d.at(x, y).max(0.0) / out).min(1.0) } else { 1.0 }
        });
        let limited = |flux: f64, here: f64, next: f64| flux * if flux > 0.0 { here } else { next };
        self.fx = Plane::new(|x, y| limited(wanted_x.at(x, y), share.at(x, y), share.at(x + 1, y)));
        self.fy = Plane::new(|x, y| limited(wanted_y.at(x, y), share.at(x, y), share.at(x, y + 1)));
        let load = Plane::new(|x, y| self.s.at(x, y) / (self.d.at(x, y).max(0.0) + EPSILON));
        let carried = |flux: f64, here: f64, next: f64| flux * if flux >= 0.0 { here } else { next };
        let qx = Plane::new(|x, y| carried(self.fx.at(x, y), load.at(x, y), load.at(x + 1, y)));
        let qy = Plane::new(|x, y| carried(self.fy.at(x, y), load.at(x, y), load.at(x, y + 1)));
        let brought = |q: &Plane, r: &Plane, x, y| q.at(x - 1, y) - q.at(x, y) + r.at(x, y - 1) - r.at(x, y);
        let depth = Plane::new(|x, y| {
            let flowed = self.d.at(x, y) + brought(&self.fx, &self.fy, x, y);
            if raining { flowed + 0.01 } else { flowed - flowed.clamp(0.0, 0.03) }
        });
        let face = |flux: f64, here: f64, next: f64| {
            flux / ((here.max(0.0) + next.max(0.0)) / 2.0 + VELOCITY_EPSILON)
        };
        let vx = Plane::new(|x, y| face(self.fx.at(x, y), depth.at(x, y), depth.at(x + 1, y)));
        let vy = Plane::new(|x, y| face(self.fy.at(x, y), depth.at(x, y), depth.at(x, y + 1)));
        let (mut b, mut s) = (self.b.clone(), self.s.clone());
        for (x, y) in cells() {
            let u = (vx.at(x - 1, y) + vx.at(x, y)) / 2.0;
            let v = (vy.at(x, y - 1) + vy.at(x, y)) / 2.0;
            let speed = (u * u + v * v).sqrt();
            let found = self.s.at(x, y) + brought(&qx, &qy, x, y);
            let most = 10.0 * speed * mean_sine(&self.b, x, y) * depth.at(x, y).max(0.0);
            let kept = (found + 0.005 * speed).min(most);
            let net = kept - found;
            b.set(x, y, self.b.at(x, y) - if net > 0.0 { net } else { 0.3 * net });
            s.set(x, y, kept);
        }
        (self.d, self.s) = (depth, s);
        self.b = thermal.map_or(b.clone(), |(talus, strength)| slide(&b, talus, strength));
    }
}

/// Greatest difference between a layer and a plane.
fn worst(layer: &Field, plane: &Plane) -> f64 {
    cells()
        .map(|(x, y)| (f64::from(layer.at(x as usize, y as usize)) - plane.at(x, y)).abs())
        .fold(0.0, f64::max)
}

#[test]
fn han_is_what_its_equations_say() {
    let ground = rough(COLUMNS, ROWS, 15.0, 4);
    let zero = Plane::new(|_, _| 0.0);
    let b = Plane::new(|x, y| f64::from(ground.at(x as usize, y as usize)));
    for thermal in [None, Some((0.5, 0.1))] {
        let mut literal =
            Han { b: b.clone(), d: zero.clone(), s: zero.clone(), fx: zero.clone(), fy: zero.clone() };
        let steps = 150;
        for step in 0..steps {
            literal.step(step % 120 < 60, thermal);
        }
        let within = thermal
            .map(|(talus, strength)| Nested(ThermalWithin { talus, strength, ..ThermalWithin::default() }));
        let mut land = landscape(ground.clone());
        run(&Hydraulic { thermal: within, deposit_ratio: 0.3, ..hydraulic(steps) }, &mut land);
        let layer = |name| land.field(name).expect("written");
        let carved = worst(&ground, &literal.b);
        assert!(carved > 0.1, "something was carved: {carved}");
        for (name, plane, tolerance) in
            [("height", &literal.b, 1e-4), ("water", &literal.d, 1e-3), ("sediment", &literal.s, 1e-3)]
        {
            let difference = worst(layer(name), plane);
            println!("{name}: {difference:.1e} cells, carved {carved:.2}");
            assert!(
                difference < tolerance,
                "{name} differs by {difference} cells from the literal equations"
            );
        }
    }
}

/// Ground, depth, sediment and the four outflows (east, west, south, north) of Mei et al. 2007.
struct Mei {
    b: Plane,
    d: Plane,
    s: Plane,
    outflow: [Plane; 4],
}

const TOWARDS: [(i64, i64); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];
const BACK: [usize; 4] = [1, 0, 3, 2];

impl Mei {
    fn step(&mut self) {
        let rained = Plane::new(|x, y| self.d.at(x, y) + 0.01);
        let surface = |x, y| self.b.at(x, y) + rained.at(x, y);
        let wanted: Vec<Plane> = (0..4)
            .map(|way| {
                let (dx, dy) = TOWARDS[way];
                Plane::new(|x, y| {
                    if !inside(x + dx, y + dy) {
                        return 0.0;
                    }
                    (self.outflow[way].at(x, y) + 0.1 * (surface(x, y) - surface(x + dx, y + dy))).max(0.0)
                })
            })
            .collect();
        let scale = Plane::new(|x, y| {
            let sum: f64 = wanted.iter().map(|plane| plane.at(x, y)).sum();
            if sum > 0.0 { (rained.at(x, y) / sum).min(1.0) } else { 1.0 }
        });
        for (outflow, wanted) in self.outflow.iter_mut().zip(&wanted) {
            *outflow = Plane::new(|x, y| wanted.at(x, y) * scale.at(x, y));
        }
        let out = &self.outflow;
        let into = |way: usize, x: i64, y: i64| out[BACK[way]].at(x + TOWARDS[way].0, y + TOWARDS[way].1);
        let flowed = Plane::new(|x, y| {
            rained.at(x, y) + (0..4).map(|way| into(way, x, y) - out[way].at(x, y)).sum::<f64>()
        });
        let (mut b, mut loaded) = (self.b.clone(), self.s.clone());
        for (x, y) in cells() {
            let mean = (rained.at(x, y) + flowed.at(x, y)) / 2.0;
            let through = |ahead: usize, behind: usize| {
                (into(behind, x, y) - out[behind].at(x, y) + out[ahead].at(x, y) - into(ahead, x, y)) / 2.0
            };
            let (u, v) = if mean > 1e-4 { (through(0, 1) / mean, through(2, 3) / mean) } else { (0.0, 0.0) };
            let capacity = 0.05 * mean_sine(&self.b, x, y).max(0.05) * (u * u + v * v).sqrt();
            let found = self.s.at(x, y);
            // K_s and K_d are both 0.1 by default.
            let moved = 0.1 * (capacity - found);
            b.set(x, y, self.b.at(x, y) - moved);
            loaded.set(x, y, found + moved);
        }
        let load = Plane::new(|x, y| loaded.at(x, y) / (rained.at(x, y) + EPSILON));
        self.s = Plane::new(|x, y| {
            let exchange = |way: usize| {
                let (dx, dy) = TOWARDS[way];
                into(way, x, y) * load.at(x + dx, y + dy) - out[way].at(x, y) * load.at(x, y)
            };
            loaded.at(x, y) + (0..4).map(exchange).sum::<f64>()
        });
        self.d = Plane::new(|x, y| flowed.at(x, y) * (1.0 - 0.015));
        self.b = b;
    }
}

#[test]
fn mei_is_what_its_equations_say() {
    let ground = rough(COLUMNS, ROWS, 15.0, 4);
    let zero = || Plane::new(|_, _| 0.0);
    let b = Plane::new(|x, y| f64::from(ground.at(x as usize, y as usize)));
    let mut literal = Mei { b, d: zero(), s: zero(), outflow: [zero(), zero(), zero(), zero()] };
    for _ in 0..200 {
        literal.step();
    }
    let mut land = landscape(ground.clone());
    run(&Hydraulic { model: Model::Mei, ..hydraulic(200) }, &mut land);
    let carved = worst(&ground, &literal.b);
    assert!(carved > 0.05, "something was carved: {carved}");
    for (name, plane, tolerance) in
        [("height", &literal.b, 1e-4), ("water", &literal.d, 1e-4), ("sediment", &literal.s, 1e-4)]
    {
        let difference = worst(land.field(name).expect("written"), plane);
        println!("{name}: {difference:.1e} cells, carved {carved:.2}");
        assert!(difference < tolerance, "{name} differs by {difference} cells from the literal equations");
    }
}
