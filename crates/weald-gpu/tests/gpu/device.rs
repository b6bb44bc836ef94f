//! Programs on a device do what they say: cell by cell, step by step, sum by sum.

use crate::programs::{count, gpu, lanes, load, mix, mix_with_mask, mixed, numbers, table, weather};
use weald::engine::device::{Loaded, Window};
use weald::grid::Size;

/// No multiple of a workgroup's side in either direction.
const SIZE: Size = Size { columns: 37, rows: 23 };

fn all_land() -> Vec<bool> {
    vec![true; SIZE.cells()]
}

fn amounts(amount: f32, steps: usize) -> Vec<Vec<u32>> {
    vec![vec![amount.to_bits()]; steps]
}

#[test]
fn cells_see_their_neighbours_and_walls_and_the_weather_of_each_step() {
    let Some(gpu) = gpu() else { return };
    let (start, valid) = (numbers(SIZE.cells()), all_land());
    for steps in [0, 1, 2, 7, 8] {
        let mut loaded = load(&gpu, &mix(), SIZE);
        loaded.write(0, &start).expect("written");
        let forcing = weather((0..steps).map(|step| step * step + 1));
        loaded.run(&forcing, false).expect("ran");
        let expected = mixed(SIZE, &valid, &start, &forcing);
        assert!(steps == 0 || expected != start, "something moved");
        assert!(loaded.read(0).expect("read") == expected, "after {steps} steps");
    }
}

#[test]
fn more_steps_than_a_submission_holds_each_have_their_weather() {
    let Some(gpu) = gpu() else { return };
    let small = gpu.with_memory(1 << 20).expect("a mebibyte is enough");
    let start = numbers(SIZE.cells());
    let mut loaded = load(&small, &mix(), SIZE);
    loaded.write(0, &start).expect("written");
    let forcing = weather((0..333).map(|step| step * 7 % 101));
    loaded.run(&forcing[..100], false).expect("ran");
    loaded.run(&forcing[100..], false).expect("ran");
    assert!(loaded.read(0).expect("read") == mixed(SIZE, &all_land(), &start, &forcing));
}

#[test]
fn work_cut_into_many_submissions_gives_the_same_bits() {
    let Some(gpu) = gpu() else { return };
    let size = Size { columns: 200, rows: 150 };
    let (start, valid) = (numbers(size.cells()), vec![true; size.cells()]);
    let forcing = weather(0..9);
    let expected = mixed(size, &valid, &start, &forcing);
    for bytes in [1, 60_000, 700_000, u64::MAX] {
        let mut loaded = load(&gpu.clone().moving_at_most(bytes), &mix(), size);
        loaded.write(0, &start).expect("written");
        loaded.run(&forcing, false).expect("ran");
        assert!(loaded.read(0).expect("read") == expected, "{bytes} bytes a submission");
    }
}

#[test]
fn no_link_leads_into_a_cell_without_data() {
    let Some(gpu) = gpu() else { return };
    let valid: Vec<bool> = (0..SIZE.cells()).map(|cell| cell % 7 != 3).collect();
    let mask: Vec<f32> = valid.iter().flat_map(|&valid| [f32::from(u8::from(valid)), 1.0]).collect();
    let start = numbers(SIZE.cells());
    let mut loaded = load(&gpu, &mix_with_mask(), SIZE);
    loaded.write(0, &start).expect("written");
    loaded.write(2, &mask).expect("written");
    let forcing = weather([1, 2, 3]);
    loaded.run(&forcing, false).expect("ran");
    let expected = mixed(SIZE, &valid, &start, &forcing);
    assert!(expected != mixed(SIZE, &all_land(), &start, &forcing), "the mask matters");
    assert!(loaded.read(0).expect("read") == expected);
}

