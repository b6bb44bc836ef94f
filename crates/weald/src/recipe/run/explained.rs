//! What a run says of the step in which it ended, and how it goes on.

use super::options::Run;
use super::step_watcher::StepWatcher;
use crate::recipe::plan::Planned;
use weald_core::error::{Error, NotFinite};

impl Run<'_> {
    /// Says in which step an error arose and where the last state is.
    pub(super) fn explain(
        &self,
        error: Error,
        planned: &Planned,
        desk: &StepWatcher<'_>,
        resumed_at: Option<u64>,
    ) -> Error {
        let step = format!("step {} (`{}`)", desk.number(), planned.entry.name);
        let kept = desk.kept().or(resumed_at);
        match error {
            Error::Interrupted(_) => match (kept, desk.keep_start_unless(kept.is_some())) {
                (_, Err(error)) => error,
                (Some(iteration), Ok(())) => {
                    self.interrupted(&format!("in {step} after {iteration} iterations"))
                }
                (None, Ok(())) => self.interrupted(&format!("in {step}, which will start again")),
            },
            other => self.in_step(other, (&step, planned.entry.name), kept),
        }
    }

    /// An error with the step before it, which also has a `name`, and the last good state behind it, where one was kept.
    pub(super) fn in_step(&self, error: Error, (step, name): (&str, &str), kept: Option<u64>) -> Error {
        match error {
            Error::Run(what) => Error::Run(self.located(step, &what, kept)),
            Error::NotFinite(fault) => {
                let message = self.located(step, &fault.message, kept);
                NotFinite { step: Some(name.to_owned()), message, ..fault }.into()
            }
            other => other,
        }
    }

    /// A fault with the step before it and, where one was kept, the last good state behind it.
    fn located(&self, step: &str, what: &str, kept: Option<u64>) -> String {
        let state = kept.map_or_else(String::new, |iteration| {
            let checkpoint = self.checkpoint();
            format!("; the last good state, after {iteration} iterations, is in {}", checkpoint.display())
        });
        format!("{step}: {what}{state}")
    }

    /// The user has ended the run at that place, of which a checkpoint was kept.
    pub(super) fn interrupted(&self, place: &str) -> Error {
        let checkpoint = self.checkpoint();
        Error::Interrupted(format!(
            "interrupted {place}; the same command with --resume goes on from {}",
            checkpoint.display()
        ))
    }
}
