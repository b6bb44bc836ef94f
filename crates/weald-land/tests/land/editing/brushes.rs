use proptest::prelude::*;
use weald_core::Field;
use weald_land::edit::{Brush, Canvas, Effect, Falloff, Volumes};

use super::{CELL, any_brush, canvas, dab};

fn painted(brush: &Brush, canvas: &Canvas) -> (Canvas, Volumes) {
    let mut after = canvas.clone();
    let volumes = brush.paint(&mut after).expect("the brush is good");
    (after, volumes)
}

/// Cubic metres by which a field, or the whole ground, grew from one canvas to another.
fn growth(before: &Canvas, after: &Canvas, value: impl Fn(&Canvas, usize) -> f64) -> f64 {
    let cells = 0..before.size().cells();
    cells.map(|cell| value(after, cell) - value(before, cell)).sum::<f64>() * CELL * CELL
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn a_stroke_on_its_own_rectangle_gives_the_bits_of_the_whole(brush in any_brush()) {
        let whole = canvas(37, 29);
        let (expected, all) = painted(&brush, &whole);
        let mut patched = whole.clone();
        let mut volumes = Volumes::default();
        if let Some(area) = brush.area(whole.size(), CELL) {
            let mut part = whole.part(area).expect("the area lies on the canvas");
            volumes = brush.paint(&mut part).expect("the brush is good");
            patched.put(&part);
        }
        prop_assert!((volumes.solid_added - all.solid_added).abs() <= 1e-9 * all.solid_added);
        prop_assert!(patched == expected, "{:?}", brush);
    }

    #[test]
    fn a_stroke_gives_account_of_all_that_it_moved_and_leaves_no_thickness_below_nothing(brush in any_brush()) {
        let before = canvas(37, 29);
        let (after, volumes) = painted(&brush, &before);
        let solid = growth(&before, &after, Canvas::surface);
        let water = growth(&before, &after, |canvas, cell| f64::from(canvas.water.values()[cell]));
        let scale = 1.0 + volumes.solid_added + volumes.solid_removed + volumes.water_added;
        prop_assert!((volumes.solid_added - volumes.solid_removed - solid).abs() < 1e-9 * scale);
        prop_assert!((volumes.water_added - volumes.water_removed - water).abs() < 1e-9 * scale);
        for field in after.thickness.iter().chain([&after.water]) {
            prop_assert!(field.values().iter().all(|&value| value >= 0.0));
        }
        for cell in (0..before.size().cells()).filter(|&cell| !before.is_open(cell)) {
            prop_assert_eq!(before.surface(cell), after.surface(cell), "a closed cell was changed");
        }
    }
}

#[test]
fn adding_and_removing_touch_the_chosen_layer_alone_and_no_more_than_is_there() {
    let before = canvas(30, 25);
    let sand = |thickness| Effect::Remove { material: "sand".to_owned(), thickness };
    let (after, volumes) = painted(&dab(sand(1000.0)), &before);
    let middle = before.size().index(15, 12);
    assert!(before.is_open(middle) && before.thickness[0].values()[middle] > 0.0);
    assert_eq!(after.thickness[0].values()[middle], 0.0);
    assert!(volumes.solid_removed > 100.0 && volumes.solid_added == 0.0, "{volumes:?}");
    assert_eq!((&after.bedrock, &after.thickness[1]), (&before.bedrock, &before.thickness[1]));
    let deep = Effect::Remove { material: "bedrock".to_owned(), thickness: 1000.0 };
    let (pit, _) = painted(&dab(deep), &before);
    assert!(pit.bedrock.values()[middle] < -800.0, "there is always more bedrock");
    let mut same = before.clone();
    let message = dab(Effect::Add { material: "snad".to_owned(), thickness: 1.0 }).paint(&mut same);
    assert!(message.expect_err("no such material").to_string().contains("rock, sand, soil"));
    assert_eq!(same, before);
}

#[test]
fn flattening_takes_from_the_top_downward_and_gives_to_the_topmost_material() {
    let before = canvas(30, 25);
    let flat = |height| Brush { falloff: Falloff::Hard, ..dab(Effect::Flatten { height }) };
    let inside: Vec<_> = {
        let (after, _) = painted(&flat(90.0), &before);
        (0..before.size().cells()).filter(|&cell| after.surface(cell) != before.surface(cell)).collect()
    };
    assert!(inside.len() > 100, "the brush is 15 cells wide");
    let (cut, _) = painted(&flat(90.0), &before);
    let (filled, _) = painted(&flat(200.0), &before);
    for &cell in &inside {
        assert!((cut.surface(cell) - 90.0).abs() < 1e-4 && (filled.surface(cell) - 200.0).abs() < 1e-4);
        assert!(cut.thickness.iter().all(|layer| layer.values()[cell] == 0.0), "bedrock is above 90 m");
        let top = (0..2).rev().find(|&layer| before.thickness[layer].values()[cell] > 0.0);
        let below = top.unwrap_or(0);
        let unchanged =
            |layer: usize| filled.thickness[layer].values()[cell] == before.thickness[layer].values()[cell];
        assert!((0..below).all(unchanged), "layers under the topmost one are as they were");
        assert_eq!(top.is_none(), filled.bedrock.values()[cell] != before.bedrock.values()[cell]);
    }
}

