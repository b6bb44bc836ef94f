//! A device that fails: an error where it was asked for, the CPU from the last state on where it may be replaced.

use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{landscape, mei, rough, run, worst_difference};
use weald_core::error::{DeviceError, DeviceErrorKind};
use weald_core::{Error, Landscape, Size};
use weald_engine::device::{Device, Loaded, Window};
use weald_engine::program::Program;
use weald_engine::step::Step;
use weald_engine::{Engine, Job, SavedSimulation, Unwatched, Watcher};
use weald_land::erode::hydraulic::Hydraulic;
use weald_land::generate::fault::Fault;

/// A device whose steps change nothing, and which is lost after a while.
#[derive(Debug)]
struct Failing {
    /// Steps that it takes before it is lost.
    steps: usize,
    taken: Arc<AtomicUsize>,
}

impl Device for Failing {
    fn adapter(&self) -> String {
        "a device that fails".to_owned()
    }

    fn memory(&self) -> u64 {
        1 << 30
    }

    fn largest_buffer(&self) -> u64 {
        1 << 28
    }

    fn load(&self, program: &Program, _: Size) -> Result<Box<dyn Loaded>, Error> {
        let buffers = vec![Vec::new(); program.buffers.len()];
        Ok(Box::new(Standing { buffers, left: self.steps, taken: Arc::clone(&self.taken) }))
    }
}

struct Standing {
    buffers: Vec<Vec<f32>>,
    left: usize,
    taken: Arc<AtomicUsize>,
}

impl Loaded for Standing {
    fn begin(&mut self, _: Size, _: &Window) -> Result<(), Error> {
        Ok(())
    }

    fn write(&mut self, buffer: usize, values: &[f32]) -> Result<(), Error> {
        self.buffers[buffer] = values.to_vec();
        Ok(())
    }

    fn read(&mut self, buffer: usize) -> Result<Vec<f32>, Error> {
        Ok(self.buffers[buffer].clone())
    }

    fn run(&mut self, weather: &[Vec<u32>], _: bool) -> Result<(), Error> {
        if weather.len() > self.left {
            let kind = DeviceErrorKind::Lost { reason: "somebody pulled it out".to_owned() };
            return Err(DeviceError::new(kind, "the device was lost: somebody pulled it out").into());
        }
        self.left -= weather.len();
        self.taken.fetch_add(weather.len(), Ordering::Relaxed);
        Ok(())
    }

    fn sums(&mut self) -> Result<Vec<f64>, Error> {
        Ok(Vec::new())
    }

