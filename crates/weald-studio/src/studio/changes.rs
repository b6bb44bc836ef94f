//! What changes the recipe and the simulation, and how it is taken back: both in one order.

use super::Studio;
use crate::state::{Did, State};
use crate::work::{Opening, Task};

/// How long nothing is typed or dragged before a changed recipe runs.
const REST_SECONDS: f64 = 0.25;

impl Studio {
    /// Notes a change of the recipe, to be undone like any other.
    pub(crate) fn edited(&mut self, result: Result<(), String>) {
        match result {
            Ok(()) => {
                self.done.push(Did::Recipe);
                self.undone.clear();
                self.undone_before.clear();
            }
            Err(message) => self.say(message),
        }
    }

    /// Gives what a step makes another name, in all that speaks of it.
    pub(crate) fn rename_result(&mut self, at: usize, name: &str) {
        let before = self.document.result_of(at);
        if before.as_deref() == Some(name) {
            self.renaming = None;
            return;
        }
        let renamed = self.document.rename_result(at, name);
        if renamed.is_ok() {
            self.renaming = None;
            if self.looks.layer == before {
                self.looks.layer = Some(name.to_owned());
            }
        }
        self.edited(renamed);
    }

    /// Asks for something to be done to the simulation, to be undone like any other.
    pub(crate) fn act(&mut self, task: Task) {
        let goes_on = matches!(&task, Task::Stroke { stroke, .. } if *stroke != self.strokes);
        if !goes_on {
            self.done.push(Did::Simulation);
            self.undone_before = std::mem::take(&mut self.undone);
        }
        self.work.ask(task);
    }

    /// What could not be done has no place in what is undone, and takes nothing away that could be redone.
    pub(crate) fn take_refused(&mut self) {
        for _ in std::mem::replace(&mut self.noted_refused, self.status.refused)..self.status.refused {
            if let Some(place) = self.done.iter().rposition(|did| *did == Did::Simulation) {
                self.done.remove(place);
            }
            if self.undone.is_empty() {
                self.undone = std::mem::take(&mut self.undone_before);
            }
        }
    }

    /// Whether something of this project has run, or is about to.
    pub(crate) fn has_run(&self) -> bool {
        self.keeps_edits || self.document.diagnostics().is_empty()
    }

    pub(super) fn undo(&mut self) {
        let Some(last) = self.done.pop() else { return self.say("nothing to undo") };
        match last {
            Did::Recipe => drop(self.document.undo()),
            Did::Simulation => self.work.ask(Task::Undo),
        }
        self.undone.push(last);
    }

    pub(super) fn redo(&mut self) {
        let Some(next) = self.undone.pop() else { return self.say("nothing to redo") };
        match next {
            Did::Recipe => drop(self.document.redo()),
            Did::Simulation => self.work.ask(Task::Redo),
        }
        self.done.push(next);
    }

    /// Lets a changed recipe run once nothing changes any more for a moment; what cannot run is not run.
    pub(crate) fn run_changes(&mut self, now: f64, hand_is_down: bool) {
        let revision = self.document.revision();
        if revision == self.opened || !self.document.diagnostics().is_empty() {
            return;
        }
        if self.opened != 0 && (hand_is_down || now - self.changed_at < REST_SECONDS) {
            return;
        }
        self.opened = revision;
        let opening = Opening {
            file: self.document.file().to_owned(),
            text: self.document.text().to_owned(),
            revision,
            engine: self.engine.clone(),
            steps: self.selected.map(|last| self.document.running_until(last)),
            keeps_edits: self.keeps_edits,
        };
        self.keeps_edits = true;
        self.work.ask(Task::Open(Box::new(opening)));
        if std::mem::take(&mut self.on_page.plays_first) {
            self.work.ask(Task::Play(true));
        }
    }

    /// Runs the recipe anew, as far as the step that is chosen to be shown.
    pub(crate) fn run_again(&mut self) {
        self.opened = u64::MAX;
        self.changed_at = 0.0;
    }

    /// Whether there is something that is not saved.
    pub(crate) fn is_unsaved(&self) -> bool {
        self.project.is_unsaved(self.state())
    }

    /// Which text, and how much done by hand, there is now.
    pub(crate) fn state(&self) -> State {
        State { revision: self.document.revision(), changes: self.status.changes }
    }
}
