//! The `stream-power` step as a recipe runs it: the same bits on any number of threads and after an interruption, one
//! landscape at every size, materials, and a sea.

use std::sync::Mutex;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::random::signed2;
use weald_engine::step::{Outcome, Step};
use weald_engine::{Engine, Job, SavedSimulation, Watcher};
use weald_land::erode::stream_power_step::{Outlets, StreamPower};

/// Low hills of a few kilometres on 12.8 km, with so many cells a side.
fn hills(side: usize, sea_level: Option<f64>) -> Landscape {
    let cell = 12_800.0 / side as f64;
    let domain = Domain { sea_level, ..Domain::new(Size { columns: side, rows: side }, cell) };
    let mut landscape = Landscape::new(domain);
    let hill = |x: f64, y: f64| {
        let wave = |east: f64, south: f64| (east * x + south * y).sin();
        20.0 * (wave(0.0011, 0.0007) + wave(-0.0008, 0.0013) + wave(0.0021, -0.0017))
    };
    let ground = |x: usize, y: usize| hill((x as f64 + 0.5) * cell, (y as f64 + 0.5) * cell) as f32;
    landscape.insert("height", "m", Field::from_function(landscape.domain.size, ground));
    landscape
}

fn step() -> StreamPower {
    StreamPower { duration: 2_000_000.0, deposition: 0.5, creep: 0.05, ..StreamPower::default() }
}

fn run(step: &StreamPower, landscape: &mut Landscape) -> Outcome {
    step.run(landscape, &Job::unwatched(7)).expect("nothing stands against it")
}

fn heights(landscape: &Landscape) -> Vec<u32> {
    landscape.field("height").expect("is there").values().iter().map(|height| height.to_bits()).collect()
}

#[test]
fn the_bits_are_the_same_on_any_number_of_threads() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| {
            let mut landscape = hills(96, Some(-5.0));
            run(&step(), &mut landscape);
            heights(&landscape)
        })
    };
    let one = with(1);
    for threads in [2, 3, 5] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

/// Stops after some steps and keeps the state.
struct Stopping {
    after: u64,
    done: Mutex<u64>,
    kept: Mutex<Option<SavedSimulation>>,
}

impl Watcher for Stopping {
    fn progress(&self, done: u64, _: u64, _: usize) {
        *self.done.lock().expect("not poisoned") = done;
    }

    fn cancelled(&self) -> bool {
        *self.done.lock().expect("not poisoned") >= self.after
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        *self.kept.lock().expect("not poisoned") = Some(state.clone());
        Ok(())
    }
}

#[test]
fn what_was_interrupted_goes_on_to_the_same_bits() {
    for levels in [1, 2] {
        let step = StreamPower { levels, coarsest: 1000.0, ..step() };
        let mut whole = hills(64, None);
        let budget = run(&step, &mut whole).budget;
        let watcher = Stopping { after: 5, done: Mutex::new(0), kept: Mutex::new(None) };
        let job = Job { seed: 7, engine: Engine::Cpu, watcher: &watcher, resume: None };
        let stopped = step.run(&mut hills(64, None), &job).expect_err("it is stopped");
        assert!(matches!(stopped, Error::Interrupted(_)), "{stopped}");
        let kept = watcher.kept.into_inner().expect("not poisoned");
        assert_eq!(kept.as_ref().map(|kept| kept.iteration), Some(5));
        let mut resumed = hills(64, None);
        let job = Job { resume: kept, ..Job::unwatched(7) };
        let after = step.run(&mut resumed, &job).expect("it goes on").budget;
        assert!(heights(&resumed) == heights(&whole), "{levels} levels");
        assert_eq!(after, budget, "{levels} levels");
    }
}

/// Root mean square of the differences of heights of 128² and of 256² cells, and their mean, as shares of the relief.
fn apart(step: &StreamPower) -> [f64; 2] {
    let of_size = |side: usize| {
        let mut landscape = hills(side, None);
        let solid = run(step, &mut landscape).budget.expect("is kept").solid;
        assert!(solid.error().abs() < 1e-6, "{side}: {}", solid.error());
        landscape.field("height").expect("is there").clone()
    };
    let (coarse, fine) = (of_size(128), of_size(256));
    let relief = f64::from(fine.range(None).map_or(0.0, |(low, high)| high - low));
    assert!(relief > 200.0, "{relief} m");
    let (mut squares, mut mean) = (0.0, 0.0);
    for (cell, &height) in coarse.values().iter().enumerate() {
        let (x, y) = (2 * (cell % 128), 2 * (cell / 128));
        let same = (0..4).map(|at| f64::from(fine.at(x + at % 2, y + at / 2))).sum::<f64>() / 4.0;
        squares += (f64::from(height) - same).powi(2);
        mean += f64::from(height) - same;
    }
    [(squares / 16_384.0).sqrt() / relief, mean / 16_384.0 / relief]
}

#[test]
fn landscapes_that_begin_on_the_same_grid_are_alike_at_every_size() {
    let step = StreamPower { levels: 8, coarsest: 200.0, hillslope_area: 100_000.0, ..step() };
    let [square, mean] = apart(&step);
    assert!(square < 0.07 && mean.abs() < 0.02, "{square} and {mean}");
    // Where finer cells only add detail they are nearly the same, whether or not there are coarser ones.
    for coarsest in [100.0, 200.0] {
        let [square, mean] = apart(&StreamPower { coarsest, settled: Some(100.0), ..step.clone() });
        assert!(square < 0.03 && mean.abs() < 0.005, "{square} and {mean} from {coarsest} m");
    }
}

