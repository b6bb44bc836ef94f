//! Whether a rank computes its inside while the rows of its neighbours are on their way.
//!
//! Edges that wait for messages are bands of their own, around which some rows are computed twice more. That pays where messages
//! take longer than these rows, which only a measurement can tell: on shared memory they take a tenth of it, on a slow network many
//! times as long. Each rank decides for itself, since bits and messages are the same in either order.

/// When a rank computes its inside first. It changes nothing but the speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlap {
    /// Messages first, and then all rows.
    Never,
    /// Always where rows suffice.
    Always,
    /// Where it was faster.
    #[default]
    Measured,
}

/// Passages after which their times are looked at.
const PASSAGES: u32 = 8;

/// How a rank finds out.
#[derive(Debug, Default)]
pub(super) struct Trial {
    stage: Stage,
    passages: u32,
    waited: f64,
    took: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Stage {
    /// Messages come first; their times are looked at.
    #[default]
    Messages,
    /// The inside comes first on trial, against the seconds before.
    Inside(f64),
    /// It is as it is.
    Settled,
}

impl Trial {
    pub(super) fn of(overlap: Overlap) -> Self {
        let stage = if overlap == Overlap::Measured { Stage::Messages } else { Stage::Settled };
        Self { stage, ..Self::default() }
    }

    /// Whether it will look at what passages take.
    pub(super) fn is_running(&self) -> bool {
        self.stage != Stage::Settled
    }

    /// Takes the seconds of a passage, of which so many were spent waiting for messages; `cost` is how many times as long
    /// computing takes with edges. Says whether the inside comes first from now on, where that changes.
    pub(super) fn passed(&mut self, waited: f64, took: f64, cost: f64) -> Option<bool> {
        self.passages += 1;
        self.waited += waited;
        self.took += took;
        if self.passages < PASSAGES {
            return None;
        }
        let Self { stage, waited, took, .. } = std::mem::take(self);
        let (next, change) = match stage {
            Stage::Messages if waited > (cost - 1.0) * (took - waited) => (Stage::Inside(took), Some(true)),
            Stage::Messages => (Stage::Messages, None),
            Stage::Inside(before) => (Stage::Settled, (took > before).then_some(false)),
            Stage::Settled => (Stage::Settled, None),
        };
        self.stage = next;
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a trial says after so many passages of the same times.
    fn after(trial: &mut Trial, passages: u32, [waited, took]: [f64; 2]) -> Vec<bool> {
        (0..passages).filter_map(|_| trial.passed(waited, took, 1.1)).collect()
    }

    #[test]
    fn the_inside_comes_first_where_messages_take_longer_than_rows_twice() {
        let mut trial = Trial::of(Overlap::Measured);
        assert_eq!(after(&mut trial, 3 * PASSAGES, [0.05, 1.0]), [], "rows cost more");
        assert_eq!(after(&mut trial, PASSAGES, [0.2, 1.0]), [true]);
        assert_eq!(after(&mut trial, PASSAGES, [0.0, 0.9]), [], "it was faster");
        assert!(!trial.is_running());
    }

    #[test]
    fn what_was_slower_is_not_tried_again() {
        let mut trial = Trial::of(Overlap::Measured);
        assert_eq!(after(&mut trial, PASSAGES, [0.2, 1.0]), [true]);
        assert_eq!(after(&mut trial, PASSAGES, [0.0, 1.1]), [false]);
        assert!(!trial.is_running());
        assert_eq!(after(&mut trial, 3 * PASSAGES, [0.9, 1.0]), []);
        assert!(!Trial::of(Overlap::Always).is_running() && !Trial::of(Overlap::Never).is_running());
    }
}
