//! A page and its worker share no memory: what the page sees is what a thread of the same program would show.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use weald::edit::{Brush, Effect, Falloff, Setting};
use weald::engine::Engine;
use weald::recipe::source::Value;
use weald_studio::work::{
    Opening, Parcel, Phase, Remote, Served, Shown, Simulates, Status, Task, Thread, Work,
};

const RECIPE: &str = r#"
[landscape]
size = [40, 32]
cell = 20.0
seed = 3
[[step]]
do = "diamond-square"
relief = 200.0
[[step]]
do = "hydraulic"
model = "stava"
iterations = 50
[[step]]
do = "slope"
[[step]]
do = "scatter"
plant = "fern"
count = 30
spacing = 2.0
into = "ferns"
[[output]]
layer = "height"
file = "height.tif"
"#;

fn opening(text: &str) -> Task {
    Task::Open(Box::new(Opening {
        file: "valley.toml".to_owned(),
        text: text.to_owned(),
        revision: 7,
        engine: Engine::Cpu,
        steps: None,
        keeps_edits: false,
    }))
}

fn tasks() -> Vec<Task> {
    let stroke = |effect, number| Task::Stroke {
        brush: Brush {
            path: vec![[300.0, 300.0], [420.0, 330.5]],
            radius: 60.0,
            falloff: Falloff::Gaussian,
            strength: 0.7,
            effect,
        },
        stroke: number,
        replaces: false,
    };
    let rain = Setting { key: "rain".to_owned(), value: Value::Number(0.013) };
    vec![
        opening(RECIPE),
        Task::Advance(11),
        stroke(Effect::AddWater { depth: 1.0 / 3.0 }, 1),
        Task::Set(rain),
        Task::Advance(5),
        stroke(Effect::Add { material: "bedrock".to_owned(), thickness: 2.1 }, 2),
        Task::Name("before".to_owned()),
        Task::Undo,
        Task::Redo,
        Task::Advance(2),
        Task::Undo,
    ]
}

/// A page and a worker in this process, between which messages are carried by hand.
struct Apart {
    served: Served,
    remote: Rc<Remote>,
    work: Work,
    to_worker: Rc<RefCell<VecDeque<Parcel>>>,
    to_page: Arc<Mutex<VecDeque<Parcel>>>,
}

impl Apart {
    fn new() -> Self {
        let (to_worker, to_page) =
            (Rc::<RefCell<VecDeque<_>>>::default(), Arc::<Mutex<VecDeque<_>>>::default());
        let (sent, shown) = (Rc::clone(&to_worker), Arc::clone(&to_page));
        let served =
            Served::new(Simulates::default(), move |parcel| shown.lock().expect("whole").push_back(parcel));
        let post = move |parcel| sent.borrow_mut().push_back(parcel);
        let remote = Rc::new(Remote::new(post, Box::new(|_, _| {})));
        let work = Work::Remote(Rc::clone(&remote));
        Self { served, remote, work, to_worker, to_page }
    }

    /// Carries messages until nobody has anything to do.
    fn settle(&mut self) -> Status {
        loop {
            for parcel in self.to_worker.borrow_mut().drain(..) {
                self.served.take(parcel).expect("understood");
            }
            let rest = self.served.rest();
            if let Some(rest) = rest {
                std::thread::sleep(rest);
                self.served.turn();
            }
            for parcel in self.to_page.lock().expect("whole").drain(..) {
                self.remote.take(parcel);
            }
            if rest.is_none() {
                return self.work.status();
            }
        }
    }
}

/// What a thread shows once all that was asked is done and the steps after the one that is held have run.
fn by_thread(tasks: Vec<Task>) -> Status {
    let work = Work::Thread(Thread::new(|| {}).expect("a thread"));
    let asked = tasks.len() as u64;
    for task in tasks {
        work.ask(task);
    }
    let begun = Instant::now();
    loop {
        std::thread::sleep(Duration::from_millis(20));
        let status = work.status();
        let is_whole = |shown: &Shown| shown.steps == usize::MAX && shown.changes == status.changes;
        let is_done = status.done == asked && status.phase == Phase::Idle;
        if is_done && status.shown.as_ref().is_some_and(is_whole) {
            return status;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "it does not end: {status:?}");
    }
}

