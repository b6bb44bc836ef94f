//! Which sets of grass a device draws, and in which order, is what the CPU says.

use crate::programs::gpu;
use crate::scenes::{above, meadow, meadow_with, options, view};
use weald::grow::Vegetation;
use weald::grow::grass::choice::{Choice, Detail, LISTS, ViewCone, coarser};
use weald::grow::grass::{Instance, Meadow, Packed};
use weald::picture::{Camera, LitScene};
use weald_gpu::{Chosen, GrassLook, Renderer};

/// How near to where it would be chosen otherwise a set may be for a device to differ: metres of its root, which the
/// device finds by a spline of other rounding, and shares of its rank, which a device's `pow` is off by.
const UNSURE: f32 = 1e-4;

/// Greatest share of sets that may be so near.
const FEW: f64 = 0.01;

const LOOKS: [GrassLook; 5] = [
    GrassLook { culled: true, thinned: true, reach: 1.0, level: None },
    GrassLook { culled: false, thinned: true, reach: 1.0, level: None },
    GrassLook { culled: true, thinned: true, reach: 1.7, level: None },
    GrassLook { culled: true, thinned: false, reach: 1.0, level: None },
    GrassLook { culled: false, thinned: false, reach: 1.0, level: Some(2.0) },
];

/// As choices of a look are made.
fn choice(look: GrassLook) -> Choice {
    let choice =
        if look.thinned { Choice::of_a_picture() } else { Choice::of_all(look.level.unwrap_or(4.0)) };
    Choice { culled: u32::from(look.culled), hides: u32::from(look.culled), ..choice }
}

/// The sets of each list by the CPU, and those of which it is not sure.
fn by_the_cpu(
    scene: &LitScene,
    (camera, reach): (&Camera, f32),
    (choice, meadow): (Choice, &Meadow),
    sets: &[Packed],
) -> [Vec<Packed>; LISTS + 1] {
    let axes = [camera.forward, camera.right, camera.up];
    let coarser = coarser(camera.pixel_angle(options(1).size[0] as usize) / reach);
    let detail = Detail::new(coarser, reach, meadow.densest);
    let sight = ViewCone { eye: camera.eye, axes, half: camera.half, detail_from: camera.eye, detail };
    let mut lists = [const { Vec::new() }; LISTS + 1];
    for &set in sets {
        let Instance { place: [east, south], species, tuft } = Instance::unpack(set);
        let species = &meadow.species[species as usize];
        let up = scene.top_at([east, south].map(f64::from)).expect("on the land");
        let list = |[x, y, z]: [f32; 3]| {
            let root = [east + x, -south + y, up + z];
            let ground = |[east, north]: [f32; 2]| scene.bed_at([east, -north].map(f64::from));
            let list = choice.list_of(&sight, (species, &tuft), root)?;
            (!choice.is_hidden(camera.eye, (species, root), ground)).then_some(list)
        };
        let found = list([0.0; 3]);
        let mut nudges =
            (0..8).map(|bits| [0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { UNSURE } else { -UNSURE }));
        if nudges.any(|nudge| list(nudge) != found) {
            lists[LISTS].push(set);
        } else if let Some(found) = found {
            lists[found].push(set);
        }
    }
    for list in &mut lists {
        list.sort_unstable();
    }
    lists
}

/// Compares what a device chose with what the CPU does, and tells how many sets each list has.
fn compare(chosen: &Chosen, cpu: &[Vec<Packed>; LISTS + 1], all: usize) -> [usize; LISTS] {
    let unsure = &cpu[LISTS];
    assert!((unsure.len() as f64) < FEW * all as f64, "{} unsure", unsure.len());
    for (number, (list, ours)) in chosen.lists.iter().zip(cpu).enumerate() {
        assert!(list.is_sorted_by(|a, b| a < b), "in the order of the sets");
        let sets = list.iter().map(|&number| chosen.sets[number as usize]);
        let mut sure: Vec<_> = sets.filter(|set| unsure.binary_search(set).is_err()).collect();
        sure.sort_unstable();
        let first = sure.iter().zip(ours).find(|(a, b)| a != b);
        assert!(sure == *ours, "list {number}: {} and {}, first {first:?}", sure.len(), ours.len());
    }
    [0, 1, 2].map(|list| chosen.lists[list].len())
}

