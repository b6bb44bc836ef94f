//! Undo and redo over strokes, settings and iterations, and branches, within a budget of memory.
//!
//! A simulation is deterministic, so any of its states follows from an earlier one and the actions since. The history
//! is a tree of moments: whoever goes back and does something else begins a branch, and what was there stays. It keeps
//! what takes a stroke back, which is a rectangle, and copies of some states: to go somewhere is to take strokes back,
//! or to return to the nearest copy before, and to do again what lies between. When the budget is full, the copy goes
//! whose loss costs the least work for the states near the present: so they lie close together there and far apart in
//! the past. The first one always stays.

mod tree;

use std::collections::BTreeMap;

use super::change::{Action, Edit};
use super::script::Script;
use tree::Tree;
use weald_core::error::{Error, Limit, Quantity};

/// A simulation that a person changes while it runs. The same actions on the same state must give the same bits.
pub trait Undoable {
    /// What takes a change back, where that is less than a copy of everything.
    type Patch;

    /// Does one thing; gives what takes it back, where there is such.
    ///
    /// # Errors
    /// [`Error::Run`] where it cannot be done. After a change that fails the state is as it was; after steps that fail
    /// it is of no further use until it returns to a copy.
    fn apply(&mut self, action: &Action) -> Result<Option<Self::Patch>, Error>;

    /// Takes the last change back.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails that holds the state.
    fn take_back(&mut self, patch: &Self::Patch) -> Result<(), Error>;

    /// Keeps a copy of everything under a number.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails that holds the state, or its memory is full.
    fn keep_as(&mut self, number: u64) -> Result<(), Error>;

    /// Goes back to a copy.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails that holds the state.
    fn return_to(&mut self, number: u64) -> Result<(), Error>;

    /// Forgets a copy.
    fn release(&mut self, number: u64);

    /// Memory that a copy takes.
    fn bytes_of_copy(&self) -> u64;

    /// Memory that it takes to take a change back.
    fn bytes_of(patch: &Self::Patch) -> u64;
}

/// Iterations after which a copy is worth its memory.
const WORTH_A_COPY: u64 = 16;

/// A simulation that can go back and forth.
#[derive(Debug)]
pub struct History<S: Undoable> {
    simulation: S,
    tree: Tree<S::Patch>,
    names: BTreeMap<String, usize>,
    used: u64,
    budget: u64,
}

impl<S: Undoable> History<S> {
    /// A history that begins here and keeps at most `budget` bytes to go back with.
    ///
    /// # Errors
    /// [`Error::Limit`] where not even the start fits; those of the simulation.
    pub fn new(mut simulation: S, budget: u64) -> Result<Self, Error> {
        let used = simulation.bytes_of_copy();
        if used > budget {
            let limit = Limit::new(Quantity::MemoryBytes, used, 0..=budget);
            let limit = limit.of("the start, which is kept to undo");
            return Err(limit.remedy("give a larger budget").into());
        }
        simulation.keep_as(0)?;
        Ok(Self { simulation, tree: Tree::new(used), names: BTreeMap::new(), used, budget })
    }

    /// The simulation as it is now.
    pub fn simulation(&self) -> &S {
        &self.simulation
    }

    /// The simulation as it is now, to read from a device; what it is given to do escapes the history.
    pub fn simulation_mut(&mut self) -> &mut S {
        &mut self.simulation
    }

    /// Number of this moment; that of the start is 0, and each action adds one.
    pub fn here(&self) -> usize {
        self.tree.here
    }

    /// Moments in all branches.
    pub fn moments(&self) -> usize {
        self.tree.moments.len()
    }

    /// The action that led to a moment, and the moment before it; `None` for the start and where there is no such.
    pub fn led_to(&self, moment: usize) -> Option<(usize, &Action)> {
        let found = self.tree.moments.get(moment)?;
        Some((found.before, found.action.as_ref()?))
    }

    /// What was done from the start to here, in order.
    pub fn actions(&self) -> Vec<&Action> {
        self.tree
            .path(self.tree.here)
            .into_iter()
            .filter_map(|at| self.tree.moments[at].action.as_ref())
            .collect()
    }

    /// What was done from the start to here as steps and a script, by which a run comes to the same state.
    pub fn script(&self) -> (u64, Script) {
        let (mut step, mut edits) = (0, Vec::new());
        for action in self.actions() {
            match action {
                Action::Steps(steps) => step += steps,
                Action::Change(change) => edits.push(Edit { step, change: change.clone() }),
            }
        }
        (step, Script::new(edits))
    }

    /// Moments from which nothing was done: where branches end.
    pub fn ends(&self) -> Vec<usize> {
        (0..self.moments()).filter(|&at| self.tree.moments[at].next.is_none()).collect()
    }

    /// Gives this moment a name, in place of what had it.
    pub fn name(&mut self, name: &str) {
        self.names.insert(name.to_owned(), self.tree.here);
    }

    /// Gives the moment of a name another one; where that was another moment's, it no longer is. `false` where nothing has the
    /// first name.
    pub fn rename(&mut self, from: &str, to: &str) -> bool {
        let Some(moment) = self.names.remove(from) else { return false };
        self.names.insert(to.to_owned(), moment);
        true
    }

