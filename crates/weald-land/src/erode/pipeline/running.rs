//! A pipeline on rows that stream by.

use super::parts::{Pipeline, Plane, Stage};
use super::parts::{Read, Source};
use super::{MAX_CHANGES, MAX_CONSTANTS, MAX_READS, source};
use crate::erode::links::LinkRow;
use crate::erode::sweep::Sweep;
use weald_engine::stencil::ring::Ring;

/// Rows in flight within a pipeline.
pub(crate) struct PipelineScratch {
    /// One ring a plane; those that leave at once are not used.
    rings: Vec<Ring>,
    /// The row beyond a wall.
    still: Vec<f32>,
}

/// What a pipeline reads.
pub(crate) struct PipelineRows<'a> {
    /// The state planes as the step finds them.
    pub(crate) input: &'a [Ring],
    pub(crate) sweep: &'a Sweep<'a>,
    /// Numbers of this step.
    pub(crate) weather: &'a [f32],
}

/// What a pipeline writes.
pub(crate) struct PipelineOutput<'a> {
    /// The state planes as the step leaves them.
    pub(crate) planes: &'a mut [Ring],
    /// Adds the sum of a row, which has a number, to a sum, which has one too.
    pub(crate) tally: &'a mut dyn FnMut(usize, usize, &[f32]),
}

impl Plane {
    /// Rows of it that are in flight.
    pub(super) fn depth(&self) -> usize {
        self.oldest.map_or(1, |oldest| oldest - self.behind + 1)
    }
}

impl Pipeline {
    /// Memory for rows of this many cells.
    pub(crate) fn scratch(&self, columns: usize) -> PipelineScratch {
        let ring = |plane: &Plane| match plane.output {
            Some(_) => Ring::new(0, 1),
            None => Ring::new(columns, plane.depth()),
        };
        PipelineScratch { rings: self.planes.iter().map(ring).collect(), still: vec![0.0; columns] }
    }

    /// Runs every kernel on the next row for which all is there that it reads.
    pub(crate) fn advance(
        &self,
        rows: &PipelineRows<'_>,
        scratch: &mut PipelineScratch,
        output: &mut PipelineOutput<'_>,
    ) {
        for stage in &self.stages {
            if let Some(y) = rows.sweep.behind(stage.behind) {
                // Lists of rows no longer than they must be: at short rows their making counts.
                match (stage.reads.len(), stage.changes) {
                    (0..=6, 0..=2) => self.run::<6, 2>(stage, y, rows, scratch, output),
                    (0..=12, 0..=4) => self.run::<12, 4>(stage, y, rows, scratch, output),
                    _ => self.run::<MAX_READS, MAX_CHANGES>(stage, y, rows, scratch, output),
                }
            }
        }
        for &[plane, leaving] in &self.leaves {
            let Plane { behind, output: place, .. } = self.planes[leaving];
            if let (Some(y), Some(place)) = (rows.sweep.behind(behind), place) {
                scratch.rings[plane].hand_over(y, &mut output.planes[place]);
            }
        }
    }

    fn run<const READS: usize, const CHANGES: usize>(
        &self,
        stage: &Stage,
        y: usize,
        rows: &PipelineRows<'_>,
        scratch: &mut PipelineScratch,
        output: &mut PipelineOutput<'_>,
    ) {
        let (written, rest) = scratch.rings.split_at_mut(stage.first);
        let links = stage.linked.then(|| rows.sweep.links(y));
        let around = Around { rows, written, still: &scratch.still, links, y };
        let mut reads = [&[][..]; READS];
        for (row, read) in reads.iter_mut().zip(&stage.reads) {
            *row = around.row(*read);
        }
        let mut changes: [&mut [f32]; CHANGES] = std::array::from_fn(|_| <&mut [f32]>::default());
        let planes = &self.planes[stage.first..][..stage.changes];
        for ((row, plane), ring) in changes.iter_mut().zip(planes).zip(rest) {
            if plane.output.is_none() {
                *row = ring.here_mut(y);
            }
        }
        // Most kernels write nothing that leaves, and at short rows a search counts.
        if planes.iter().any(|plane| plane.output.is_some()) {
            for (number, ring) in output.planes.iter_mut().enumerate() {
                if let Some(place) = planes.iter().position(|plane| plane.output == Some(number)) {
                    changes[place] = ring.here_mut(y);
                }
            }
        }
        for (row, read) in changes.iter_mut().zip(&stage.updates) {
            row.copy_from_slice(around.row(*read));
        }
        let (reads, changes) = (&reads[..stage.reads.len()], &mut changes[..stage.changes]);
        let mut constants = [0.0; MAX_CONSTANTS];
        let constants = &mut constants[..stage.constants.len()];
        constants.copy_from_slice(&stage.constants);
        stage.forced.iter().for_each(|&(at, number)| constants[at] = rows.weather[number]);
        (stage.kernel)(rows.sweep.arch, reads, changes, constants);
        stage.tallies.iter().for_each(|&(row, sum)| (output.tally)(y, sum, changes[row]));
    }
}

/// The rows around row `y`.
struct Around<'a> {
    rows: &'a PipelineRows<'a>,
    written: &'a [Ring],
    still: &'a [f32],
    links: Option<LinkRow<'a>>,
    y: usize,
}

impl<'a> Around<'a> {
    /// The row of a neighbour, if there is one.
    fn neighbour(&self, read: Read) -> Option<usize> {
        self.y.checked_add_signed(read.south).filter(|y| self.rows.sweep.span.contains(y))
    }

    /// Which cells, or which of their neighbours, hold data.
    fn valid(&self, read: Read) -> &'a [f32] {
        let Some(y) = self.neighbour(read) else { return self.still };
        let sweep = self.rows.sweep;
        sweep.links.valid(sweep.constants, y, read.east)
    }

    #[inline(always)]
    fn row(&self, read: Read) -> &'a [f32] {
        let sweep = self.rows.sweep;
        let ring = match read.source {
            Source::Link(source::VALID) => return self.valid(read),
            Source::Link(number) => {
                return source::link(self.links.as_ref().expect("a stage that reads links"), number);
            }
            Source::Constant(0) => &sweep.constants[0],
            Source::Constant(number) => &sweep.constants[number + sweep.links.planes()],
            Source::Input(number) => &self.rows.input[number],
            Source::Plane(number) => &self.written[number],
        };
        let Some(y) = self.neighbour(read) else { return self.still };
        match read.east {
            0 => ring.here(y),
            1 => ring.east(y),
            _ => ring.west(y),
        }
    }
}