#[test]
fn a_device_draws_the_sets_that_the_cpu_chooses_in_the_same_order() {
    let Some(gpu) = gpu() else { return };
    let landscape = meadow();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = Renderer::new(&gpu, &scene, options(1)).expect("it can be drawn");
    renderer.plant(&scene, &landscape).expect("planted");
    let grass = landscape.all_meadows().next().expect("a meadow").1;
    let all = grass.sets(&grass.area()).len();
    assert!(all > 100_000, "{all} sets");
    let places =
        [([60.0, 70.0], 1.5, 12.0, 0.0), ([20.0, 30.0], 6.0, 30.0, 135.0), ([110.0, 60.0], 1.0, 0.0, 270.0)];
    let mut most = [0; LISTS];
    for (place, metres, down, turn) in places {
        let camera = above(&scene, place, metres, down, turn);
        for look in LOOKS {
            renderer.set_grass_look(look);
            let chosen = &renderer.chosen(&camera).expect("chosen")[0];
            // The CPU chooses among all: what is sown on the device depends on the camera as well.
            let level = look.level.unwrap_or(grass.level);
            let sets = Meadow { level, ..(*grass).clone() }.sets(&grass.area());
            let counts = compare(
                chosen,
                &by_the_cpu(&scene, (&camera, look.reach), (choice(look), &grass), &sets),
                all,
            );
            println!("{look:?}: {counts:?} of {} sown of {all}", chosen.sets.len());
            match look {
                GrassLook { culled: false, thinned: false, .. } => assert_eq!(counts[0], all),
                GrassLook { thinned: false, .. } => assert!((1..all).contains(&counts[0])),
                _ => most = [0, 1, 2].map(|list| most[list].max(counts[list])),
            }
            let again = renderer.chosen(&camera).expect("chosen");
            assert_eq!(&again[0], chosen, "the same each time");
        }
    }
    assert!(most.iter().all(|&most| most > 100), "all lists have sets: {most:?}");
}

#[test]
fn sets_that_ground_hides_are_left_out_and_no_picture_misses_them() {
    let Some(gpu) = gpu() else { return };
    let landscape = meadow_with("relief = 14.0\nwavelength = 45.0\noctaves = 3");
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = Renderer::new(&gpu, &scene, options(1)).expect("it can be drawn");
    renderer.plant(&scene, &landscape).expect("planted");
    let grass = landscape.all_meadows().next().expect("a meadow").1;
    let sets = grass.sets(&grass.area());
    let mut hidden = 0;
    for (place, turn) in [([60.0, 70.0], 0.0), ([20.0, 30.0], 135.0), ([90.0, 100.0], 330.0)] {
        let camera = above(&scene, place, 1.7, 3.0, turn);
        let look = GrassLook { culled: true, thinned: true, reach: 1.0, level: None };
        renderer.set_grass_look(look);
        let chosen = &renderer.chosen(&camera).expect("chosen")[0];
        let seen = compare(
            chosen,
            &by_the_cpu(&scene, (&camera, look.reach), (choice(look), &grass), &sets),
            sets.len(),
        );
        let all =
            by_the_cpu(&scene, (&camera, look.reach), (Choice { hides: 0, ..choice(look) }, &grass), &sets);
        let in_sight: usize = all[..LISTS].iter().map(Vec::len).sum();
        hidden += in_sight.saturating_sub(seen.iter().sum());
        let without_them = renderer.render(&camera).expect("drawn");
        renderer.set_grass_look(GrassLook { culled: false, ..look });
        let with_them = renderer.render(&camera).expect("drawn");
        assert!(without_them.rgb == with_them.rgb, "from {place:?}");
    }
    assert!(hidden > 1000, "{hidden} sets are hidden");
}
