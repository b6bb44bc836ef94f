//! A process as compute passes for a device: data alone, without any GPU interface.
//!
//! A pass is a WGSL module put together from the shaders that stand beside the CPU's kernels. A shader holds
//! the method only: what it can see (grid, constants, weather, buffers) is written in front of it from the
//! declarations here, so that host and shader cannot come to disagree about a binding.

pub mod builder;
pub mod mentions;
pub mod twin;

use std::fmt::Write;

use super::uniform::Uniform;
use crate::sums::SUMS;

/// Sums that programs count, for each workgroup.
pub const COUNTED: usize = SUMS;

/// Cells along a side of a workgroup.
pub const GROUP: usize = 16;

/// Most storage buffers of one pass: what browsers allow.
pub const MAX_BUFFERS: usize = 8;

/// Shaders that every pass begins with.
const PRELUDE: &str = include_str!("stencil/prelude.wgsl");
const LINKS_WHOLE: &str = include_str!("stencil/links_whole.wgsl");
const LINKS_MASKED: &str = include_str!("stencil/links_masked.wgsl");
const TALLY: &str = include_str!("stencil/tally.wgsl");
const TALLY_NONE: &str = include_str!("stencil/tally_none.wgsl");

/// One step of a process.
#[derive(Clone, Debug)]
pub struct Program {
    /// Name of the process, for errors.
    pub name: &'static str,
    /// Values a cell, in buffers.
    pub buffers: Vec<Buffer>,
    /// What is done in one step, in order.
    pub passes: Vec<Pass>,
    /// Buffers that change roles after each step: what was written becomes what is read.
    pub swaps: Vec<[usize; 2]>,
    /// Constants of the method, bound as `constants`.
    pub constants: Uniforms,
    /// Struct that differs from step to step, bound as `weather`: its name and its words.
    pub weather: Uniforms,
    /// Switches that are known when shaders are compiled: `const NAME: bool`.
    pub flags: Vec<(&'static str, bool)>,
    /// Counts that are known when shaders are compiled: `const NAME: u32`.
    pub counts: Vec<(&'static str, usize)>,
    /// Buffer with (land, yields), where the world has cells without data.
    pub mask: Option<usize>,
    /// Cells of the farthest neighbour that a cell depends on in one step.
    pub reach: usize,
    /// Where ground and water are, for those who look at it as it runs.
    pub shown: Option<Shown>,
}

/// Buffers of a program that hold the ground and the water on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Ground to which all lanes of `added` are added, in metres.
    pub base: usize,
    /// What has come onto it or gone from it: one lane, or layers.
    pub added: usize,
    /// Depth of the water in metres, in the first lane.
    pub water: Option<usize>,
}

/// Values a cell in one storage buffer, bound by its name: `array<f32>`, or vectors of two or four.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// Name in the shaders.
    pub name: &'static str,
    /// Values a cell: 1, 2 or 4; or any number in a buffer of layers, one plane after the other.
    pub lanes: usize,
    /// Whether lanes are planes one after the other (`array<f32>` of lanes × cells) instead of vectors.
    pub layered: bool,
    /// Whether its values are whole numbers of 32 bits (`u32`), written and read as the bits of `f32`.
    pub words: bool,
    /// What is in it.
    pub content: Content,
}

/// What a buffer holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// State planes of the process with these numbers, one a lane.
    State(Vec<usize>),
    /// Constant planes of the process with these numbers (counted with the state planes before them).
    Constant(Vec<usize>),
    /// What passes hand to each other within a step.
    Scratch,
    /// Sums over the recorded steps, one lane a wish; zero at the start.
    Mean,
    /// So many elements that the host writes and all cells read.
    Table(usize),
}

