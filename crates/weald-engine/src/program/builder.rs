//! Programs written down part by part, with buffers called by their names.

use super::mentions::{Mention, mention};
use super::{Buffer, Content, Pass, Program, Shown, Uniforms};

/// A program in the making.
#[derive(Clone, Debug)]
pub struct ProgramBuilder {
    program: Program,
    /// Shaders that every pass begins with: the structs of the constants and of the weather.
    common: Vec<&'static str>,
}

impl ProgramBuilder {
    /// A program of no buffers and no passes; `common` are the shaders that every pass begins with.
    pub fn new(name: &'static str, common: &[&'static str], constants: Uniforms, weather: Uniforms) -> Self {
        let program = Program {
            name,
            buffers: Vec::new(),
            passes: Vec::new(),
            swaps: Vec::new(),
            constants,
            weather,
            flags: Vec::new(),
            counts: Vec::new(),
            mask: None,
            reach: 0,
            shown: None,
        };
        Self { program, common: common.to_vec() }
    }

    /// Adds a buffer.
    pub fn add(&mut self, buffer: Buffer) {
        self.program.buffers.push(buffer);
    }

    /// Adds a buffer of vectors with so many values a cell.
    pub fn buffer(&mut self, name: &'static str, lanes: usize, content: Content) {
        self.add(Buffer::new(name, lanes, content));
    }

    /// Adds a buffer of what passes hand to each other, or of what becomes state by a swap.
    pub fn scratch(&mut self, name: &'static str, lanes: usize) {
        self.buffer(name, lanes, Content::Scratch);
    }

    /// Adds the buffer with (land, yields) from the constant planes with these numbers.
    pub fn mask(&mut self, valid: usize, erodible: usize) {
        self.program.mask = Some(self.program.buffers.len());
        self.buffer("mask", 2, Content::Constant(vec![valid, erodible]));
    }

    /// Adds a switch.
    pub fn flag(&mut self, name: &'static str, value: bool) {
        self.program.flags.push((name, value));
    }

    /// Adds a count.
    pub fn count(&mut self, name: &'static str, value: usize) {
        self.program.counts.push((name, value));
    }

    /// Adds a buffer of planes one after the other.
    pub fn layered(&mut self, name: &'static str, lanes: usize, content: Content) {
        self.program.buffers.push(Buffer::layered(name, lanes, content));
    }

    /// Adds a pass that is made of these shaders, reads and writes these buffers, and counts nothing.
    pub fn pass(
        &mut self,
        name: &'static str,
        shaders: &[&'static str],
        reads: &[&str],
        writes: &[&str],
    ) -> &mut Pass {
        let named = |names: &[&str]| names.iter().map(|name| self.program.buffer(name)).collect();
        let pass = Pass {
            name,
            shaders: self.common.iter().chain(shaders).copied().collect(),
            reads: named(reads),
            writes: named(writes),
            tallies: false,
            recorded: false,
        };
        self.program.passes.push(pass);
        self.program.passes.last_mut().expect("it was just added")
    }

    /// Adds a pass that is made of these shaders. What it reads, writes and counts is what their text says.
    pub fn pass_of(&mut self, name: &'static str, shaders: &[&'static str]) -> &mut Pass {
        let text = shaders.concat();
        let mut named = [Vec::new(), Vec::new()];
        for (number, buffer) in self.program.buffers.iter().enumerate() {
            match mention(&text, buffer.name) {
                Mention::Never => {}
                Mention::Reads => named[0].push(number),
                Mention::Writes => named[1].push(number),
            }
        }
        let pass = self.pass(name, shaders, &[], &[]);
        [pass.reads, pass.writes] = named;
        pass.tallies = text.contains("tally(");
        pass
    }

    /// Says which buffers hold the ground, `base` and what is added to it, and the water on it.
    pub fn shows(&mut self, added: &str, water: Option<&str>) {
        let buffer = |name: &str| self.program.buffer(name);
        self.program.shown =
            Some(Shown { base: buffer("base"), added: buffer(added), water: water.map(buffer) });
    }

    /// Makes what was written into one buffer the content of the other after each step.
    pub fn swap(&mut self, read: &str, written: &str) {
        let pair = [read, written].map(|name| self.program.buffer(name));
        self.program.swaps.push(pair);
    }

    /// The whole program, in which a cell depends on others up to `reach` cells away.
    pub fn finish(self, reach: usize) -> Program {
        Program { reach, ..self.program }
    }
}
