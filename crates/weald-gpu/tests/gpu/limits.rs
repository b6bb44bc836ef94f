//! What a device cannot do is said, and never passes a budget or ends the program.

use crate::programs::{count, gpu, load, mix, numbers, pass, refusal, weather};
use weald::engine::device::{Device, Window};
use weald::engine::program::{Program, Uniforms};
use weald::grid::Size;
use weald_gpu::Gpu;

const SIZE: Size = Size { columns: 100, rows: 60 };

#[test]
fn the_budget_is_never_passed_and_comes_back_when_programs_go() {
    let Some(gpu) = gpu() else { return };
    let gpu = gpu.with_memory(4 << 20).expect("enough");
    assert_eq!((gpu.allocated(), gpu.memory()), (0, 4 << 20));
    let half = Size { columns: 512, rows: 400 };
    let mut loaded = load(&gpu, &mix(), half);
    assert!(gpu.allocated() > 8 * half.cells() as u64, "two buffers and more");
    let message = refusal(gpu.load(&mix(), Size { columns: 1024, rows: 800 }));
    assert!(message.contains("3.1 MiB") && message.contains("of 4.0 MiB are in use"), "{message}");
    assert!(message.contains("buffer `here` of `mix`") && message.contains("--gpu-memory"), "{message}");
    loaded.write(0, &numbers(half.cells())).expect("written");
    loaded.run(&weather(0..100), false).expect("ran");
    loaded.keep().expect("there is room for a copy");
    loaded.read(0).expect("read");
    assert!(gpu.peak() <= gpu.memory(), "{} bytes", gpu.peak());
    assert!(gpu.peak() > 12 * half.cells() as u64, "the copy counts");
    drop(loaded);
    assert_eq!(gpu.allocated(), 0);
}

#[test]
fn the_count_misses_nothing_that_the_driver_holds() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::any().expect("a device of its own").with_memory(64 << 20).expect("enough");
    let Some(before) = gpu.allocated_by_driver() else { return };
    let size = Size { columns: 1000, rows: 2000 };
    let mut loaded = load(&gpu, &mix(), size);
    loaded.keep().expect("kept");
    loaded.write(0, &numbers(size.cells())).expect("written");
    loaded.run(&weather(0..40), false).expect("ran");
    loaded.first_not_finite(0).expect("looked");
    let held = gpu.allocated_by_driver().expect("it said so before") - before;
    let (counted, slack) = (gpu.allocated(), 1 << 20);
    assert!(counted > 24_000_000, "three buffers of 8 MB");
    assert!(held <= counted + slack, "the driver holds {held} bytes, {counted} are counted");
    assert!(held <= gpu.memory());
}

#[test]
fn a_copy_that_does_not_fit_is_refused_and_the_program_goes_on() {
    let Some(gpu) = gpu() else { return };
    let gpu = gpu.with_memory(4 << 20).expect("enough");
    let size = Size { columns: 512, rows: 500 };
    let mut loaded = load(&gpu, &count(), size);
    refusal(loaded.keep());
    let message = refusal(loaded.go_back());
    assert!(message.contains("never kept"), "{message}");
    loaded.run(&[vec![1.0_f32.to_bits()]], false).expect("it still runs");
    assert_eq!(loaded.sums().expect("read")[2], size.cells() as f64);
    assert!(gpu.peak() <= gpu.memory());
}

#[test]
fn a_budget_below_a_mebibyte_is_refused() {
    let Some(gpu) = gpu() else { return };
    assert!(refusal(gpu.with_memory(1000)).contains("at least 1.0 MiB"));
}

#[test]
fn grids_that_no_device_holds_are_refused_before_anything_is_allocated() {
    let Some(gpu) = gpu() else { return };
    let gpu = gpu.with_memory(64 << 20).expect("enough");
    let most = usize::MAX / 4;
    for (columns, rows) in
        [(0, 5), (5, 0), (20_000_000, 1), (1, 20_000_000), (1_000_000, 1_000_000), (most, most)]
    {
        let message = refusal(gpu.load(&mix(), Size { columns, rows }));
        assert!(message.contains(&format!("{columns} × {rows}")), "{message}");
    }
    assert!(gpu.peak() < 1 << 20, "{} bytes", gpu.peak());
}

