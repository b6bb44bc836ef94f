//! Progress on stderr: a bar on a terminal, a line every few seconds elsewhere.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use weald::recipe::Progress;

use crate::interrupt;

/// Time between two lines.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// Shows progress unless it is to be quiet.
pub(crate) struct ProgressPrinter {
    quiet: bool,
    bar: Option<ProgressBar>,
    now: Mutex<CurrentStep>,
}

/// Where the running step is.
struct CurrentStep {
    title: String,
    /// When the step first said where it is, and where it was.
    first: Option<(Instant, u64)>,
    line_at: Instant,
}

impl ProgressPrinter {
    pub(crate) fn new(quiet: bool) -> Self {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(bar);
        Self {
            quiet,
            bar,
            now: Mutex::new(CurrentStep { title: String::new(), first: None, line_at: Instant::now() }),
        }
    }

    /// Takes the bar away.
    pub(crate) fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Another step or file begins.
    fn begin(&self, title: String) {
        match &self.bar {
            Some(bar) => {
                bar.reset();
                bar.set_prefix(title.clone());
                bar.set_message("");
            }
            None => self.say(&title),
        }
        *self.now() = CurrentStep { title, first: None, line_at: Instant::now() };
    }

    fn say(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| eprintln!("{line}")),
            None if !self.quiet => eprintln!("{line}"),
            None => {}
        }
    }

    /// A panic elsewhere leaves the state whole, since it is only ever replaced.
    fn now(&self) -> MutexGuard<'_, CurrentStep> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix} [{bar:30}] {pos}/{len} {msg}")
        .expect("the template is correct")
        .progress_chars("=> ");
    ProgressBar::no_length().with_style(style)
}

impl Progress for ProgressPrinter {
    fn step(&self, number: usize, count: usize, name: &str) {
        self.begin(format!("step {number}/{count} {name}"));
    }

    fn progress(&self, done: u64, total: u64, cells: usize) {
        if self.quiet {
            return;
        }
        let mut now = self.now();
        let (since, start) = *now.first.get_or_insert((Instant::now(), done));
        let speed = speed(done - start, total - done, cells, since.elapsed());
        if let Some(bar) = &self.bar {
            bar.set_length(total);
            bar.set_position(done);
            bar.set_message(speed);
        } else if now.line_at.elapsed() >= LINE_EVERY {
            now.line_at = Instant::now();
            eprintln!("{} {done}/{total} {speed}", now.title);
        }
    }

    fn output(&self, number: usize, count: usize, file: &Path) {
        self.begin(format!("file {number}/{count} {}", file.display()));
    }

    fn note(&self, text: &str) {
        self.say(&format!("note: {text}"));
    }

    fn cancelled(&self) -> bool {
        interrupt::asked()
    }
}

/// Rate and remaining time in words; nothing before the first iteration is done.
fn speed(done: u64, left: u64, cells: usize, time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if done == 0 || seconds <= 0.0 {
        return String::new();
    }
    let rate = done as f64 / seconds;
    let remaining = (left as f64 / rate).ceil() as u64;
    let (minutes, seconds) = (remaining / 60, remaining % 60);
    let left = format!("{minutes}:{seconds:02} left");
    if cells == 0 {
        return left;
    }
    format!("{:.0} million cell-steps/s, {left}", rate * cells as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_is_in_million_cell_steps_and_the_rest_in_minutes() {
        let text = speed(100, 900, 1_000_000, Duration::from_secs(10));
        assert_eq!(text, "10 million cell-steps/s, 1:30 left");
        assert_eq!(speed(0, 900, 1, Duration::from_secs(10)), "");
        assert_eq!(speed(1, 3, 0, Duration::from_secs(10)), "0:30 left");
    }
}
