//! The moments of a history: each comes after one other, and several may come after the same.

use super::super::change::Action;

/// A moment, and what leads to it.
#[derive(Debug)]
pub(super) struct Moment<P> {
    /// The moment before; for the start itself.
    pub(super) before: usize,
    /// What was done; nothing for the start.
    pub(super) action: Option<Action>,
    /// Iterations from the start to here, a change counting as one.
    pub(super) work: u64,
    /// What takes the action back.
    pub(super) patch: Option<P>,
    /// Bytes of a copy of the state, where one is kept.
    pub(super) copy: Option<u64>,
    /// The moment after it that was visited last.
    pub(super) next: Option<usize>,
}

/// All moments, and where we are.
#[derive(Debug)]
pub(super) struct Tree<P> {
    pub(super) moments: Vec<Moment<P>>,
    pub(super) here: usize,
}

impl<P> Tree<P> {
    /// The start, of which a copy of so many bytes is kept.
    pub(super) fn new(bytes: u64) -> Self {
        let start = Moment { before: 0, action: None, work: 0, patch: None, copy: Some(bytes), next: None };
        Self { moments: vec![start], here: 0 }
    }

    /// A new moment after this one, at which we then are.
    pub(super) fn grow(&mut self, work: u64, action: Action) -> usize {
        let (before, number) = (self.here, self.moments.len());
        let work = self.moments[before].work.saturating_add(work);
        self.moments.push(Moment { before, action: Some(action), work, patch: None, copy: None, next: None });
        self.moments[before].next = Some(number);
        self.here = number;
        number
    }

    /// From the start to a moment, both included.
    pub(super) fn path(&self, moment: usize) -> Vec<usize> {
        let before = |&at: &usize| (at != 0).then(|| self.moments[at].before);
        let mut path: Vec<_> = std::iter::successors(Some(moment), before).collect();
        path.reverse();
        path
    }

    /// The last moment that lies on the ways both to here and there.
    pub(super) fn fork(&self, moment: usize) -> usize {
        let (here, there) = (self.path(self.here), self.path(moment));
        here.iter().zip(&there).take_while(|(a, b)| a == b).last().map_or(0, |(&at, _)| at)
    }

    /// The last moment on the way to one, that one included, of which a copy is kept.
    pub(super) fn nearest_copy(&self, moment: usize) -> usize {
        let mut at = moment;
        while self.moments[at].copy.is_none() && at != 0 {
            at = self.moments[at].before;
        }
        at
    }

    /// Whether all that was done from a moment on the way to here can be taken back.
    pub(super) fn can_be_taken_back_to(&self, moment: usize) -> bool {
        let after = self.path(self.here).into_iter().rev().take_while(|&at| at != moment);
        after.into_iter().all(|at| self.moments[at].patch.is_some())
    }

    /// Whether a moment comes next after this one.
    pub(super) fn comes_after_here(&self, moment: usize) -> bool {
        moment != 0 && self.moments[moment].before == self.here
    }

    /// Redo goes this way from now on.
    pub(super) fn remember_way(&mut self, moment: usize) {
        for pair in self.path(moment).windows(2) {
            self.moments[pair[0]].next = Some(pair[1]);
        }
    }

    /// The copy whose loss costs the least, but never the first: the work from the copy before it, over the work from
    /// there to the present.
    pub(super) fn cheapest_copy(&self) -> Option<usize> {
        let cost = |moment: usize| {
            let (at, before) = (&self.moments[moment], self.nearest_copy(self.moments[moment].before));
            let fork = self.moments[self.fork(moment)].work;
            let away = (at.work - fork) + (self.moments[self.here].work - fork) + 1;
            (at.work - self.moments[before].work) as f64 / away as f64
        };
        let kept = (1..self.moments.len()).filter(|&moment| self.moments[moment].copy.is_some());
        kept.min_by(|&a, &b| cost(a).total_cmp(&cost(b)))
    }
}