#[test]
fn a_grid_larger_than_the_loaded_one_cannot_begin() {
    let Some(gpu) = gpu() else { return };
    let mut loaded = load(&gpu, &mix(), SIZE);
    let larger = Size { columns: 101, rows: 60 };
    let message = refusal(loaded.begin(larger, &Window::whole(larger)));
    assert!(message.contains("100 × 60") && message.contains("101 × 60"), "{message}");
    loaded.write(0, &numbers(SIZE.cells())).expect("the loaded grid stays");
}

#[test]
fn a_wrong_number_of_values_or_words_is_refused() {
    let Some(gpu) = gpu() else { return };
    let mut loaded = load(&gpu, &mix(), SIZE);
    assert!(refusal(loaded.write(0, &[1.0])).contains("`here` takes 6000 numbers, not 1"));
    assert!(refusal(loaded.read(7)).contains("2 buffers"));
    assert!(refusal(loaded.run(&[vec![1, 2]], false)).contains("1 words was given 2"));
}

#[test]
fn a_shader_that_is_wrong_names_its_pass_and_harms_nothing() {
    let Some(gpu) = gpu() else { return };
    let shader = "@compute @workgroup_size(16, 16) fn broken() { nonsense(); }";
    let passes = vec![pass("broken", shader, vec![0], vec![1])];
    let program = Program { passes, weather: Uniforms::default(), ..mix() };
    let message = refusal(gpu.load(&program, SIZE));
    assert!(message.contains("pass `broken` of `mix`") && message.contains("nonsense"), "{message}");
    load(&gpu, &mix(), SIZE).run(&weather([1]), false).expect("another program runs");
}

#[test]
fn swaps_that_make_no_pairs_are_refused() {
    let Some(gpu) = gpu() else { return };
    for swaps in [vec![[0, 0]], vec![[0, 1], [1, 0]], vec![[0, 9]]] {
        let message = refusal(gpu.load(&Program { swaps, ..mix() }, SIZE));
        assert!(message.contains("swapped once"), "{message}");
    }
}

#[test]
fn every_call_to_a_lost_device_says_so() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::any().expect("a device of its own");
    let mut loaded = load(&gpu, &count(), SIZE);
    loaded.run(&[vec![0]], true).expect("it ran before");
    loaded.keep().expect("kept");
    gpu.lose();
    let values = numbers(SIZE.cells());
    let calls = [
        ("begin", loaded.begin(SIZE, &Window::whole(SIZE))),
        ("write", loaded.write(0, &values)),
        ("read", loaded.read(0).map(drop)),
        ("run", loaded.run(&[vec![0]], false)),
        ("sums", loaded.sums().map(drop)),
        ("clear_sums", loaded.clear_sums()),
        ("first_not_finite", loaded.first_not_finite(0).map(drop)),
        ("go_back", loaded.go_back()),
        ("keep", loaded.keep()),
        ("load", gpu.load(&mix(), SIZE).map(drop)),
        ("copy_bandwidth", gpu.copy_bandwidth().map(drop)),
    ];
    for (call, result) in calls {
        let message = refusal(result);
        assert!(message.contains("the GPU was lost"), "{call}: {message}");
    }
}

#[test]
fn a_device_lost_between_submissions_ends_the_run_with_an_error() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::any().expect("a device of its own").moving_at_most(10_000);
    let mut loaded = load(&gpu, &mix(), SIZE);
    let run = std::thread::spawn(move || {
        loop {
            if let Err(error) = loaded.run(&weather(0..50), false) {
                return error;
            }
        }
    });
    std::thread::sleep(std::time::Duration::from_millis(50));
    gpu.lose();
    let message = refusal::<()>(Err(run.join().expect("no panic")));
    assert!(message.contains("the GPU was lost"), "{message}");
}

#[test]
fn the_report_names_adapter_and_driver() {
    let Some(gpu) = gpu() else { return };
    let adapter = gpu.adapter();
    assert!(adapter.contains('(') && adapter.len() > 8, "{adapter}");
    assert!(gpu.largest_buffer() >= 128 << 20, "what every adapter has");
    let small = gpu.with_memory(64 << 20).expect("enough");
    assert!(small.copy_bandwidth().expect("measured") > 1e7, "bytes per second");
    assert_eq!(small.allocated(), 0);
}

#[test]
fn hardware_is_never_software() {
    if let Some(gpu) = Gpu::hardware().expect("looking is no error") {
        assert!(!gpu.is_software(), "{}", gpu.adapter());
    }
}
