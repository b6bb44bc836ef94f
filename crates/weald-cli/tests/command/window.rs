//! The built program in a window of a real display server, driven by keys and a mouse: a template is opened, a key of it
//! changed, the land looked at, simulated, painted with soil and water, all of it undone and redone, saved, exported, closed
//! and opened again, and `weald run` gives the same files.

use std::cell::Cell;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long anything may take before the test says that it does not happen.
const TIMEOUT: Duration = Duration::from_mins(5);

/// How many times longer than at first the hand waits between keys at most, after it was too fast for a slow window.
const SLOWEST: u32 = 8;

/// Where the template that is chosen stands in the window, and the controls of size and seed.
const TEMPLATE: &str = "mousemove 470 108 click 1";
const SIZE: &str = "mousemove 126 84 click 1";
const SEED: &str = "mousemove 81 153 click 1";

/// A display server without a screen, and what works on it.
struct Display {
    server: Child,
    name: String,
    /// How many times longer than at first the hand waits.
    pace: Cell<u32>,
}

impl Drop for Display {
    fn drop(&mut self) {
        // It has nothing to lose.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Display {
    fn new() -> Self {
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"]);
        let mut server =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb is installed");
        let mut line = String::new();
        BufReader::new(server.stdout.take().expect("piped")).read_line(&mut line).expect("a number");
        Self { server, name: format!(":{}", line.trim()), pace: Cell::new(1) }
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY");
        command
    }

    /// Keys and mouse, by xdotool. What it sleeps is as much longer as the window was too slow before.
    fn act(&self, words: &str) {
        let slower = |seconds: &str| {
            let seconds: f64 = seconds.parse().expect("seconds");
            (seconds * f64::from(self.pace.get())).to_string()
        };
        let mut words_in_time: Vec<String> = words.split(' ').map(str::to_owned).collect();
        for at in 1..words_in_time.len() {
            if words_in_time[at - 1] == "sleep" {
                words_in_time[at] = slower(&words_in_time[at]);
            }
        }
        let done = self.command("xdotool").args(words_in_time).status().expect("xdotool is installed");
        assert!(done.success(), "xdotool {words}");
    }

    /// Types over what a control holds.
    fn type_into(&self, control: &str, text: &str) {
        self.act(&format!("{control} sleep 0.5 key ctrl+a sleep 0.2 type {text}"));
        self.act("key Return sleep 1");
    }

    fn title(&self) -> String {
        let found = self.command("xdotool").args(["search", "--name", "Weald", "getwindowname"]).output();
        String::from_utf8_lossy(&found.expect("xdotool is installed").stdout).into_owned()
    }

    /// Does something again and again, each time slower, until it has had its effect.
    fn until(&self, what: &str, mut act: impl FnMut(&Self), holds: impl Fn(&Self) -> bool) {
        let begun = Instant::now();
        self.pace.set(1);
        while !holds(self) {
            assert!(begun.elapsed() < TIMEOUT, "{what} does not come; the title is {:?}", self.title());
            act(self);
            self.pace.set((self.pace.get() + 1).min(SLOWEST));
            for _ in 0..20 {
                std::thread::sleep(Duration::from_millis(100));
                if holds(self) {
                    break;
                }
            }
        }
    }

    /// A picture of the display, to be looked at.
    fn picture(&self, name: &str) {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("window");
        fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join(name).with_extension("png");
        // Where ImageMagick is not there, nothing is looked at.
        let _ = self.command("import").args(["-window", "root"]).arg(file).status();
    }
}

struct Studio<'a> {
    display: &'a Display,
    program: Child,
}

impl<'a> Studio<'a> {
    fn open(display: &'a Display, what: Option<&Path>, own: &Path) -> Self {
        let mut command = display.command(env!("CARGO_BIN_EXE_weald"));
        command
            .arg("studio")
            .args(what)
            .arg("--trace")
            .arg(own.join("trace.json"))
            .env("WEALD_STATE", own)
            .env("XDG_RUNTIME_DIR", own);
        let program = command.stdout(Stdio::null()).spawn().expect("a studio");
        let studio = Self { display, program };
        studio.display.until("the window", |_| {}, |display| display.title().contains("Weald"));
        // No window manager gives it the keyboard; what is not yet shown cannot have it.
        let focus = |display: &Display| {
            let asked =
                display.command("xdotool").args(["search", "--name", "Weald", "windowfocus"]).output();
            asked.is_ok_and(|asked| asked.status.success())
        };
        studio.display.until("the keyboard", |_| {}, focus);
        studio
    }

    fn close(mut self) {
        let display = self.display;
        let begun = Instant::now();
        while self.program.try_wait().expect("a program").is_none() {
            assert!(begun.elapsed() < TIMEOUT, "it does not close");
            display.act("key ctrl+q");
            std::thread::sleep(Duration::from_millis(500));
        }
        assert!(self.program.wait().expect("gone").success());
    }
}

fn text(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_default()
}

/// Kinds of brushes in the script of a project, one a stroke.
fn strokes(project: &Path, brush: &str) -> usize {
    text(&project.join("landscape.edits.jsonl")).matches(&format!("\"do\": \"{brush}\"")).count()
}

/// What is not saved, which the studio keeps in a folder of its own.
fn unsaved(own: &Path) -> String {
    let folders = fs::read_dir(own.join("unsaved")).into_iter().flatten().flatten();
    folders.map(|folder| text(&folder.path().join("autosave.toml"))).collect()
}