    /// The moments that have names.
    pub fn names(&self) -> &BTreeMap<String, usize> {
        &self.names
    }

    /// Bytes that all takes that is kept to go back with.
    pub fn used(&self) -> u64 {
        self.used
    }

    /// Does something new, from here on: after going back it begins a branch. Gives the moment that it leads to.
    ///
    /// # Errors
    /// Those of the simulation, which is then as it was before.
    pub fn act(&mut self, action: impl Into<Action>) -> Result<usize, Error> {
        let action = action.into();
        match self.simulation.apply(&action) {
            Ok(patch) => {
                let moment = self.tree.grow(action.work(), action);
                self.remember(moment, patch);
                self.keep();
                Ok(moment)
            }
            Err(error) => {
                if matches!(action, Action::Steps(_)) {
                    self.arrive_by_a_copy(self.tree.here)?;
                }
                Err(error)
            }
        }
    }

    /// Takes the last action back; `false` where there is none.
    ///
    /// # Errors
    /// Those of the simulation while it does again what came before.
    pub fn undo(&mut self) -> Result<bool, Error> {
        let here = self.tree.here;
        if here == 0 {
            return Ok(false);
        }
        self.go_to(self.tree.moments[here].before)?;
        Ok(true)
    }

    /// Does the undone action again that was there last; `false` where there is none.
    ///
    /// # Errors
    /// Those of the simulation.
    pub fn redo(&mut self) -> Result<bool, Error> {
        let Some(next) = self.tree.moments[self.tree.here].next else { return Ok(false) };
        self.go_to(next)?;
        Ok(true)
    }

    /// Goes to a moment of any branch.
    ///
    /// # Errors
    /// [`Error::Run`] where there is no such moment; those of the simulation.
    pub fn go_to(&mut self, moment: usize) -> Result<(), Error> {
        if moment >= self.moments() {
            let last = self.moments() - 1;
            return Err(Error::Run(format!("there is no moment {moment}; there are 0 to {last}")));
        }
        let fork = self.tree.fork(moment);
        let kept = self.tree.nearest_copy(moment);
        let again = |from: usize| self.tree.moments[moment].work - self.tree.moments[from].work;
        if self.tree.can_be_taken_back_to(fork) && again(fork) <= again(kept).saturating_add(1) {
            while self.tree.here != fork {
                self.step_back()?;
            }
            return self.replay(moment);
        }
        self.arrive_by_a_copy(moment)
    }

    /// Takes back the change that led here.
    fn step_back(&mut self) -> Result<(), Error> {
        let moment = &self.tree.moments[self.tree.here];
        if let Some(patch) = &moment.patch {
            self.simulation.take_back(patch)?;
        }
        self.tree.here = moment.before;
        Ok(())
    }

    /// Returns to the nearest copy and goes on from there.
    fn arrive_by_a_copy(&mut self, moment: usize) -> Result<(), Error> {
        let from = self.tree.nearest_copy(moment);
        self.simulation.return_to(from as u64)?;
        self.tree.here = from;
        self.replay(moment)
    }

    fn replay(&mut self, moment: usize) -> Result<(), Error> {
        for next in self.tree.path(moment) {
            if !self.tree.comes_after_here(next) {
                continue;
            }
            let Some(action) = &self.tree.moments[next].action else { continue };
            let patch = self.simulation.apply(action)?;
            self.tree.here = next;
            if self.tree.moments[next].patch.is_none() {
                self.remember(next, patch);
            }
            self.keep();
        }
        self.tree.remember_way(moment);
        Ok(())
    }

    /// Keeps what takes an action back, where there is room for it.
    fn remember(&mut self, moment: usize, patch: Option<S::Patch>) {
        let Some(patch) = patch else { return };
        let bytes = S::bytes_of(&patch);
        if self.make_room(bytes) {
            self.used += bytes;
            self.tree.moments[moment].patch = Some(patch);
        }
    }

    /// Keeps the state here, if that is worth it and there is room for it once others have gone. Where a device has no
    /// memory for it, more has to be done again some day, and nothing else is lost.
    fn keep(&mut self) {
        let here = self.tree.here;
        let since = self.tree.moments[here].work - self.tree.moments[self.tree.nearest_copy(here)].work;
        if since < WORTH_A_COPY {
            return;
        }
        let bytes = self.simulation.bytes_of_copy();
        if self.make_room(bytes) && self.simulation.keep_as(here as u64).is_ok() {
            self.used += bytes;
            self.tree.moments[here].copy = Some(bytes);
        }
    }

    /// Drops copies, and then what takes the oldest changes back, until so many bytes are free; `false` where they
    /// cannot be.
    fn make_room(&mut self, bytes: u64) -> bool {
        while self.used.saturating_add(bytes) > self.budget {
            if let Some(moment) = self.tree.cheapest_copy() {
                self.simulation.release(moment as u64);
                self.used -= self.tree.moments[moment].copy.take().unwrap_or_default();
            } else if let Some(patch) = self.tree.moments.iter_mut().find_map(|moment| moment.patch.take()) {
                self.used -= S::bytes_of(&patch);
            } else {
                return false;
            }
        }
        true
    }
}