#[test]
fn smoothing_lessens_the_roughness_and_keeps_a_plane() {
    let before = canvas(30, 25);
    let rough = |canvas: &Canvas| {
        let height = |x, y| canvas.surface(canvas.size().index(x, y));
        let bends = (10..20).map(|x| (height(x - 1, 12) - 2.0 * height(x, 12) + height(x + 1, 12)).abs());
        bends.sum::<f64>()
    };
    let (after, _) = painted(&dab(Effect::Smooth { times: 3 }), &before);
    assert!(rough(&after) < 0.5 * rough(&before), "{} is not half of {}", rough(&after), rough(&before));
    let mut plane = Canvas { valid: None, ..canvas(30, 25) };
    plane.thickness.iter_mut().for_each(|layer| layer.values_mut().fill(0.0));
    plane.bedrock = Field::from_function(plane.size(), |x, y| 8.0 * x as f32 - 4.0 * y as f32);
    assert_eq!(painted(&dab(Effect::Smooth { times: 3 }), &plane).0, plane);
}

#[test]
fn sources_drains_rain_and_frost_are_painted_and_wiped_off_again() {
    let before = canvas(30, 25);
    let middle = before.size().index(15, 12);
    let at = |effect: Effect, canvas: &Canvas| painted(&dab(effect), canvas).0;
    let spring = at(Effect::Source { rate: 0.25 }, &before);
    assert!((spring.source.values()[middle] - 0.25).abs() < 0.01 && spring.source.values()[0] == 0.0);
    assert!(at(Effect::Drain { rate: 0.25 }, &before).source.values()[middle] < -0.2);
    let dry = at(Effect::Rain { factor: 0.0 }, &before);
    assert!(dry.rain.values()[middle] < 0.05 && dry.rain.values()[0] == 1.0);
    let frozen = at(Effect::Freeze, &before);
    assert!(frozen.frozen.values().iter().all(|&value| value == 0.0 || value == 1.0));
    assert_eq!(frozen.frozen.values()[middle], 1.0);
    assert_eq!(at(Effect::Thaw, &frozen), before);
}

#[test]
fn a_brush_that_is_none_is_refused_and_changes_nothing() {
    let before = canvas(8, 8);
    let good = dab(Effect::AddWater { depth: 1.0 });
    let faulty = [
        Brush { path: Vec::new(), ..good.clone() },
        Brush { path: vec![[f64::NAN, 0.0]], ..good.clone() },
        Brush { path: vec![[0.0, 0.0]; 10_001], ..good.clone() },
        Brush { radius: 0.0, ..good.clone() },
        Brush { strength: 1.5, ..good.clone() },
        Brush { effect: Effect::AddWater { depth: -1.0 }, ..good.clone() },
        Brush { effect: Effect::Flatten { height: f64::INFINITY }, ..good },
    ];
    for brush in faulty {
        let mut canvas = before.clone();
        let error = brush.paint(&mut canvas).expect_err("no stroke");
        assert!(error.to_string().starts_with("a brush cannot paint: "), "{error}");
        assert_eq!(canvas, before);
    }
}

#[test]
fn what_is_masked_is_left_as_it_is_by_every_stroke_and_half_of_it_where_the_mask_is_half() {
    let before = canvas(30, 25);
    let (half, _) = painted(&Brush { strength: 0.5, falloff: Falloff::Hard, ..dab(Effect::Mask) }, &before);
    let (masked, volumes) = painted(&Brush { falloff: Falloff::Hard, ..dab(Effect::Mask) }, &before);
    let middle = before.size().index(15, 12);
    assert_eq!([half.mask.values()[middle], masked.mask.values()[middle]], [0.5, 1.0]);
    assert_eq!(
        (volumes, &masked.bedrock, &masked.water),
        (Volumes::default(), &before.bedrock, &before.water)
    );
    let soil = Effect::Add { material: "soil".to_owned(), thickness: 2.0 };
    for effect in
        [soil.clone(), Effect::AddWater { depth: 3.0 }, Effect::Flatten { height: 0.0 }, Effect::Freeze]
    {
        let stroke = Brush { falloff: Falloff::Hard, ..dab(effect) };
        assert!(painted(&stroke, &before).0 != before, "{stroke:?} does something where nothing is masked");
        assert_eq!(painted(&stroke, &masked).0, masked, "{stroke:?}");
    }
    let added = |on: &Canvas| {
        let (after, _) = painted(&Brush { falloff: Falloff::Hard, ..dab(soil.clone()) }, on);
        after.thickness[1].values()[middle] - on.thickness[1].values()[middle]
    };
    assert!((added(&before) - 2.0).abs() < 1e-5 && (added(&half) - 1.0).abs() < 1e-5);
    let (bare, _) = painted(&Brush { falloff: Falloff::Hard, ..dab(Effect::Unmask) }, &masked);
    assert_eq!(bare, before, "the mask is gone, and nothing else has changed");
}
