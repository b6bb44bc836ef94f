//! What holds for plants of limbs.

use super::*;
use crate::grow::ifs::shapes;
use crate::grow::wind::push;

fn plant(name: &str) -> Limbs {
    let ifs = shapes::find(name).expect("built in").ifs();
    Limbs::of(&ifs, Habit::of(&ifs, None))
}

fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    leaf::length(std::array::from_fn(|i| a[i] - b[i]))
}

#[test]
fn every_shape_becomes_a_plant_of_one_metre_with_leaves_on_every_level() {
    for shape in shapes::SHAPES {
        let plant = plant(shape.name);
        let finest = plant.corners.iter().filter(|corner| corner.levels[0] == 0);
        let highest = finest.map(|corner| corner.rest[1]).fold(0.0, f32::max);
        assert!((highest - 1.0).abs() < 1e-5, "{}: {highest} m", shape.name);
        let counts: Vec<_> =
            (0..LEVELS as u32).map(|level| plant.triangles_of([level; 2]).len() / 3).collect();
        println!(
            "{}: {} limbs, {} corners, triangles {counts:?}, {} m, areas {:?}",
            shape.name,
            plant.limbs.len(),
            plant.corners.len(),
            plant.radius(),
            (0..LEVELS as u32).map(|level| plant.area(level)).collect::<Vec<_>>()
        );
        assert!(plant.corners.len() < 200_000 && plant.limbs.len() < 1 << 20);
        assert!(counts[LEVELS - 1] > 0 && counts[LEVELS - 1] <= 24, "{}: {counts:?}", shape.name);
        for (number, limb) in plant.limbs.iter().enumerate() {
            assert!(limb.parent.is_none_or(|parent| (parent as usize) < number), "{}", shape.name);
            assert!((0.0..=1.0).contains(&limb.along) && limb.order < 4 && (0.0..1.0).contains(&limb.phase));
        }
    }
}