#[test]
fn a_worker_elsewhere_shows_what_a_thread_shows() {
    let mut apart = Apart::new();
    for task in tasks() {
        apart.work.ask(task);
    }
    let (there, here) = (apart.settle(), by_thread(tasks()));
    assert_eq!((&there.error, &there.notes), (&here.error, &here.notes));
    assert_eq!(there.error, None);
    assert_eq!((there.steps, there.held, &there.materials), (here.steps, here.held, &here.materials));
    assert_eq!((&there.moments, &there.names), (&here.moments, &here.names));
    assert!(!there.moments.is_empty());
    let (shown, wanted) = (there.shown.expect("shown"), here.shown.expect("shown"));
    assert_eq!(*shown.landscape, *wanted.landscape);
    assert_eq!(shown.landscape.materials, wanted.landscape.materials);
    assert_eq!((shown.lowest, shown.steps, shown.revision), (wanted.lowest, wanted.steps, wanted.revision));
}

#[test]
fn surfaces_come_over_as_they_are_and_only_once() {
    let mut apart = Apart::new();
    apart.work.ask(opening(&RECIPE.replace("[[step]]\ndo = \"slope\"\n", "")));
    apart.work.ask(Task::Advance(3));
    let mut seen = 0;
    for parcel in apart.to_worker.borrow_mut().drain(..) {
        apart.served.take(parcel).expect("understood");
    }
    for _ in 0..2 {
        apart.served.turn();
    }
    for parcel in apart.to_page.lock().expect("whole").drain(..) {
        seen += parcel.arrays.len();
        apart.remote.take(parcel);
    }
    let surface = apart.work.status().surface.expect("it has run");
    assert_eq!((surface.ground.size().columns, surface.ground.size().rows), (40, 32));
    let whole: f32 = surface.canvas.bedrock.at(3, 4)
        + surface.canvas.thickness.iter().map(|layer| layer.at(3, 4)).sum::<f32>();
    assert!((whole - surface.ground.at(3, 4)).abs() < 1e-3);
    assert!(seen >= 7, "a landscape and the planes of a surface");
    apart.settle();
    apart.served.turn();
    let again: usize = apart.to_page.lock().expect("whole").drain(..).map(|parcel| parcel.arrays.len()).sum();
    assert_eq!(again, 0, "what is known is not sent again");
}

#[test]
fn a_damaged_message_is_told_and_the_page_goes_on() {
    let mut apart = Apart::new();
    let broken = Parcel { text: "{\"files\":[],\"content\":\"Dance\"}".to_owned(), ..Parcel::default() };
    assert!(apart.served.take(broken).expect_err("no task").to_string().contains("load the page again"));
    apart.remote.take(Parcel { text: "{".to_owned(), ..Parcel::default() });
    assert!(apart.work.status().error.expect("told").contains("load the page again"));
    apart.work.ask(opening(RECIPE));
    let status = apart.settle();
    assert!(status.error.is_none() && status.shown.is_some());
}

#[test]
fn what_is_kept_in_case_that_the_program_is_killed_does_not_hide_what_was_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let [saved, kept] = ["landscape.toml", ".unsaved.toml"].map(|name| folder.path().join(name));
    let mut tasks = vec![opening(RECIPE), Task::Advance(3), Task::Save(saved.clone()), Task::Advance(1)];
    tasks.push(Task::Keep(kept.clone()));
    let status = by_thread(tasks.clone());
    // A worker may do both between two frames of the window.
    let (file, state) = status.saved.expect("saved");
    assert_eq!((file, state.changes + 1), (saved, status.changes));
    let (file, state) = status.autosaved.expect("the step after it is kept");
    assert_eq!((file, state.changes), (kept, status.changes));
    tasks.push(opening(RECIPE));
    let status = by_thread(tasks);
    assert!(
        status.saved.is_none() && status.autosaved.is_none(),
        "of another project nothing is written yet"
    );
}
