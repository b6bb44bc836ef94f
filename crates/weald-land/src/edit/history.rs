//! Undo and redo over strokes and iterations, within a budget of memory.
//!
//! A session is deterministic, so any of its states follows from an earlier one and the actions since. The
//! history keeps snapshots of some states and all actions: to go back is to restore the nearest snapshot
//! before, and to do again what lies between. When the budget is full, the snapshot goes whose loss costs the
//! least work for the states near the present: so they lie close together there and far apart in the past. The
//! first one always stays.

use std::collections::BTreeMap;
use std::ops::Bound::{Excluded, Unbounded};

use super::brush::Brush;
use weald_core::error::{Error, Limit, Quantity};

/// What can be done to a session.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Simulates so many steps.
    Steps(u64),
    /// Paints a stroke.
    Stroke(Brush),
}

impl Action {
    /// What it costs to do it again, in iterations.
    fn work(&self) -> u64 {
        match self {
            Self::Steps(steps) => (*steps).max(1),
            Self::Stroke(_) => 1,
        }
    }
}

/// A simulation that a person changes while it runs. The same actions on the same state must give the same
/// bits.
pub trait Session {
    /// All of the state.
    type Snapshot;

    /// A copy of the state.
    ///
    /// # Errors
    /// [`Error::Device`] where the state cannot be read from the device that holds it.
    fn snapshot(&mut self) -> Result<Self::Snapshot, Error>;

    /// Goes back to a state.
    ///
    /// # Errors
    /// As [`Session::snapshot`].
    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), Error>;

    /// Does one thing.
    ///
    /// # Errors
    /// [`Error::Run`] where it cannot be done; the state is then of no further use until it is restored.
    fn apply(&mut self, action: &Action) -> Result<(), Error>;

    /// Memory that a snapshot takes.
    fn bytes(snapshot: &Self::Snapshot) -> usize;
}

/// A session that can go back and forth.
#[derive(Debug)]
pub struct History<S: Session> {
    session: S,
    actions: Vec<Action>,
    /// Actions that are done; those after it are undone.
    done: usize,
    /// Snapshots by the number of actions done before them.
    kept: BTreeMap<usize, S::Snapshot>,
    used: usize,
    budget: usize,
}

impl<S: Session> History<S> {
    /// A history that begins here and keeps at most `budget` bytes of snapshots.
    ///
    /// # Errors
    /// [`Error::Limit`] where not even the start fits; those of the session.
    pub fn new(mut session: S, budget: usize) -> Result<Self, Error> {
        let start = session.snapshot()?;
        let used = S::bytes(&start);
        if used > budget {
            let limit = Limit::new(Quantity::MemoryBytes, used as u64, 0..=budget as u64);
            let limit = limit.of("the start, which is kept to undo");
            return Err(limit.remedy("give a larger budget").into());
        }
        Ok(Self { session, actions: Vec::new(), done: 0, kept: BTreeMap::from([(0, start)]), used, budget })
    }

    /// The session as it is now.
    pub fn session(&self) -> &S {
        &self.session
    }

    /// The session as it is now, to read from a device; what it is given to do escapes the history.
    pub fn session_mut(&mut self) -> &mut S {
        &mut self.session
    }

    /// All actions, those that are undone too.
    pub fn actions(&self) -> &[Action] {
        &self.actions
    }

    /// Actions that are done.
    pub fn done(&self) -> usize {
        self.done
    }

    /// Bytes that the snapshots take.
    pub fn used(&self) -> usize {
        self.used
    }

    /// Does something new; what was undone can then not be done again.
    ///
    /// # Errors
    /// Those of the session, which is then as it was before.
    pub fn act(&mut self, action: Action) -> Result<(), Error> {
        if let Err(error) = self.session.apply(&action) {
            self.arrive(self.done)?;
            return Err(error);
        }
        self.forget_after(self.done);
        self.actions.truncate(self.done);
        self.actions.push(action);
        self.done += 1;
        self.keep()
    }

