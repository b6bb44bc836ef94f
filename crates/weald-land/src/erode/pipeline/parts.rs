//! The parts of a pipeline: planes, stages, and where rows come from.

use pulp::Arch;

use weald_engine::program::Uniforms;

/// A kernel over rows that are known by number.
pub(super) type RunOn = fn(Arch, &[&[f32]], &mut [&mut [f32]], &[f32]);

/// Kernels in their order, and when each can run.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    pub(super) uniforms: Uniforms,
    pub(super) constants: Vec<&'static str>,
    pub(super) state: Vec<State>,
    pub(super) planes: Vec<Plane>,
    pub(super) stages: Vec<Stage>,
    /// Planes that leave when all have read them: the plane, and the one as which it leaves.
    pub(super) leaves: Vec<[usize; 2]>,
    /// Rows that are looked back at in the input and in the constants.
    pub(super) look_back: usize,
    /// Names of the numbers that differ from step to step.
    pub(super) weather: Vec<&'static str>,
    pub(super) twin: Twin,
}

/// A plane that steps change.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// Name of the rows that a step finds.
    pub(super) before: &'static str,
    /// Name of the rows that it leaves, and of the plane in checkpoints.
    pub(super) after: &'static str,
}

/// A plane that a kernel writes.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) name: &'static str,
    /// Rows by which it lies behind the input.
    pub(super) behind: usize,
    /// Rows by which the oldest row that is read lies behind the input.
    pub(super) oldest: Option<usize>,
    pub(super) reach: Reach,
    /// The state plane that it becomes.
    pub(super) output: Option<usize>,
}

/// A kernel and its rows.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    pub(super) kernel: RunOn,
    /// Rows by which it runs behind the input.
    pub(super) behind: usize,
    pub(super) reads: Vec<Read>,
    /// Rows that are copied to the first of the changed ones.
    pub(super) updates: Vec<Read>,
    /// Whether some of the rows are links.
    pub(super) linked: bool,
    /// The first of its planes; the others stand behind it.
    pub(super) first: usize,
    pub(super) changes: usize,
    pub(super) constants: Vec<f32>,
    /// Which of the constants are numbers of the weather, and which numbers.
    pub(super) forced: Vec<(usize, usize)>,
    /// Which of the changed rows are summed, and into which sum.
    pub(super) tallies: Vec<(usize, usize)>,
}

/// Shaders that do what the kernels do.
#[derive(Clone, Debug, Default)]
pub(super) struct Twin {
    /// Names and shaders of the passes, in their order.
    pub(super) passes: Vec<(&'static str, &'static str)>,
    pub(super) counts: Vec<(&'static str, usize)>,
}

/// A plane, or which cells are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// A plane that stays.
    Constant(usize),
    /// A plane as the step finds it.
    Input(usize),
    /// A plane that an earlier kernel writes.
    Plane(usize),
    /// One of [`LINKS`].
    Link(usize),
}

/// A row that a kernel reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Read {
    pub(super) source: Source,
    /// Columns to the east of the cell.
    pub(super) east: isize,
    /// Rows to the south of it.
    pub(super) south: isize,
}

/// Cells to the farthest in the west, east, north and south that a cell depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Reach(pub(super) [usize; 4]);

impl Reach {
    pub(super) fn or(self, other: Self) -> Self {
        Self(std::array::from_fn(|side| self.0[side].max(other.0[side])))
    }

    pub(super) fn farthest(self) -> usize {
        self.0.into_iter().fold(0, usize::max)
    }

    /// The same for a reader of cells that lie elsewhere.
    pub(super) fn from(self, east: isize, south: isize) -> Self {
        let [to_west, to_east, to_north, to_south] = self.0;
        let moved = |cells: usize, by: isize| cells.saturating_add_signed(by);
        Self([moved(to_west, -east), moved(to_east, east), moved(to_north, -south), moved(to_south, south)])
    }
}
