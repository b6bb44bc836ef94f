//! When each kernel can run, and what follows from that.

use std::sync::Arc;

use super::parts::{Pipeline, Plane, RunOn, Stage};
use super::parts::{Reach, Read, Source};
use super::source::VALID;

/// The rows of a kernel.
pub(super) struct Rows {
    pub(super) reads: Vec<Read>,
    pub(super) updates: Vec<Read>,
    /// Names of the planes that it makes: one an update, and one a row that it writes.
    pub(super) changes: Vec<&'static str>,
}

/// The constants of a kernel, and which of them are numbers of the weather.
pub(super) type Numbers = (Vec<f32>, Vec<(usize, usize)>);

impl Rows {
    fn read(&self) -> impl Iterator<Item = &Read> {
        self.reads.iter().chain(&self.updates)
    }
}

impl Pipeline {
    /// Adds a kernel that runs as soon as all rows are there that it reads.
    pub(super) fn add(&mut self, kernel: RunOn, rows: Rows, (constants, forced): Numbers) {
        let behind = rows.read().map(|read| self.behind(read.source).saturating_add_signed(read.south));
        let behind = behind.max().unwrap_or(0);
        let reach = rows.read().fold(Reach::default(), |reach, read| reach.or(read.reach(&self.planes)));
        rows.read().for_each(|read| self.keep_for(*read, behind));
        let first = self.planes.len();
        let plane = |&name| Plane { name, behind, oldest: None, reach, output: None };
        self.planes.extend(rows.changes.iter().map(plane));
        let linked = rows.read().any(|read| matches!(read.source, Source::Link(link) if link != VALID));
        let (reads, updates, changes) = (rows.reads, rows.updates, rows.changes.len());
        let tallies = Vec::new();
        self.stages.push(Stage {
            kernel,
            behind,
            reads,
            updates,
            linked,
            first,
            changes,
            constants,
            forced,
            tallies,
        });
    }

    /// Makes a plane that kernels read the state plane of a number, as soon as all have read it.
    pub(super) fn leave(&mut self, plane: usize, number: usize) {
        let Plane { name, behind, oldest, reach, .. } = self.planes[plane];
        self.leaves.push([plane, self.planes.len()]);
        let behind = oldest.unwrap_or(behind);
        self.planes.push(Plane { name, behind, oldest: None, reach, output: Some(number) });
    }

    /// Place of a number among those that differ from step to step.
    pub(super) fn forced(&self, name: &str) -> Option<usize> {
        self.weather.iter().position(|number| *number == name)
    }

    /// Keeps a row for a kernel that runs that many rows behind the input.
    fn keep_for(&mut self, read: Read, behind: usize) {
        let oldest = behind.saturating_add_signed(-read.south);
        if let Source::Plane(plane) = read.source {
            let known = &mut self.planes[plane].oldest;
            *known = Some(known.map_or(oldest, |known| known.max(oldest)));
        } else {
            self.look_back = self.look_back.max(oldest);
        }
    }

    /// Rows by which a plane lies behind the input.
    fn behind(&self, source: Source) -> usize {
        if let Source::Plane(plane) = source { self.planes[plane].behind } else { 0 }
    }

    fn outputs(&self) -> impl Iterator<Item = &Plane> {
        self.planes.iter().filter(|plane| plane.output.is_some())
    }

    /// Rows by which the result lies behind the input.
    pub(crate) fn lag(&self) -> usize {
        self.outputs().map(|plane| plane.behind).max().unwrap_or(0)
    }

    /// Rows of the input and of the constants that are looked back at.
    pub(crate) fn look_back(&self) -> usize {
        self.look_back
    }

    /// Rows by which the first part of the result lies behind the input.
    pub(super) fn begins(&self) -> usize {
        self.outputs().map(|plane| plane.behind).min().unwrap_or(0)
    }

    /// Cells to the farthest that a cell of the result depends on.
    pub(crate) fn reach(&self) -> usize {
        self.outputs().map(|plane| plane.reach.farthest()).max().unwrap_or(0).max(1)
    }

    /// The same where the state planes are some of those of a larger process, which stand at these places.
    pub(crate) fn placed(&self, place: impl Fn(usize) -> usize) -> Arc<Self> {
        let mut placed = self.clone();
        for plane in &mut placed.planes {
            plane.output = plane.output.map(&place);
        }
        Arc::new(placed)
    }

    /// Names of the state planes.
    pub(crate) fn state_names(&self) -> Vec<String> {
        self.state.iter().map(|state| state.after.to_owned()).collect()
    }
}
