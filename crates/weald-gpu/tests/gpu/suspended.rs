//! A program that is suspended where it waits for its device, as on a page, gets what one gets that waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use weald::Error;
use weald::engine::Engine;
use weald::engine::device::Device;
use weald::error::DeviceErrorKind;
use weald::grid::Size;
use weald_gpu::{Gpu, Suspension};

use crate::common::run_on;
use crate::processes::{masked, whole_models};
use crate::programs::{gpu, load, mix, numbers, weather};

static SUSPENDED: AtomicUsize = AtomicUsize::new(0);
static WOKEN: AtomicUsize = AtomicUsize::new(0);

/// Suspends for a moment, whoever wakes it.
fn suspend(at_most: Duration) {
    SUSPENDED.fetch_add(1, Ordering::Relaxed);
    std::thread::sleep(at_most.min(Duration::from_micros(50)));
}

fn wake() {
    WOKEN.fetch_add(1, Ordering::Relaxed);
}

/// The device of `gpu`, opened once more.
fn suspending(name: Option<String>) -> Gpu {
    pollster::block_on(Gpu::suspending(name, Suspension { suspend, wake })).expect("a device")
}

#[test]
fn a_program_that_is_suspended_gets_the_bits_of_one_that_waits() {
    let Some(gpu) = gpu() else { return };
    let suspended = Engine::Device(Arc::new(suspending(None)));
    for step in whole_models() {
        let [mut waited, mut got] = [masked(), masked()];
        run_on(&*step, &mut waited, Engine::Device(Arc::new(gpu.clone())));
        run_on(&*step, &mut got, suspended.clone());
        for ((name, waited), (_, got)) in waited.layers().zip(got.layers()) {
            assert!(waited.field.values() == got.field.values(), "`{name}` of {step:?}");
        }
    }
    let [suspended, woken] = [&SUSPENDED, &WOKEN].map(|count| count.load(Ordering::Relaxed));
    assert!(suspended > 0 && woken > 0, "{suspended} times suspended and {woken} times woken");
}

#[test]
fn a_device_that_is_lost_wakes_nobody_and_is_told_of() {
    if gpu().is_none() {
        return;
    }
    let suspended = suspending(Some("a card that only scripts know".to_owned()));
    assert_eq!(suspended.adapter(), "a card that only scripts know");
    let size = Size::square(40).expect("small");
    let mut loaded = load(&suspended, &mix(), size);
    loaded.write(0, &numbers(size.cells())).expect("written");
    suspended.lose();
    let lost = loaded.run(&weather(0..9), false).and_then(|()| loaded.read(0).map(drop));
    let Err(Error::Device(error)) = lost else { panic!("it goes on without a device: {lost:?}") };
    assert!(matches!(error.kind, DeviceErrorKind::Lost { .. }), "{error:?}");
    assert!(error.message.contains("load the page again"), "{error:?}");
}