/// Saves, and waits until what was written says so.
fn save(display: &Display, what: &str, holds: impl Fn() -> bool) {
    display.until(what, |display| display.act("key ctrl+s"), |_| holds());
}

/// `./check` runs it by itself: a window that shares its processors with all other tests may be too slow to be driven.
#[test]
#[ignore = "a window needs the machine for itself: cargo test -p weald-cli --test command -- --ignored window"]
fn a_template_is_changed_painted_undone_saved_exported_and_run_to_the_same_files() {
    let (display, folder) = (Display::new(), tempfile::tempdir().expect("a folder"));
    let (own, project) = (folder.path().join("own"), folder.path().join("project"));
    fs::create_dir_all(&own).expect("a folder");
    let studio = Studio::open(&display, None, &own);
    begin(&display, &own, &project);
    paint(&display, &project);
    undo_and_redo(&display, &project);
    let out = project.join("out");
    display.until(
        "the export",
        |display| display.act("key ctrl+e sleep 1 key Return"),
        |_| out.join("report.json").is_file(),
    );
    display.picture("exported");
    studio.close();
    let trace = text(&own.join("trace.json"));
    for span in ["interface", "picture", "simulation", "scene", "task"] {
        assert!(trace.contains(&format!("\"{span}\"")), "no {span} in a trace of {} bytes", trace.len());
    }
    assert!(trace.trim_end().ends_with(']'), "the trace is whole");
    assert_same_files(&project, &out, folder.path());
    let again = Studio::open(&display, Some(&project), &own);
    std::thread::sleep(Duration::from_secs(3));
    display.picture("again");
    assert!(!display.title().contains('•'), "nothing was changed by opening: {}", display.title());
    again.close();
    let left: Vec<PathBuf> =
        fs::read_dir(&project).expect("a folder").flatten().map(|entry| entry.path()).collect();
    assert!(!left.iter().any(|path| path.ends_with("autosave.toml")), "{left:?}");
}

/// Takes a template, makes it smaller, gives it another seed, and saves it as a project.
fn begin(display: &Display, own: &Path, project: &Path) {
    std::thread::sleep(Duration::from_secs(3));
    display.picture("start");
    let smaller = |display: &Display| {
        display.act(&format!("{TEMPLATE} sleep 1"));
        display.type_into(SIZE, "64");
    };
    display.until("the template, smaller", smaller, |_| unsaved(own).contains("size = 64"));
    let reseed = |display: &Display| display.type_into(SEED, "7");
    display.until("another seed", reseed, |_| unsaved(own).contains("seed = 7"));
    let save = |display: &Display| {
        display.act("key ctrl+s sleep 1 key ctrl+a");
        display.type_into("sleep 0.1", &project.display().to_string());
    };
    display.until("the project", save, |_| project.join("landscape.toml").is_file());
    display.until("the mark of what is not saved", |_| {}, |display| !display.title().contains('•'));
    display.picture("smaller");
}

/// Carves, goes round the landscape, and paints soil and water.
fn paint(display: &Display, project: &Path) {
    let carve = |display: &Display| display.act("mousemove 620 400 key space sleep 2 key space sleep 1");
    display.until("the simulation", carve, |display| display.title().contains('•'));
    display.picture("carved");
    // Round the landscape, and back to all of it.
    display.act("mousemove 560 420 mousedown 1 mousemove 660 430 mousemove 700 440 mouseup 1 key f");
    for (key, brush) in [("b", "add"), ("v", "add-water")] {
        let stroke = |display: &Display| {
            let begin =
                format!("mousemove 620 390 key {key} sleep 0.5 mousedown 1 sleep 0.3 mousemove 660 395");
            display.act(&format!("{begin} sleep 0.5 mousemove 720 400 sleep 0.5 mouseup 1 key Escape"));
            display.act("sleep 0.3 key ctrl+s");
        };
        display.until(brush, stroke, |_| strokes(project, brush) > 0);
    }
    display.picture("painted");
}

/// Takes all back that was done to the simulation, and does it again.
fn undo_and_redo(display: &Display, project: &Path) {
    let script = || text(&project.join("landscape.edits.jsonl"));
    let done = script();
    assert!(done.lines().count() >= 2, "{done}");
    // One for the steps, and one a stroke.
    let count = 1 + strokes(project, "add") + strokes(project, "add-water");
    for _ in 0..count {
        display.act("key ctrl+z sleep 0.4");
    }
    save(display, "all undone", || strokes(project, "add") + strokes(project, "add-water") == 0);
    display.picture("undone");
    for _ in 0..count {
        display.act("key ctrl+shift+z sleep 0.4");
    }
    save(display, "all again", || script() == done);
}

fn assert_same_files(project: &Path, out: &Path, folder: &Path) {
    let mut run = Command::new(env!("CARGO_BIN_EXE_weald"));
    run.arg("run").arg(project.join("landscape.toml")).arg("--out").arg(folder.join("run")).arg("--no-cache");
    let done = run.args(["--engine", "cpu"]).output().expect("weald runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    for name in ["height.tif", "height.png", "relief.png"] {
        let [here, there] =
            [out, &folder.join("run")].map(|folder| fs::read(folder.join(name)).expect("a file"));
        assert!(here == there, "{name} of the window is not that of a run");
    }
}