#[test]
fn rivers_without_an_outlet_are_told_of_and_a_sea_that_is_not_there_is_refused() {
    let step = StreamPower { duration: 100_000.0, outlets: Outlets::Sea, ..step() };
    let missing = hills(32, None);
    let refused = step.check_on(&missing.domain).expect_err("there is no sea");
    assert!(refused.to_string().contains("`sea_level` in [landscape]"), "{refused}");
    let mut high = hills(32, Some(-5000.0));
    let notes = run(&step, &mut high).notes;
    assert!(notes[0].contains("below the sea, at -5000 m: no river leaves"), "{notes:?}");
    assert_eq!(run(&step, &mut hills(32, Some(-10.0))).notes, [""; 0]);
}

#[test]
fn soft_beds_wear_faster_and_what_is_left_of_them_lies_where_it_lay() {
    let with_bed = |erodibility: f64| {
        let mut landscape = hills(64, None);
        let rock = Material::built_in("rock").expect("built in");
        let bed =
            Material { name: "bed".to_owned(), erodibility: erodibility * rock.erodibility, ..rock.clone() };
        landscape.materials = vec![rock, bed];
        let size = landscape.domain.size;
        landscape.insert("bed", "m", Field::filled(size, 300.0));
        run(
            &StreamPower { materials: true, deposition: 0.0, settling_length: 0.0, ..step() },
            &mut landscape,
        );
        landscape
    };
    let (hard, soft) = (with_bed(0.3), with_bed(3.0));
    let highest =
        |landscape: &Landscape| landscape.field("height").expect("is there").range(None).expect("cells").1;
    assert!(highest(&hard) > 1.5 * highest(&soft), "{} and {} m", highest(&hard), highest(&soft));
    for landscape in [hard, soft] {
        let layer = |name: &str| landscape.field(name).expect("is there").clone();
        let (height, bedrock, bed) = (layer("height"), layer("bedrock"), layer("bed"));
        for cell in 0..64 * 64 {
            let [height, bedrock, bed] = [&height, &bedrock, &bed].map(|field| field.values()[cell]);
            assert!((height - bedrock - bed).abs() < 1e-2 && bed >= 0.0, "{height} {bedrock} {bed}");
        }
    }
}

#[test]
fn a_hard_bed_stands_as_a_cliff_over_a_soft_one_that_lies_back() {
    // A plateau of 3.2 km that rises by 600 m: soft ground with a hard bed on it, 100 m thick.
    let size = Size { columns: 128, rows: 128 };
    let mut landscape = Landscape::new(Domain::new(size, 25.0));
    let noise = |x: usize, y: usize| signed2(5, x as i64, y as i64) as f32;
    landscape.insert("height", "m", Field::from_function(size, noise));
    let rock = Material::built_in("rock").expect("built in");
    let soft = Material { talus_deg: 30.0, ..rock.clone() };
    let hard =
        Material { name: "cap".to_owned(), erodibility: 0.2 * rock.erodibility, talus_deg: 65.0, ..rock };
    landscape.materials = vec![soft, hard];
    landscape.insert("cap", "m", Field::filled(size, 100.0));
    let step = StreamPower {
        duration: 800_000.0,
        critical_slope_deg: 80.0,
        creep: 0.0,
        settling_length: 0.0,
        materials: true,
        ..StreamPower::default()
    };
    run(&step, &mut landscape);
    let layer = |name: &str| landscape.field(name).expect("is there").clone();
    let (height, cap) = (layer("height"), layer("cap"));
    let (mut soft, mut hard) = (Vec::new(), Vec::new());
    for (x, y) in (1..127).flat_map(|y| (1..127).map(move |x| (x, y))) {
        let fall = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
            .map(|(beside, row)| (height.at(x, y) - height.at(beside, row)) / 25.0);
        let steepest = fall.into_iter().fold(0.0, f32::max).atan().to_degrees();
        if cap.at(x, y) < 0.01 { soft.push(steepest) } else { hard.push(steepest) }
    }
    let nineteen_of_twenty = |slopes: &mut Vec<f32>| {
        slopes.sort_by(f32::total_cmp);
        slopes[slopes.len() * 19 / 20]
    };
    let (of_soft, of_hard) = (nineteen_of_twenty(&mut soft), nineteen_of_twenty(&mut hard));
    assert!(soft.len() > 1000 && hard.len() > 300, "{} soft cells, {} hard ones", soft.len(), hard.len());
    // Points between which rivers run lie off the middles of cells, so that single slopes between middles may be steeper.
    assert!((27.0..42.0).contains(&of_soft) && of_hard > 55.0, "{of_soft}° and {of_hard}°");
}

#[test]
fn noise_rises_to_ridges_that_know_no_axis() {
    // Of all slopes of a range from noise, as much falls along the axes as along the diagonals.
    let size = Size { columns: 256, rows: 256 };
    let along_axes = |irregularity: f64| {
        let mut landscape = Landscape::new(Domain::new(size, 200.0));
        let noise = |x: usize, y: usize| signed2(5, x as i64, y as i64) as f32;
        landscape.insert("height", "m", Field::from_function(size, noise));
        run(&StreamPower { irregularity, creep: 0.1, ..StreamPower::default() }, &mut landscape);
        let height = landscape.field("height").expect("is there").clone();
        // Mean of exp(8iθ)'s fourth harmonic over the directions in which ground falls.
        let (mut cos, mut count) = (0.0, 0.0);
        for (x, y) in (1..255).flat_map(|y| (1..255).map(move |x| (x, y))) {
            let at = |x: usize, y: usize| f64::from(height.at(x, y));
            let (east, south) = (at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1));
            cos += (4.0 * south.atan2(east)).cos();
            count += 1.0;
        }
        cos / count
    };
    let (regular, irregular) = (along_axes(0.0), along_axes(0.7));
    assert!(irregular.abs() < 0.06, "fourth harmonic {irregular}, on a regular grid {regular}");
}
