//! A run of many steps cut into parts of passes, so that no submission keeps a device busy for long.

/// Some rows of workgroups of a pass in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) step: usize,
    pub(crate) pass: usize,
    /// Rows of workgroups, the first and how many, in units of [`Work::unit`].
    pub(crate) first: usize,
    pub(crate) units: usize,
}

/// What is to be done.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    /// The passes of each step in order, and the bytes that a unit of each moves.
    pub(crate) passes: Vec<(usize, u64)>,
    /// Steps.
    pub(crate) steps: usize,
    /// Units from north to south.
    pub(crate) units: usize,
}

/// How far the work has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cursor {
    pub(crate) step: usize,
    place: usize,
    unit: usize,
}

/// How much one submission may do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    pub(crate) bytes: u64,
    pub(crate) steps: usize,
}

impl Work {
    /// The next parts: as many as the bound allows, at least one unless all is done; and the bytes they move.
    pub(crate) fn next(&self, cursor: &mut Cursor, bound: Bound) -> (Vec<Part>, u64) {
        let (mut parts, mut moved) = (Vec::new(), 0);
        let end = self.steps.min(cursor.step + bound.steps.max(1));
        while cursor.step < end && !self.passes.is_empty() {
            let (pass, bytes) = self.passes[cursor.place];
            let fitting = (bound.bytes.saturating_sub(moved) / bytes.max(1)) as usize;
            let units = fitting.max(usize::from(parts.is_empty())).min(self.units - cursor.unit);
            if units == 0 {
                break;
            }
            parts.push(Part { step: cursor.step, pass, first: cursor.unit, units });
            moved += bytes * units as u64;
            self.move_on(cursor, units);
        }
        (parts, moved)
    }

    fn move_on(&self, cursor: &mut Cursor, units: usize) {
        cursor.unit += units;
        if cursor.unit == self.units {
            (cursor.unit, cursor.place) = (0, cursor.place + 1);
        }
        if cursor.place == self.passes.len() {
            (cursor.place, cursor.step) = (0, cursor.step + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_parts(work: &Work, bound: Bound) -> Vec<Vec<Part>> {
        let mut cursor = Cursor::default();
        let mut submissions = Vec::new();
        while cursor.step < work.steps {
            let (parts, _) = work.next(&mut cursor, bound);
            assert!(!parts.is_empty(), "a submission does something");
            submissions.push(parts);
        }
        submissions
    }

    #[test]
    fn every_unit_of_every_pass_of_every_step_comes_once_and_in_order() {
        let work = Work { passes: vec![(0, 7), (2, 100), (5, 1)], steps: 5, units: 9 };
        for bytes in [0, 1, 50, 333, 10_000, u64::MAX] {
            for steps in [1, 2, 100] {
                let parts: Vec<_> = all_parts(&work, Bound { bytes, steps }).concat();
                let units = parts.iter().flat_map(|part| {
                    (part.first..part.first + part.units).map(|unit| (part.step, part.pass, unit))
                });
                let expected = (0..5).flat_map(|step| {
                    [0, 2, 5].into_iter().flat_map(move |pass| (0..9).map(move |unit| (step, pass, unit)))
                });
                assert!(units.eq(expected), "{bytes} bytes, {steps} steps");
            }
        }
    }

    #[test]
    fn a_submission_keeps_its_bounds_unless_a_single_unit_passes_them() {
        let work = Work { passes: vec![(0, 10), (1, 30)], steps: 20, units: 4 };
        for submission in all_parts(&work, Bound { bytes: 100, steps: 3 }) {
            let moved: usize = submission.iter().map(|part| part.units * [10, 30][part.pass]).sum();
            let steps = submission.last().map_or(0, |last| last.step - submission[0].step + 1);
            assert!(moved <= 100 && steps <= 3, "{submission:?}");
        }
        let single = all_parts(&work, Bound { bytes: 20, steps: 3 });
        assert!(single.iter().flatten().any(|part| part.pass == 1), "30 bytes pass the bound of 20");
        assert!(single.iter().all(|parts| parts.iter().map(|part| part.units).sum::<usize>() <= 2));
    }
}
