//! How long steps and outputs took on this machine, and how many bytes files had: what estimates are read off.
//!
//! Each run leaves its times in a file beside the kept results of steps. An estimate takes those of the same recipe, where
//! there are such, else those of all: the ones whose work is most like the wanted one, and a second group to tell how time
//! grows with work.

use std::path::Path;

use serde::{Deserialize, Serialize};

use weald_core::error::Error;
use weald_core::files;
use weald_io::write_whole;

/// Name of the file in the folder of kept results.
pub(super) const TIMINGS_FILE: &str = "timings.json";

/// Most times that are kept: the oldest go first.
const MAX_TIMINGS: usize = 4000;

/// Greatest exponent with which time grows with work: more is what noise makes of two times that are close.
const STEEPEST: f64 = 1.5;

/// A step or an output, as far as its time depends on it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Task {
    /// What is done: the step with its method, the kind of picture, the format of a layer.
    pub(super) what: String,
    /// The recipe of which it is a part, and which part: its times say more than those of others.
    pub(super) part: (String, String),
    /// Where simulations run; empty where any is meant.
    pub(super) engine: String,
    pub(super) threads: usize,
}

/// What one took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Timing {
    #[serde(flatten)]
    pub(super) task: Task,
    /// Cells times passes, or pixels.
    pub(super) amount: f64,
    pub(super) seconds: f64,
    /// Length of its files.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(super) bytes: Option<u64>,
}

/// Times that runs took on this machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timings {
    /// The version that took them: another one may be faster.
    version: String,
    all: Vec<Timing>,
}

impl Timings {
    /// Those that are kept in a folder; none where there is no such file, or one that is damaged or of another version.
    pub fn read(folder: &Path) -> Self {
        let text = files::read(folder.join(TIMINGS_FILE)).unwrap_or_default();
        let read: Self = serde_json::from_slice(&text).unwrap_or_default();
        if read.version == env!("CARGO_PKG_VERSION") { read } else { Self::default() }
    }

    /// Adds these in place of those of the same parts with the same work, and keeps all in the folder.
    ///
    /// # Errors
    /// [`Error::Run`] where they cannot be written.
    pub(super) fn keep(folder: &Path, new: Vec<Timing>) -> Result<(), Error> {
        if new.is_empty() {
            return Ok(());
        }
        let mut all = Self::read(folder).all;
        let is_same = |old: &Timing, new: &Timing| old.task == new.task && old.amount == new.amount;
        all.retain(|old| !new.iter().any(|new| is_same(old, new)));
        all.extend(new);
        let all = all.split_off(all.len().saturating_sub(MAX_TIMINGS));
        let text = serde_json::to_vec(&Self { version: env!("CARGO_PKG_VERSION").to_owned(), all });
        files::create_dir_all(folder)
            .map_err(|cause| Error::Run(format!("{}: {cause}", folder.display())))?;
        write_whole(&folder.join(TIMINGS_FILE), &text.expect("numbers, texts and lists are JSON"))
    }

    /// Seconds that so much work would take.
    pub(super) fn seconds(&self, task: &Task, amount: f64) -> Option<f64> {
        let alike = |timing: &&Timing| {
            let Task { what, engine, threads, .. } = &timing.task;
            let is_engine = task.engine.is_empty() || *engine == task.engine;
            is_engine && (what, threads) == (&task.what, &task.threads)
        };
        let found: Vec<_> = self.all.iter().filter(alike).collect();
        let own: Vec<_> = found.iter().copied().filter(|timing| timing.task.part == task.part).collect();
        let point = |timing: &&Timing| (timing.amount, timing.seconds);
        let points = if own.is_empty() { found } else { own };
        extrapolated(points.iter().map(point).collect(), amount)
    }

    /// Bytes of the files of a part of a recipe, which do not depend on engine and threads.
    pub(super) fn bytes(&self, task: &Task, amount: f64) -> Option<u64> {
        let own =
            self.all.iter().filter(|timing| timing.task.part == task.part && timing.task.what == task.what);
        let points = own.filter_map(|timing| Some((timing.amount, timing.bytes? as f64)));
        extrapolated(points.collect(), amount).map(|bytes| bytes as u64)
    }
}

/// Points of like amounts, as one: their middle one by rate.
fn middle(points: &[(f64, f64)]) -> (f64, f64) {
    let mut sorted = points.to_vec();
    sorted.sort_by(|one, other| (one.1 / one.0).total_cmp(&(other.1 / other.0)));
    sorted[sorted.len() / 2]
}

