//! Brushes change what they say and nothing else; scripts read as they were written; undo and redo give the
//! same bits, and so do runs with strokes in between.

mod brushes;
mod scripts;
mod sessions;
mod undo;

use proptest::prelude::*;
use weald_core::grid::Mask;
use weald_core::material::Material;
use weald_core::random::{hash2, unit};
use weald_core::{Field, Size};
use weald_land::edit::{Area, Brush, Canvas, Effect, Falloff};

const CELL: f64 = 4.0;
const MATERIALS: [&str; 3] = ["rock", "sand", "soil"];

/// Rough ground under sand and soil that is missing in places, with some water.
fn canvas(columns: usize, rows: usize) -> Canvas {
    let size = Size::new(columns, rows).expect("small");
    let materials = MATERIALS.map(|name| Material::built_in(name).expect("built in"));
    let random = |seed: u64, low: f64, high: f64| {
        let value = move |x, y| low + (high - low) * unit(hash2(seed, x as i64, y as i64));
        Field::from_function(size, |x, y| value(x, y).max(0.0) as f32)
    };
    Canvas {
        bedrock: random(1, 100.0, 140.0),
        thickness: vec![random(2, -2.0, 3.0), random(3, -1.0, 1.0)],
        water: random(4, -1.0, 1.0),
        valid: Mask::new(size, (0..size.cells()).map(|cell| cell % 17 != 5).collect()),
        ..Canvas::level(Area { first: [0, 0], size }, CELL, &materials)
    }
}

fn dab(effect: Effect) -> Brush {
    Brush { path: vec![[60.0, 50.0]], radius: 30.0, falloff: Falloff::Smooth, strength: 1.0, effect }
}

fn any_effect() -> impl Strategy<Value = Effect> {
    let name = prop::sample::select(vec!["rock", "bedrock", "sand", "soil"]).prop_map(str::to_owned);
    let amount = || 0.0..20.0_f64;
    prop_oneof![
        (name.clone(), amount()).prop_map(|(material, thickness)| Effect::Add { material, thickness }),
        (name, amount()).prop_map(|(material, thickness)| Effect::Remove { material, thickness }),
        amount().prop_map(|depth| Effect::AddWater { depth }),
        amount().prop_map(|depth| Effect::RemoveWater { depth }),
        (1_u32..4).prop_map(|times| Effect::Smooth { times }),
        (60.0..180.0_f64).prop_map(|height| Effect::Flatten { height }),
        amount().prop_map(|rate| Effect::Source { rate }),
        amount().prop_map(|rate| Effect::Drain { rate }),
        amount().prop_map(|factor| Effect::Rain { factor }),
        Just(Effect::Freeze),
        Just(Effect::Thaw),
        Just(Effect::Mask),
        Just(Effect::Unmask),
    ]
}

fn any_brush() -> impl Strategy<Value = Brush> {
    let falloffs = vec![Falloff::Hard, Falloff::Linear, Falloff::Smooth, Falloff::Gaussian];
    let path = prop::collection::vec([-40.0..180.0_f64, -40.0..140.0_f64], 1..5);
    (path, 0.5..60.0_f64, prop::sample::select(falloffs), 0.0..=1.0_f64, any_effect()).prop_map(
        |(path, radius, falloff, strength, effect)| Brush { path, radius, falloff, strength, effect },
    )
}