/// One dispatch over all cells.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Name, for errors and time measurements.
    pub name: &'static str,
    /// Shaders with its functions; one has `@compute @workgroup_size(16, 16) fn NAME`, where NAME is this name.
    pub shaders: Vec<&'static str>,
    /// Buffers that it reads.
    pub reads: Vec<usize>,
    /// Buffers that it writes, or reads and writes.
    pub writes: Vec<usize>,
    /// Whether it counts into the sums.
    pub tallies: bool,
    /// Whether it runs in recorded steps alone.
    pub recorded: bool,
}

/// A uniform: name of its struct and its words.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Uniforms {
    /// Name of the struct in WGSL; empty where there is none.
    pub name: &'static str,
    /// Names and types of the fields, for tests that compare them with the shader.
    pub fields: Vec<(&'static str, &'static str)>,
    /// Its 32-bit words; for the weather the words of no step in particular.
    pub words: Vec<u32>,
}

impl Uniforms {
    /// Of a struct.
    pub fn of<U: Uniform>(values: &U) -> Self {
        Self { name: U::NAME, fields: U::fields(), words: values.words() }
    }

    /// The struct in WGSL.
    fn declared(&self) -> String {
        let mut text = format!("struct {} {{\n", self.name);
        for (name, kind) in &self.fields {
            let _ = writeln!(text, "    {name}: {kind},");
        }
        text + "}\n"
    }

    /// The same struct with the fields of another behind its own.
    #[must_use]
    pub fn followed_by<U: Uniform>(mut self, values: &U) -> Self {
        self.fields.extend(U::fields());
        self.words.extend(values.words());
        self
    }
}

impl Buffer {
    /// A buffer of vectors.
    pub fn new(name: &'static str, lanes: usize, content: Content) -> Self {
        Self { name, lanes, layered: false, words: false, content }
    }

    /// A buffer of planes one after the other.
    pub fn layered(name: &'static str, lanes: usize, content: Content) -> Self {
        Self { name, lanes, layered: true, words: false, content }
    }

    /// A buffer of vectors of whole numbers.
    pub fn of_words(name: &'static str, lanes: usize, content: Content) -> Self {
        Self { words: true, ..Self::new(name, lanes, content) }
    }

    /// Numbers of four bytes in it for a grid of that many cells.
    pub fn length(&self, cells: usize) -> usize {
        match self.content {
            Content::Table(elements) => self.lanes * elements,
            _ => self.lanes * cells,
        }
    }

    /// Bytes that each cell takes; those of a table do not grow with the grid.
    fn bytes_per_cell(&self) -> usize {
        if matches!(self.content, Content::Table(_)) { 0 } else { 4 * self.lanes }
    }

    fn element(&self) -> String {
        let number = if self.words { "u32" } else { "f32" };
        match (self.layered, self.lanes) {
            (true, _) | (false, 1) => number.to_owned(),
            (false, lanes @ (2 | 4)) => format!("vec{lanes}<{number}>"),
            (false, other) => unreachable!("a buffer of vectors of {other}"),
        }
    }
}

impl Program {
    /// Number of the buffer with this name.
    ///
    /// # Panics
    /// If there is none: a bug of the process.
    pub fn buffer(&self, name: &str) -> usize {
        let found = self.buffers.iter().position(|buffer| buffer.name == name);
        found.unwrap_or_else(|| panic!("{} has no buffer `{name}`", self.name))
    }

    /// Storage buffers of a pass in the order of their bindings, and whether it may write them. Bindings
    /// start at 3, behind `grid`, `constants` and `weather`; where the pass tallies, `sums` comes last.
    pub fn bound(&self, pass: &Pass) -> Vec<(usize, bool)> {
        let mask = self.mask.filter(|mask| !pass.reads.contains(mask));
        let reads = mask.iter().chain(&pass.reads).map(|&buffer| (buffer, false));
        reads.chain(pass.writes.iter().map(|&buffer| (buffer, true))).collect()
    }