    fn clear_sums(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn first_not_finite(&mut self, _: usize) -> Result<Option<usize>, Error> {
        Ok(None)
    }

    fn keep(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn go_back(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn write_part(&mut self, _: usize, _: &Window, _: &[f32]) -> Result<(), Error> {
        unimplemented!("nothing paints on it")
    }

    fn read_part(&mut self, _: usize, _: &Window) -> Result<Vec<f32>, Error> {
        unimplemented!("nothing paints on it")
    }

    fn keep_as(&mut self, _: u64) -> Result<(), Error> {
        unimplemented!("nobody goes back")
    }

    fn return_to(&mut self, _: u64) -> Result<(), Error> {
        unimplemented!("nobody goes back")
    }

    fn release(&mut self, _: u64) {}

    fn clear_means(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn set_constants(&mut self, _: &[u32]) -> Result<(), Error> {
        unimplemented!("no key changes")
    }

    fn show(&mut self) -> Result<(), Error> {
        Ok(())
    }
}

/// Keeps the checkpoints that it asks for at every look.
#[derive(Default)]
struct Keeper {
    kept: Mutex<Vec<u64>>,
}

impl Watcher for Keeper {
    fn checkpoint_due(&self) -> bool {
        true
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        self.kept.lock().expect("one thread").push(state.iteration);
        Ok(())
    }
}

const STEPS: u32 = 90;

/// Always the same weather, so that fewer steps are the same steps.
fn step(iterations: u32) -> Hydraulic {
    Hydraulic { rain_period: 1, ..mei(iterations) }
}

fn failing(steps: usize) -> (Arc<Failing>, Arc<AtomicUsize>) {
    let taken = Arc::new(AtomicUsize::new(0));
    (Arc::new(Failing { steps, taken: Arc::clone(&taken) }), taken)
}

fn ground() -> Landscape {
    landscape(rough(40, 30, 20.0, 5))
}

#[test]
fn a_device_that_was_asked_for_and_fails_is_an_error_that_says_why() {
    let job = Job { engine: Engine::Device(failing(20).0), ..Job::unwatched(7) };
    let error = step(STEPS).run(&mut ground(), &job).expect_err("the device fails");
    assert!(error.exit_code() == 1 && error.to_string().contains("pulled it out"), "{error:?}");
    let Error::Device(DeviceError { kind: DeviceErrorKind::Lost { reason }, .. }) = error else {
        panic!("{error:?}")
    };
    assert_eq!(reason, "somebody pulled it out");
}

#[test]
fn without_a_checkpoint_the_cpu_begins_again_and_says_so() {
    let job = Job { engine: Engine::DeviceElseCpu(failing(20).0), ..Job::unwatched(7) };
    let (mut expected, mut got) = (ground(), ground());
    run(&step(STEPS), &mut expected);
    let outcome = step(STEPS).run(&mut got, &job).expect("the CPU takes over");
    assert_eq!(expected, got);
    let note = outcome.notes.join("; ");
    assert!(note.contains("pulled it out") && note.contains("CPU after 0 iterations"), "{note}");
}

#[test]
fn the_cpu_goes_on_from_the_last_checkpoint() {
    let (device, taken) = failing(20);
    let keeper = Keeper::default();
    let job = Job { engine: Engine::DeviceElseCpu(device), watcher: &keeper, ..Job::unwatched(7) };
    let mut got = ground();
    let outcome = step(STEPS).run(&mut got, &job).expect("the CPU takes over");
    let done = taken.load(Ordering::Relaxed) as u32;
    let kept = keeper.kept.lock().expect("one thread").clone();
    assert!((1..=20).contains(&done) && kept.contains(&u64::from(done)), "{done} of {kept:?}");
    // The device changed nothing, so the rest of the steps is all that happened.
    let mut expected = ground();
    run(&step(STEPS - done), &mut expected);
    let moved = worst_difference(ground().field("height").expect("h"), expected.field("height").expect("h"));
    assert!(moved > 1e-3, "something moved: {moved}");
    assert_eq!(expected.field("height").expect("h"), got.field("height").expect("h"));
    let note = outcome.notes.join("; ");
    assert!(note.contains(&format!("CPU after {done} iterations")), "{note}");
}

#[test]
fn a_device_that_does_not_fail_is_not_replaced() {
    let (device, taken) = failing(1000);
    let job = Job { engine: Engine::DeviceElseCpu(device), watcher: &Unwatched, ..Job::unwatched(7) };
    let mut got = ground();
    step(STEPS).run(&mut got, &job).expect("the device does it");
    assert_eq!(taken.load(Ordering::Relaxed), STEPS as usize);
    assert_eq!(ground().field("height").expect("h"), got.field("height").expect("h"));
}

#[test]
fn ground_that_a_lost_device_should_make_is_made_by_the_cpu_which_tells_why() {
    let (mut expected, mut got) = (ground(), ground());
    run(&Fault::default(), &mut expected);
    let job = Job { engine: Engine::DeviceElseCpu(failing(0).0), ..Job::unwatched(7) };
    let outcome = Fault::default().run(&mut got, &job).expect("the CPU takes over");
    assert_eq!(expected, got);
    assert!(outcome.notes[0].ends_with("the device was lost: somebody pulled it out"), "{:?}", outcome.notes);
}