/// The value at an amount, by the two groups of points whose amounts are the nearest: on the line through them, or, where
/// that would be below nothing at the start, on the power.
fn extrapolated(points: Vec<(f64, f64)>, amount: f64) -> Option<f64> {
    let amount = amount.max(1.0);
    let octave = |of: f64| of.max(1.0).log2();
    let mut points: Vec<_> = points.into_iter().map(|(of, value)| (of.max(1.0), value.max(1e-9))).collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    let groups: Vec<_> =
        points.chunk_by(|one, next| octave(next.0) - octave(one.0) < 0.5).map(middle).collect();
    let mut nearest = groups;
    nearest.sort_by(|one, other| {
        let far = |(of, _): &(f64, f64)| (octave(*of) - octave(amount)).abs();
        far(one).total_cmp(&far(other))
    });
    let (&(of, value), second) = (nearest.first()?, nearest.get(1));
    let Some(&(other, its)) = second else { return Some(value * amount / of) };
    let slope = ((value - its) / (of - other)).max(0.0);
    let start = value - slope * of;
    if start >= 0.0 {
        return Some(start + slope * amount);
    }
    let exponent = ((value / its).log2() / (of / other).log2()).clamp(0.0, STEEPEST);
    Some(value * (amount / of).powf(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn task(recipe: &str, threads: usize) -> Task {
        Task {
            what: "flow".to_owned(),
            part: (recipe.to_owned(), "step 1".to_owned()),
            engine: "cpu".to_owned(),
            threads,
        }
    }

    fn took(recipe: &str, amount: f64, seconds: f64) -> Timing {
        Timing { task: task(recipe, 2), amount, seconds, bytes: Some((10.0 * seconds) as u64) }
    }

    fn near(found: Option<f64>, expected: f64) -> bool {
        found.is_some_and(|found| (found / expected - 1.0).abs() < 1e-9)
    }

    #[test]
    fn times_grow_as_two_sizes_tell_and_with_the_work_where_there_is_one() {
        let line = |amount: f64| 3.0 + 0.001 * amount;
        let two = vec![(1000.0, line(1000.0)), (4000.0, line(4000.0))];
        assert!(near(extrapolated(two, 16_000.0), line(16_000.0)), "what is set up once does not grow");
        assert!(near(extrapolated(vec![(1000.0, 2.0)], 4000.0), 8.0));
        let steep = vec![(1000.0, 1.0), (4000.0, 5.657)];
        let found = extrapolated(steep, 16_000.0).expect("there are two");
        assert!((found / 32.0 - 1.0).abs() < 1e-3, "faster than in proportion: {found}");
        assert_eq!(extrapolated(Vec::new(), 10.0), None);
    }

    #[test]
    fn a_recipe_is_estimated_by_its_own_times_and_by_all_others_without() {
        let all = vec![took("a", 1000.0, 1.0), took("b", 1000.0, 4.0), took("c", 1000.0, 5.0)];
        let timings = Timings { version: String::new(), all };
        assert!(near(timings.seconds(&task("a", 2), 2000.0), 2.0));
        assert!(near(timings.seconds(&task("new", 2), 2000.0), 8.0), "the middle one");
        assert_eq!(timings.seconds(&task("a", 3), 2000.0), None, "other threads take other times");
        assert_eq!(timings.bytes(&task("a", 3), 2000.0), Some(20));
        assert_eq!(timings.bytes(&task("new", 2), 2000.0), None, "files of another recipe say little");
    }

    #[test]
    fn times_are_kept_once_a_part_and_size_and_damaged_ones_are_none() {
        let folder = tempfile::tempdir().expect("a folder");
        for seconds in [1.0, 2.0] {
            let new = vec![took("a", 1000.0, seconds), took("a", 4000.0, 4.0 * seconds)];
            Timings::keep(folder.path(), new).expect("written");
        }
        let kept = Timings::read(folder.path());
        assert_eq!(kept.all.len(), 2);
        assert!(near(kept.seconds(&task("a", 2), 1000.0), 2.0), "the later one");
        let many = (0..MAX_TIMINGS).map(|number| took("b", number as f64, 1.0)).collect();
        Timings::keep(folder.path(), many).expect("written");
        assert_eq!(Timings::read(folder.path()).all.len(), MAX_TIMINGS);
        std::fs::write(folder.path().join(TIMINGS_FILE), "[").expect("written");
        assert_eq!(Timings::read(folder.path()), Timings::default());
    }
}
