//! Sums of octaves as one compute pass.

use crate::generate::noise::Octave;
use weald_core::domain::Domain;
use weald_engine::on_device::OnDevice;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Buffer, Content, Uniforms};
use weald_engine::uniform;
use weald_engine::uniform::Uniform;

const HASH: &str = include_str!("../hash.wgsl");
const NOISE: &str = include_str!("../noise.wgsl");
const OCTAVES: &str = include_str!("../octaves.wgsl");

uniform! {
    /// First row of a band of the landscape.
    struct Band {
        first_row: u32,
    }
}

/// A pass over octaves, each with its amplitude.
pub(crate) struct OctavePass<'a> {
    /// Name of the generator and of its pass.
    pub(crate) name: &'static str,
    /// Shaders of the pass, which writes the buffer `height`.
    pub(crate) shaders: &'a [&'static str],
    pub(crate) constants: Uniforms,
    pub(crate) octaves: Vec<(Octave, f32)>,
}

impl OctavePass<'_> {
    /// The program with its tables.
    pub(crate) fn on_device(&self, domain: &Domain) -> OnDevice {
        let weather = Uniforms::of(&Band { first_row: 0 });
        let shaders = [&[HASH, NOISE, OCTAVES], self.shaders].concat();
        let mut draft = ProgramBuilder::new(self.name, &shaders, self.constants.clone(), weather);
        let tables = self.tables();
        for (name, words) in &tables {
            draft.add(Buffer::of_words(name, 4, Content::Table(words.len() / 4)));
        }
        draft.scratch("height", 1);
        draft.pass(self.name, &[], &["columns", "rows", "octaves"], &["height"]);
        OnDevice {
            program: draft.finish(0),
            tables,
            size: domain.size,
            in_bands: true,
            steps: Box::new(|first_row| vec![Band { first_row }.words()]),
            result: "height",
        }
    }

    fn tables(&self) -> Vec<(&'static str, Vec<u32>)> {
        let octaves = || self.octaves.iter();
        vec![
            ("columns", octaves().flat_map(|(octave, _)| octave.column_words()).collect()),
            ("rows", octaves().flat_map(|(octave, _)| octave.row_words()).collect()),
            ("octaves", octaves().flat_map(|(octave, amplitude)| octave.own_words(*amplitude)).collect()),
        ]
    }
}
