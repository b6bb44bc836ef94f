//! A studio that is killed at any moment loses what was done in the last second, and nothing else.
//!
//! `WEALD_KILLS=200 cargo test -p weald-studio --test studio kills` kills so many.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::harness::Window;
use super::panels::recipe;

/// Says where the killed studio works, and that it is one.
const FOLDER: &str = "WEALD_KILLED_STUDIO";

/// What may be lost.
const MOST_LOST: Duration = Duration::from_secs(1);

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
        writeln!(out, "done {} {}", status.steps, status.moments.len())
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

/// Steps and moments that it told by a second before it was killed, and at the last.
fn kill_after(mut child: Child, lines: usize, more: Duration) -> [[u64; 2]; 2] {
    let lines_of = BufReader::new(child.stdout.take().expect("piped")).lines();
    let (sender, told) = std::sync::mpsc::channel();
    let reader = std::thread::spawn(move || {
        for line in lines_of.map_while(Result::ok) {
            let Some(numbers) = line.split("done ").nth(1) else { continue };
            let numbers: Vec<u64> = numbers.split(' ').filter_map(|word| word.parse().ok()).collect();
            let _ = sender.send((Instant::now(), [numbers[0], numbers[1]]));
        }
    });
    let mut all: Vec<(Instant, [u64; 2])> = (0..lines).map(|_| told.recv().expect("it works")).collect();
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
            .map_or([0; 2], |(_, told)| *told)
    };
    [by_then(MOST_LOST), by_then(Duration::ZERO)]
}

#[test]
fn a_killed_studio_loses_the_last_second_at_most() {
    let kills: u32 = std::env::var("WEALD_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(2);
    for kill in 0..kills {
        let (folder, _) = recipe();
        let more = Duration::from_millis(u64::from(kill.wrapping_mul(389) % 1500));
        let [sure, last] = kill_after(start(folder.path()), 2 + kill as usize % 5, more);
        let mut window = Window::on_machine(None, &folder.path().join("own"));
        let status = window.settle();
        // One more may have been done and not told.
        let (steps, moments) = (status.steps, status.moments.len() as u64);
        assert!((sure[0]..=last[0] + 1).contains(&steps), "{kill}: {steps} steps of {sure:?} to {last:?}");
        assert!(
            (sure[1]..=last[1] + 2).contains(&moments),
            "{kill}: {moments} moments of {sure:?} to {last:?}"
        );
        drop(window);
        let left = std::fs::read_dir(folder.path().join("own").join("unsaved")).expect("a folder").count();
        assert!(left <= 1, "{left} folders are left");
    }
}