    /// Takes the last action back; `false` where there is none.
    ///
    /// # Errors
    /// Those of the session while it does again what came before.
    pub fn undo(&mut self) -> Result<bool, Error> {
        let Some(before) = self.done.checked_sub(1) else { return Ok(false) };
        self.go_to(before)?;
        Ok(true)
    }

    /// Does the last undone action again; `false` where there is none.
    ///
    /// # Errors
    /// Those of the session.
    pub fn redo(&mut self) -> Result<bool, Error> {
        if self.done == self.actions.len() {
            return Ok(false);
        }
        self.go_to(self.done + 1)?;
        Ok(true)
    }

    /// Goes to where so many actions are done, at most all of them.
    ///
    /// # Errors
    /// Those of the session.
    pub fn go_to(&mut self, done: usize) -> Result<(), Error> {
        let done = done.min(self.actions.len());
        let nearest = self.nearest(done);
        if done < self.done || nearest > self.done {
            return self.arrive(done);
        }
        self.replay(done)
    }

    /// The last snapshot at or before a place.
    fn nearest(&self, done: usize) -> usize {
        *self.kept.range(..=done).next_back().expect("the start is always kept").0
    }

    /// Restores the nearest snapshot and goes on from there.
    fn arrive(&mut self, done: usize) -> Result<(), Error> {
        let from = self.nearest(done);
        self.session.restore(&self.kept[&from])?;
        self.done = from;
        self.replay(done)
    }

    fn replay(&mut self, done: usize) -> Result<(), Error> {
        while self.done < done {
            self.session.apply(&self.actions[self.done])?;
            self.done += 1;
        }
        self.keep()
    }

    /// Keeps the state here, if there is room for it once others have gone.
    fn keep(&mut self) -> Result<(), Error> {
        if self.kept.contains_key(&self.done) {
            return Ok(());
        }
        // A state is about as large as the first one, and room is made before it is copied.
        let wanted = S::bytes(&self.kept[&0]);
        if !self.make_room(wanted) {
            return Ok(());
        }
        let snapshot = self.session.snapshot()?;
        let bytes = S::bytes(&snapshot);
        if bytes <= wanted || self.make_room(bytes) {
            self.used += bytes;
            self.kept.insert(self.done, snapshot);
        }
        Ok(())
    }

    /// Drops snapshots until so many bytes are free; `false` where they cannot be.
    fn make_room(&mut self, bytes: usize) -> bool {
        while self.used.saturating_add(bytes) > self.budget {
            let Some(place) = self.cheapest() else { return false };
            self.drop_at(place);
        }
        true
    }

    fn drop_at(&mut self, place: usize) {
        if let Some(snapshot) = self.kept.remove(&place) {
            self.used -= S::bytes(&snapshot);
        }
    }

    fn forget_after(&mut self, done: usize) {
        while let Some((&place, _)) = self.kept.range((Excluded(done), Unbounded)).next_back() {
            self.drop_at(place);
        }
    }

    /// The snapshot whose loss costs the least, but never the first: the work from the one before it to the
    /// one after it, over the work from there to the present.
    fn cheapest(&self) -> Option<usize> {
        let work = self.work();
        let places: Vec<usize> = self.kept.keys().copied().collect();
        let cost = |place: usize| {
            let before = places[place - 1];
            let after = places.get(place + 1).copied().unwrap_or(self.actions.len());
            let away = work[places[place]].abs_diff(work[self.done]) + 1;
            (work[after] - work[before]) as f64 / away as f64
        };
        (1..places.len()).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).map(|place| places[place])
    }

    /// Work from the start to each place.
    fn work(&self) -> Vec<u64> {
        let sums = self.actions.iter().scan(0_u64, |sum, action| {
            *sum = sum.saturating_add(action.work());
            Some(*sum)
        });
        std::iter::once(0).chain(sums).collect()
    }
}
