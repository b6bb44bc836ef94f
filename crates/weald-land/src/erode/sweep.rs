//! What every part of a step knows that streams over rows: where it is, what lies around it, which edges join cells.

use std::ops::Range;

use pulp::Arch;

use super::links::{LinkRow, Links};
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;

/// A sweep of a part of a step over the rows of a subdomain, between its walls.
#[derive(Clone)]
pub(crate) struct Sweep<'a> {
    pub(crate) links: &'a Links,
    /// Rings of the constant planes.
    pub(crate) constants: &'a [Ring],
    /// Newest row of what the part reads.
    pub(crate) newest: Option<usize>,
    pub(crate) span: Range<usize>,
    pub(crate) arch: Arch,
}

impl<'a> Sweep<'a> {
    /// The sweep of a part that reads rows up to `newest` of what flows by.
    pub(super) fn of<'flow: 'a, P: Process + ?Sized>(
        flow: &Flow<'flow, P>,
        links: &'a Links,
        arch: Arch,
        newest: Option<usize>,
    ) -> Self {
        Self { links, constants: flow.constants, newest, span: flow.span.clone(), arch }
    }

    /// The row `behind` rows behind the newest, where it exists.
    pub(crate) fn behind(&self, behind: usize) -> Option<usize> {
        self.newest?.checked_sub(behind).filter(|y| self.span.contains(y))
    }

    /// The row after `y`, or `y` itself before a wall, where no link leads on.
    pub(crate) fn next(&self, y: usize) -> usize {
        if y + 1 < self.span.end { y + 1 } else { y }
    }

    /// The row before `y`, or `y` itself behind a wall, where no link leads on.
    pub(crate) fn previous(&self, y: usize) -> usize {
        if y > self.span.start { y - 1 } else { y }
    }

    /// The links of row `y`.
    pub(crate) fn links(&self, y: usize) -> LinkRow<'_> {
        self.links.row(self.constants, y)
    }
}
