//! Which row each slot of a ring holds. Without debug assertions it knows nothing and does nothing.

/// The watch over one ring.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    #[cfg(debug_assertions)]
    held: Vec<Option<usize>>,
}

#[cfg(debug_assertions)]
impl Watch {
    /// Over a ring of that many slots, none of which holds a row.
    pub(super) fn new(depth: usize) -> Self {
        Self { held: vec![None; depth] }
    }

    /// Panics unless row `y` lies in its slot.
    pub(super) fn read(&self, y: usize) {
        match self.held[y % self.held.len()] {
            Some(held) => assert_eq!(held, y, "row {y} is read where row {held} lies"),
            None => panic!("row {y} is read before it is written"),
        }
    }

    /// Row `y` takes its slot. What another row left there becomes NaN, so that nothing of it counts unseen.
    pub(super) fn write(&mut self, y: usize, row: &mut [f32]) {
        let slot = y % self.held.len();
        if self.held[slot].replace(y) != Some(y) {
            row.fill(f32::NAN);
        }
    }

    /// Row `y` lies in its slot.
    pub(super) fn hold(&mut self, y: usize) {
        let slot = y % self.held.len();
        self.held[slot] = Some(y);
    }

    /// Row `y` no longer lies in its slot.
    pub(super) fn forget(&mut self, y: usize) {
        let slot = y % self.held.len();
        self.held[slot] = None;
    }
}

#[cfg(not(debug_assertions))]
impl Watch {
    #[inline(always)]
    pub(super) fn new(_: usize) -> Self {
        Self {}
    }

    #[inline(always)]
    pub(super) fn read(&self, _: usize) {}

    #[inline(always)]
    pub(super) fn write(&mut self, _: usize, _: &mut [f32]) {}

    #[inline(always)]
    pub(super) fn hold(&mut self, _: usize) {}

    #[inline(always)]
    pub(super) fn forget(&mut self, _: usize) {}
}