#[test]
fn vectors_come_cell_by_cell_and_layers_plane_by_plane() {
    let Some(gpu) = gpu() else { return };
    let (vectors, planes) = (numbers(4 * SIZE.cells()), numbers(3 * SIZE.cells()));
    let mut loaded = load(&gpu, &lanes(), SIZE);
    loaded.write(0, &vectors).expect("written");
    loaded.write(1, &planes).expect("written");
    loaded.run(&[vec![], vec![]], false).expect("ran");
    let added = |at: usize| {
        let cell = at / 4;
        [0.5, 8.0, (cell % SIZE.columns) as f32, (cell / SIZE.columns) as f32][at % 4]
    };
    let expected: Vec<f32> = vectors.iter().enumerate().map(|(at, value)| value + 2.0 * added(at)).collect();
    assert!(loaded.read(0).expect("read") == expected);
    let added = |at: usize| (at / SIZE.cells()) as f32 + 8.0;
    let expected: Vec<f32> = planes.iter().enumerate().map(|(at, value)| value + 2.0 * added(at)).collect();
    assert!(loaded.read(1).expect("read") == expected);
}

#[test]
fn a_table_of_whole_numbers_is_the_same_for_all_cells_and_grids() {
    let Some(gpu) = gpu() else { return };
    let words: Vec<f32> =
        (0..SIZE.columns as u32).flat_map(|column| [7, 100 + column]).map(f32::from_bits).collect();
    let mut loaded = load(&gpu, &table(SIZE.columns), SIZE);
    for size in [SIZE, Size { columns: 5, rows: 3 }] {
        loaded.begin(size, &Window::whole(size)).expect("begun");
        loaded.write(0, &vec![1.0; size.cells()]).expect("written");
        loaded.write(1, &words).expect("written");
        loaded.run(&[vec![], vec![]], false).expect("ran");
        let expected: Vec<f32> =
            (0..size.cells()).map(|cell| (1 + 2 * (100 + cell % size.columns)) as f32).collect();
        assert!(loaded.read(0).expect("read") == expected, "{size:?}");
    }
    let bits: Vec<u32> = loaded.read(1).expect("read").iter().map(|word| word.to_bits()).collect();
    assert_eq!(bits[..4], [7, 100, 7, 101]);
}

#[test]
fn sums_of_thousands_of_steps_lose_nothing() {
    let Some(gpu) = gpu() else { return };
    // A workgroup's cells add without rounding; its total soon has more digits than `f32`.
    let (amount, steps) = (40_961.0_f32 / 1_048_576.0, 5000);
    let naive = (0..steps).fold(0.0_f32, |sum, _| sum + 256.0 * amount);
    assert!(f64::from(naive) != 256.0 * f64::from(amount) * f64::from(steps), "plain sums would be exact");
    let mut loaded = load(&gpu, &count(), SIZE);
    loaded.run(&amounts(amount, steps as usize), false).expect("ran");
    let expected = SIZE.cells() as f64 * f64::from(amount) * f64::from(steps);
    assert_eq!(loaded.sums().expect("read"), [0.0, 0.0, expected, 0.0, 0.0]);
    loaded.clear_sums().expect("cleared");
    loaded.run(&amounts(1.0, 1), false).expect("ran");
    assert_eq!(loaded.sums().expect("read")[2], SIZE.cells() as f64, "sums began anew");
}

#[test]
fn only_the_cells_of_the_own_window_are_counted() {
    let Some(gpu) = gpu() else { return };
    let mut loaded = load(&gpu, &count(), SIZE);
    let own = Window { columns: 15..33, rows: 3..17 };
    loaded.begin(SIZE, &own).expect("begun");
    loaded.run(&amounts(1.0, 2), false).expect("ran");
    assert_eq!(loaded.sums().expect("read")[2], (2 * 18 * 14) as f64);
}

#[test]
fn recorded_passes_run_in_recorded_steps_alone() {
    let Some(gpu) = gpu() else { return };
    let mut loaded = load(&gpu, &count(), SIZE);
    loaded.run(&amounts(1.0, 3), false).expect("ran");
    loaded.run(&amounts(2.0, 2), true).expect("ran");
    loaded.run(&amounts(1.0, 1), false).expect("ran");
    assert_eq!(loaded.read(1).expect("read"), vec![4.0; SIZE.cells()]);
    assert_eq!(loaded.read(0).expect("read"), vec![6.0; SIZE.cells()], "all steps ran");
    loaded.begin(SIZE, &Window::whole(SIZE)).expect("begun");
    assert_eq!(loaded.read(1).expect("read"), vec![0.0; SIZE.cells()], "means start at zero");
}

