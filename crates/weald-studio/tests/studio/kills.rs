//! A studio that is killed at any moment loses what was done in the last second, and nothing else.
//!
//! `WEALD_KILLS=200 cargo test -p weald-studio --test studio kills` kills so many; `WEALD_KILLS=100..200` only those after the
//! first hundred, each at another moment.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::harness::Window;
use super::panels::recipe;

/// Says where the killed studio works, and that it is one.
const FOLDER: &str = "WEALD_KILLED_STUDIO";

/// What may be lost.
const MOST_LOST: Duration = Duration::from_secs(1);

/// What a studio has told before it was killed.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    /// Steps and moments that there were.
    steps: u64,
    moments: u64,
    /// Strokes that were asked for, each with a step after it; on a busy machine they are done some time later.
    asked: u64,
}

/// A studio that works until it is killed: it paints and simulates, and says after each what there is.
#[test]
fn is_killed_by_another_test() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let folder = std::path::PathBuf::from(folder);
    let mut window = Window::on_machine(Some(&folder.join("valley.toml")), &folder.join("own"));
    window.settle();
    window.drawn();
    window.click("Add");
    for stroke in 0_u16.. {
        let at = 0.3 + 0.05 * f32::from(stroke % 8);
        window.stroke([at, 0.5], [at + 0.05, 0.55]);
        window.click("One step");
        let status = window.status();
        let mut out = std::io::stdout().lock();
        writeln!(out, "done {} {} {}", status.steps, status.moments.len(), stroke + 1)
            .and_then(|()| out.flush())
            .expect("heard");
    }
}

fn start(folder: &std::path::Path) -> Child {
    let own = std::env::current_exe().expect("this test");
    let mut command = Command::new(own);
    command.args(["kills::is_killed_by_another_test", "--exact", "--nocapture"]).env(FOLDER, folder);
    command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a studio")
}

/// What it told by a second before it was killed, and at the last.
fn kill_after(mut child: Child, lines: usize, more: Duration) -> [Told; 2] {
    let lines_of = BufReader::new(child.stdout.take().expect("piped")).lines();
    let (sender, told) = std::sync::mpsc::channel();
    let reader = std::thread::spawn(move || {
        for line in lines_of.map_while(Result::ok) {
            let Some(numbers) = line.split("done ").nth(1) else { continue };
            let numbers: Vec<u64> = numbers.split(' ').filter_map(|word| word.parse().ok()).collect();
            let [steps, moments, asked] = numbers[..] else { continue };
            let _ = sender.send((Instant::now(), Told { steps, moments, asked }));
        }
    });
    let mut all: Vec<(Instant, Told)> = (0..lines).map(|_| told.recv().expect("it works")).collect();
    std::thread::sleep(more);
    child.kill().expect("killed");
    let killed = Instant::now();
    child.wait().expect("gone");
    reader.join().expect("read");
    all.extend(told.try_iter());
    let by_then = |age: Duration| {
        all.iter()
            .rev()
            .find(|(when, _)| killed.saturating_duration_since(*when) >= age)
            .map_or_else(Told::default, |(_, told)| *told)
    };
    [by_then(MOST_LOST), by_then(Duration::ZERO)]
}

/// Which kills are asked for: a number of them, or those between two numbers.
fn wanted() -> std::ops::Range<u32> {
    let text = std::env::var("WEALD_KILLS").unwrap_or_else(|_| "2".to_owned());
    let number = |text: &str| text.trim().parse().unwrap_or_else(|_| panic!("WEALD_KILLS={text}: no number"));
    text.split_once("..").map_or_else(|| 0..number(&text), |(from, to)| number(from)..number(to))
}

#[test]
fn a_killed_studio_loses_the_last_second_at_most() {
    for kill in wanted() {
        let (folder, _) = recipe();
        let more = Duration::from_millis(u64::from(kill.wrapping_mul(389) % 1500));
        let [sure, last] = kill_after(start(folder.path()), 2 + kill as usize % 5, more);
        let mut window = Window::on_machine(None, &folder.path().join("own"));
        let status = window.settle();
        let (steps, moments) = (status.steps, status.moments.len() as u64);
        let all = format!("kill {kill}: {steps} steps, {moments} moments; told before: {sure:?} to {last:?}");
        // What was done in the last second may be lost; one more may have been asked for and not told.
        assert!((sure.steps..=last.asked + 1).contains(&steps) && moments >= sure.moments, "{all}");
        // A stroke, a step, a stroke, a step: script and recipe are of one moment.
        assert!(moments == 2 * steps || moments == 2 * steps + 1, "{all}");
        drop(window);
        // Who is killed before anything was kept has no folder.
        let left = std::fs::read_dir(folder.path().join("own").join("unsaved")).map_or(0, Iterator::count);
        assert!(left <= 1, "{left} folders are left");
    }
}
