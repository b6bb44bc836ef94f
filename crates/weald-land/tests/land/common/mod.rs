//! Ground and runs that several tests share.
#![allow(
    dead_code,
    unreachable_pub,
    unused_imports,
    unused_macros,
    reason = "each test binary uses its own part"
)]

use weald_core::material::Material;
use weald_core::parameter::{Length, Nested};
use weald_core::random::signed2;
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::step::{Outcome, Step};
use weald_engine::{Engine, Job, SolidBudget, Unwatched};
use weald_land::erode::dissolution_step::DissolutionWithin;
use weald_land::erode::hydraulic::{Hydraulic, MeiKeys, StavaKeys};
use weald_land::erode::slippage_step::SlippageWithin;
use weald_land::erode::springs::Spring;

/// Rough ground with valleys and pits: five octaves of smoothed random values, `relief` high.
pub fn rough(columns: usize, rows: usize, relief: f32, seed: u64) -> Field {
    let size = Size::new(columns, rows).expect("a small size");
    let octave = |x: usize, y: usize, spacing: usize| {
        let (cx, cy) = (x / spacing, y / spacing);
        let (fx, fy) = ((x % spacing) as f64 / spacing as f64, (y % spacing) as f64 / spacing as f64);
        let corner = |dx, dy| signed2(seed + spacing as u64, (cx + dx) as i64, (cy + dy) as i64);
        let (top, bottom) =
            (corner(0, 0) * (1.0 - fx) + corner(1, 0) * fx, corner(0, 1) * (1.0 - fx) + corner(1, 1) * fx);
        (top * (1.0 - fy) + bottom * fy) * spacing as f64
    };
    let height = |x, y| [32, 16, 8, 4, 1].iter().map(|&spacing| octave(x, y, spacing)).sum::<f64>();
    let raw = Field::from_function(size, |x, y| height(x, y) as f32);
    let (low, high) = raw.range(None).expect("cells");
    Field::from_function(size, |x, y| (raw.at(x, y) - low) / (high - low) * relief)
}

/// A landscape with cells of one metre.
pub fn landscape(height: Field) -> Landscape {
    let mut landscape = Landscape::new(Domain::new(height.size(), 1.0));
    landscape.insert("height", "m", height);
    landscape
}

/// The same with clay, soil and sand on the rock, each thick here and thin or missing there, and a layer
/// `painted` from 0 to 1.
pub fn layered(height: Field) -> Landscape {
    let size = height.size();
    let mut land = landscape(height);
    land.materials =
        ["rock", "clay", "soil", "sand"].iter().filter_map(|name| Material::built_in(name)).collect();
    for (seed, material) in (21..).zip(["clay", "soil", "sand"]) {
        let patches = rough(size.columns, size.rows, 3.0, seed);
        land.insert(material, "m", Field::from_function(size, |x, y| (patches.at(x, y) - 1.0).max(0.0)));
    }
    land.insert("painted", "1", rough(size.columns, size.rows, 1.0, 20));
    land
}

/// Runs a step on an engine.
pub fn run_on(step: &dyn Step, landscape: &mut Landscape, engine: Engine) -> Outcome {
    let job = Job { seed: 7, engine, watcher: &Unwatched, resume: None };
    step.run(landscape, &job).expect("the step runs")
}

/// Runs a step on the CPU.
pub fn run(step: &dyn Step, landscape: &mut Landscape) -> Outcome {
    run_on(step, landscape, Engine::Cpu)
}

/// `hydraulic` with defaults but for its length.
pub fn hydraulic(iterations: u32) -> Hydraulic {
    Hydraulic { iterations, ..Hydraulic::default() }
}

/// `hydraulic` by Mei et al. with defaults but for its length.
pub fn mei(iterations: u32) -> Hydraulic {
    Hydraulic { model: MeiKeys::default().into(), ..hydraulic(iterations) }
}

/// `hydraulic` by Šťava et al. with all of its processes.
pub fn stava(iterations: u32) -> Hydraulic {
    let keys = StavaKeys {
        viscosity: 0.5,
        dissolution: Some(Nested(DissolutionWithin::default())),
        slippage: Some(Nested(SlippageWithin { strength: 0.05, softening: false })),
        ..StavaKeys::default()
    };
    Hydraulic { model: keys.into(), ..hydraulic(iterations) }
}

/// A step of `hydraulic` with other keys of its model: `with!(step, [Han Mei] { limiter: false })` where it is one of
/// these models, which all have the keys.
macro_rules! with {
    ($step:expr, [$($Model:ident)+] $keys:tt) => {{
        let mut step: weald_land::erode::hydraulic::Hydraulic = $step;
        #[allow(unreachable_patterns, reason = "some name all models")]
        match &mut step.model {
            $( weald_land::erode::hydraulic::Model::$Model(keys) => $crate::common::with!(@set keys $keys), )+
            other => panic!("model {} has not these keys", other.word()),
        }
        step
    }};
    (@set $keys:ident { $($key:ident: $value:expr),* $(,)? }) => {{ $( $keys.$key = $value; )* }};
}
pub(crate) use with;

/// A length in metres.
pub fn metres(length: f64) -> Length {
    Length::Metres(length)
}

/// A spring of a few cells' width.
pub fn spring(x: f64, y: f64) -> Nested<Spring> {
    Nested(Spring { x, y, radius: 2.5, rate: 0.05 })
}

/// Greatest difference of two fields.
pub fn worst_difference(a: &Field, b: &Field) -> f32 {
    a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// A function from cell to cell.
pub type Turn = Box<dyn Fn(usize, usize) -> (usize, usize)>;

/// The eight symmetries of the square.
pub fn symmetries(side: usize) -> [Turn; 8] {
    let m = side - 1;
    [
        Box::new(|x, y| (x, y)),
        Box::new(move |x, y| (m - x, y)),
        Box::new(move |x, y| (x, m - y)),
        Box::new(move |x, y| (m - x, m - y)),
        Box::new(|x, y| (y, x)),
        Box::new(move |x, y| (m - y, x)),
        Box::new(move |x, y| (y, m - x)),
        Box::new(move |x, y| (m - y, m - x)),
    ]
}

/// Materials, bedrock first, of these names.
pub fn materials(names: &[&str]) -> Vec<Material> {
    names.iter().map(|name| Material::built_in(name).expect("built in")).collect()
}

/// The field of a layer that must be there.
pub fn field<'a>(land: &'a Landscape, name: &str) -> &'a Field {
    land.field(name).unwrap_or_else(|error| panic!("{error}"))
}

/// The part of the solid that is missing, relative to all that a cell anywhere gained or lost.
pub fn error_of_what_moved(solid: &SolidBudget, before: &Landscape, after: &Landscape) -> f64 {
    let layers = ["bedrock", "clay", "soil", "sand"];
    let start = |name: &str, at: usize| match name {
        "bedrock" => {
            let lying = layers[1..].iter().map(|layer| f64::from(field(before, layer).values()[at]));
            f64::from(field(before, "height").values()[at]) - lying.sum::<f64>()
        }
        _ => f64::from(field(before, name).values()[at]),
    };
    let moved = layers.map(|name| {
        let after = field(after, name).values().iter().enumerate();
        after.map(|(at, &now)| (f64::from(now) - start(name, at)).abs()).sum::<f64>()
    });
    let moved = moved.iter().sum::<f64>() * before.domain.cell.powi(2);
    solid.lost() / moved
}