#[test]
fn a_smaller_grid_runs_in_the_memory_of_a_larger_one() {
    let Some(gpu) = gpu() else { return };
    let gpu = gpu.with_memory(16 << 20).expect("enough");
    let mut loaded = load(&gpu, &mix(), SIZE);
    let held = gpu.allocated();
    for size in [Size { columns: 20, rows: 10 }, Size { columns: 23, rows: 37 }, SIZE] {
        let (start, valid, forcing) = (numbers(size.cells()), vec![true; size.cells()], weather([4, 5, 6]));
        loaded.begin(size, &Window::whole(size)).expect("begun");
        loaded.write(0, &start).expect("written");
        loaded.run(&forcing, false).expect("ran");
        assert!(loaded.read(0).expect("read") == mixed(size, &valid, &start, &forcing), "{size:?}");
    }
    assert_eq!(gpu.allocated(), held, "the memory was used again");
}

#[test]
fn the_watch_finds_the_first_value_that_is_no_number() {
    let Some(gpu) = gpu() else { return };
    for bytes in [300, u64::MAX] {
        let mut loaded = load(&gpu.clone().moving_at_most(bytes), &mix(), SIZE);
        let mut values = numbers(SIZE.cells());
        values[5] = f32::MAX;
        loaded.write(0, &values).expect("written");
        assert_eq!(loaded.first_not_finite(0).expect("looked"), None);
        for (at, value) in [(800, f32::NAN), (403, f32::NEG_INFINITY), (0, f32::INFINITY)] {
            values[at] = value;
            loaded.write(0, &values).expect("written");
            assert_eq!(loaded.first_not_finite(0).expect("looked"), Some(at), "{value}");
        }
        assert_eq!(loaded.first_not_finite(1).expect("looked"), None, "another buffer");
        let small = Size { columns: 4, rows: 4 };
        loaded.begin(small, &Window::whole(small)).expect("begun");
        loaded.write(0, &numbers(16)).expect("written");
        assert_eq!(loaded.first_not_finite(0).expect("looked"), None, "what lies behind does not count");
    }
}

#[test]
fn going_back_brings_back_state_means_and_sums() {
    let Some(gpu) = gpu() else { return };
    let all = |loaded: &mut dyn Loaded| {
        (loaded.read(0).expect("read"), loaded.read(1).expect("read"), loaded.sums().expect("read"))
    };
    let mut loaded = load(&gpu, &count(), SIZE);
    loaded.run(&amounts(1.5, 3), true).expect("ran");
    loaded.keep().expect("kept");
    let kept = all(&mut *loaded);
    loaded.run(&amounts(7.0, 4), true).expect("ran");
    assert_ne!(all(&mut *loaded), kept);
    for _ in 0..2 {
        loaded.go_back().expect("gone back");
        assert_eq!(all(&mut *loaded), kept);
    }
}

#[test]
fn steps_go_on_from_a_kept_state_whichever_buffer_holds_it() {
    let Some(gpu) = gpu() else { return };
    let (start, forcing) = (numbers(SIZE.cells()), weather(0..12));
    for (before, between) in [(3, 1), (3, 2), (4, 1), (4, 2)] {
        let mut loaded = load(&gpu, &mix(), SIZE);
        loaded.write(0, &start).expect("written");
        loaded.run(&forcing[..before], false).expect("ran");
        loaded.keep().expect("kept");
        loaded.run(&forcing[..between], false).expect("ran");
        loaded.go_back().expect("gone back");
        loaded.run(&forcing[before..], false).expect("ran");
        assert!(
            loaded.read(0).expect("read") == mixed(SIZE, &all_land(), &start, &forcing),
            "{before} {between}"
        );
    }
}
