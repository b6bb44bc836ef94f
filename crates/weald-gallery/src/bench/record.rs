//! Results of a bench that are kept, and what became slower since.
//!
//! Machines differ and one machine differs from minute to minute, so that seconds alone say little. Each result has the pace
//! of the processor right beside it, with as many threads, and what is compared is time in units of that. The bandwidth
//! of memory was of no use for it: on a virtual machine it differs by half from one measurement to the next.

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::rate::{Rate, pace};
use weald_core::error::Error;
use weald_io::write_whole;

/// How much slower, in units of the pace, counts as slower: less is what other work on a machine makes of it.
const SLOWER: f64 = 1.25;

/// Seconds by which that has to be slower as well: what takes less than some milliseconds is not measured well.
const LEAST_SECONDS: f64 = 0.01;

/// A result of a bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What was measured, and on which grid.
    pub name: String,
    /// Threads.
    pub threads: usize,
    /// Time of the best run.
    pub seconds: f64,
    /// Cells, cell-steps or plants that this time was for; 0 where there are none to count.
    pub amount: f64,
    /// What an amount is of.
    pub of: String,
    /// Numbers a second of a fixed loop by as many threads, right before or after.
    pub pace: f64,
    /// Most bytes that the process had taken by the end, where the system tells it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub peak_memory: Option<u64>,
}

impl Record {
    /// The rate of a process or a generator, measured a moment ago on the threads of this pool; `None` on a device.
    pub fn of_rate(rate: &Rate) -> Option<Self> {
        let (columns, rows) = (rate.size.columns, rate.size.rows);
        let amount = rate.size.cells() as f64;
        Some(Self {
            name: format!("{} {columns} × {rows}", rate.name),
            threads: rate.threads?,
            seconds: amount / (rate.millions * 1e6),
            amount,
            of: "cells".to_owned(),
            pace: pace(),
            peak_memory: None,
        })
    }

    /// Numbers that the loop would have put through meanwhile.
    pub(super) fn effort(&self) -> f64 {
        self.seconds * self.pace
    }

    /// How many times as long this took as then, in units of the pace of each.
    fn ratio(&self, then: &Self) -> f64 {
        self.effort() / then.effort()
    }
}

impl Display for Record {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, threads, seconds, amount, of, .. } = self;
        write!(out, "{name:<44} {threads} thr  {seconds:>8.3} s")?;
        if *amount > 0.0 {
            write!(out, "  {:>8.2} million {of} a second", amount / seconds.max(1e-9) / 1e6)?;
        }
        let peak = self.peak_memory.map_or(String::new(), |bytes| format!("  {} MiB", bytes >> 20));
        write!(out, "{peak}")
    }
}

/// All results of a run of the bench.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Records {
    /// The version that was measured.
    pub version: String,
    /// Results in the order in which they were measured.
    pub results: Vec<Record>,
}

impl Records {
    /// Reads a file that [`Records::write`] wrote.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is missing or holds something else.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let unread = |cause: &dyn Display| Error::input(path, format!("is no file of results: {cause}"));
        let text = std::fs::read(path).map_err(|cause| unread(&cause))?;
        serde_json::from_slice(&text).map_err(|cause| unread(&cause))
    }

    /// Writes the results as JSON.
    ///
    /// # Errors
    /// [`Error::Run`] where the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut text = serde_json::to_string_pretty(self).expect("numbers, texts and lists are JSON");
        text.push('\n');
        write_whole(path, text.as_bytes())
    }

    /// A line for each result that became slower than it was.
    pub fn slower_than(&self, then: &Self) -> Vec<String> {
        let pairs = self.results.iter().filter_map(|now| Some((now, then.same_as(now)?)));
        let slower = pairs.filter(|(now, then)| {
            let late = now.seconds - then.effort() / now.pace;
            now.ratio(then) > SLOWER && late > LEAST_SECONDS
        });
        let line = |(now, then): (&Record, &Record)| {
            let (ratio, Record { name, threads, seconds, .. }) = (now.ratio(then), now);
            format!(
                "{name}, {threads} thr: {ratio:.2} times as long as then, beside the pace of the processor ({seconds:.3} s \
                 at {:.2} a nanosecond, then {:.3} s at {:.2})",
                now.pace / 1e9,
                then.seconds,
                then.pace / 1e9
            )
        };
        slower.map(line).collect()
    }

    /// How many of these results the other file has as well.
    pub fn in_common(&self, other: &Self) -> usize {
        self.results.iter().filter(|result| other.same_as(result).is_some()).count()
    }

    fn same_as(&self, other: &Record) -> Option<&Record> {
        self.results.iter().find(|result| result.name == other.name && result.threads == other.threads)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results(times: &[(&str, f64)], pace: f64) -> Records {
        let result = |&(name, seconds): &(&str, f64)| Record {
            name: name.to_owned(),
            threads: 2,
            seconds,
            amount: 1e6,
            of: "cells".to_owned(),
            pace,
            peak_memory: Some(5 << 20),
        };
        Records { version: "0".to_owned(), results: times.iter().map(result).collect() }
    }

    #[test]
    fn what_became_slower_on_purpose_is_named_and_a_slower_machine_is_not() {
        let then = results(&[("slope", 0.1), ("flow", 1.0), ("tiny", 0.001), ("gone", 1.0)], 40e9);
        let same = results(&[("slope", 0.2), ("flow", 2.0), ("tiny", 0.009), ("new", 9.0)], 20e9);
        assert_eq!(same.slower_than(&then), Vec::<String>::new());
        let slower = results(&[("slope", 0.3), ("flow", 2.2)], 20e9);
        let lines = slower.slower_than(&then);
        assert!(lines.len() == 1 && lines[0].starts_with("slope, 2 thr: 1.50 times as long"), "{lines:?}");
        assert_eq!((slower.in_common(&then), same.in_common(&then)), (2, 3));
    }

    #[test]
    fn results_come_back_from_their_file_and_other_files_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let (path, kept) = (folder.path().join("results.json"), results(&[("slope", 0.1)], 4e10));
        kept.write(&path).expect("written");
        assert_eq!(Records::read(&path).expect("read"), kept);
        std::fs::write(&path, "[]").expect("written");
        let error = Records::read(&path).expect_err("another file");
        assert!(error.exit_code() == 4 && error.to_string().contains("no file of results"), "{error}");
    }
}