    /// Whether another program has the same buffers and passes, and differs in the numbers of its constants at most.
    pub fn differs_in_numbers_alone(&self, other: &Self) -> bool {
        let shape = |program: &Self| {
            let Uniforms { name, fields, .. } = program.constants.clone();
            (name, fields, program.weather.clone(), program.swaps.clone(), program.mask, program.reach)
        };
        let modules = |program: &Self| -> Vec<_> {
            program
                .passes
                .iter()
                .map(|pass| (program.module(pass), pass.recorded, program.bound(pass)))
                .collect()
        };
        self.buffers == other.buffers && shape(self) == shape(other) && modules(self) == modules(other)
    }

    /// The whole WGSL module of a pass.
    pub fn module(&self, pass: &Pass) -> String {
        let mut text = self.bindings(pass);
        for (name, value) in &self.flags {
            let _ = writeln!(text, "const {name}: bool = {value};");
        }
        for (name, value) in &self.counts {
            let _ = writeln!(text, "const {name}: u32 = {value}u;");
        }
        let _ = writeln!(text, "const GROUP: u32 = {GROUP}u;\nconst SUMS: u32 = {SUMS}u;");
        text.push_str(PRELUDE);
        text.push_str(if self.mask.is_some() { LINKS_MASKED } else { LINKS_WHOLE });
        text.push_str(if pass.tallies { TALLY } else { TALLY_NONE });
        for shader in &pass.shaders {
            text.push_str(shader);
        }
        text
    }

    fn bindings(&self, pass: &Pass) -> String {
        let mut text = "@group(0) @binding(0) var<uniform> grid: Grid;\n".to_owned();
        for (at, (variable, uniforms)) in
            [("constants", &self.constants), ("weather", &self.weather)].into_iter().enumerate()
        {
            if !uniforms.name.is_empty() {
                let (at, name) = (at + 1, uniforms.name);
                if !pass.shaders.iter().any(|shader| shader.contains(&format!("struct {name} {{"))) {
                    text.push_str(&uniforms.declared());
                }
                let _ = writeln!(text, "@group(0) @binding({at}) var<uniform> {variable}: {name};");
            }
        }
        let bound = self.bound(pass);
        for (at, &(buffer, written)) in bound.iter().enumerate() {
            let (at, access) = (at + 3, if written { "read_write" } else { "read" });
            let buffer = &self.buffers[buffer];
            let (name, element) = (buffer.name, buffer.element());
            let _ =
                writeln!(text, "@group(0) @binding({at}) var<storage, {access}> {name}: array<{element}>;");
        }
        if pass.tallies {
            let at = bound.len() + 3;
            let _ =
                writeln!(text, "@group(0) @binding({at}) var<storage, read_write> sums: array<vec2<f32>>;");
        }
        text
    }

    /// Bytes per cell that all buffers take.
    pub fn bytes_per_cell(&self) -> usize {
        self.buffers.iter().map(Buffer::bytes_per_cell).sum()
    }

    /// Bytes of all tables.
    pub fn table_bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| 4 * buffer.length(0) as u64).sum()
    }

    /// Bytes per cell of the copy that is kept to go back to.
    pub fn bytes_kept_per_cell(&self) -> usize {
        let kept = |content: &Content| matches!(content, Content::State(_) | Content::Mean);
        self.buffers.iter().filter(|buffer| kept(&buffer.content)).map(|buffer| 4 * buffer.lanes).sum()
    }

    /// Bytes per cell of the widest buffer.
    pub fn widest_buffer(&self) -> usize {
        self.buffers.iter().map(Buffer::bytes_per_cell).max().unwrap_or(4).max(4)
    }

    /// Bytes per cell that one step reads and writes, each buffer of a pass counted once: what the memory must
    /// carry at least.
    pub fn bytes_per_cell_step(&self) -> usize {
        let every = self.passes.iter().filter(|pass| !pass.recorded);
        every.flat_map(|pass| self.bound(pass)).map(|(buffer, _)| self.buffers[buffer].bytes_per_cell()).sum()
    }
}
