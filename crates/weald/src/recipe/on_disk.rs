//! Recipes for landscapes that do not fit into memory: what of them can be made from disk, and the disk that it takes.

use std::collections::BTreeSet;

use super::layer_output::Treatment;
use super::plan::{Content, Ground, Output, Recipe};
use crate::ground_file::GroundRows;
use weald_core::domain::Domain;
use weald_core::error::{Diagnostic, Error, RecipeError};
use weald_core::file_plane::VALUE;
use weald_core::grid::Size;
use weald_io::Encode;

impl Recipe {
    /// Bytes that a run from disk takes in its scratch folder at its peak, beside its files.
    ///
    /// # Errors
    /// [`Error::Recipe`] naming everything that cannot be made but in memory, each with its line; [`Error::Input`] for a file of
    /// the ground.
    pub fn scratch(&self) -> Result<u64, Error> {
        self.start_on_disk().map(|(domain, _)| self.scratch_on(domain.size))
    }

    /// The grid of a run from disk, and the file of its ground, where it has one.
    ///
    /// # Errors
    /// As [`Recipe::scratch`].
    pub(super) fn start_on_disk(&self) -> Result<(Domain, Option<GroundRows>), Error> {
        let diagnostics: Vec<_> = self.needs_memory().collect();
        if !diagnostics.is_empty() {
            return Err(RecipeError { file: self.file.clone(), diagnostics }.into());
        }
        let (domain, rows) = match &self.ground {
            Ground::Empty { size, cell, .. } => (Domain::new(*size, *cell), None),
            Ground::File { path, cell, said } => {
                let rows = GroundRows::open(path, *cell, said)?;
                self.check_on(&rows.domain)?;
                (rows.domain.clone(), Some(rows))
            }
        };
        self.steps.iter().try_for_each(|planned| planned.step.look_ahead_by_rows(&domain))?;
        Ok((domain, rows))
    }

    /// [`Recipe::scratch`] on a grid.
    pub(super) fn scratch_on(&self, size: Size) -> u64 {
        let cells = size.columns as u64 * size.rows as u64;
        let is_of_file = matches!(self.ground, Ground::File { .. });
        let of_file = is_of_file.then(|| "height".to_owned());
        let mut there: BTreeSet<_> = of_file.into_iter().collect();
        let mut peak = 0;
        for (number, planned) in self.steps.iter().enumerate() {
            let (before, wanted) = (there.len(), self.wanted_after(number + 1));
            let written = planned.step.writes().into_iter().map(|(name, _)| name);
            let written: BTreeSet<_> = written.filter(|name| wanted.contains(name)).collect();
            let own = planned.step.scratch_per_cell(&wanted).unwrap_or_default();
            peak = peak.max(cells * (own + VALUE * (before + written.len()) as u64));
            there.extend(written);
            there.retain(|name| wanted.contains(name));
        }
        // The smaller images of one file, each a quarter of the one before.
        let outputs = cells * VALUE * there.len() as u64 + cells * VALUE / 3;
        // Which cells have data, that of a smaller image among them.
        let valid = if is_of_file { cells * VALUE + cells * VALUE / 3 } else { 0 };
        peak.max(outputs) + valid
    }

    /// Layers that are needed after so many steps.
    pub(super) fn wanted_after(&self, done: usize) -> BTreeSet<String> {
        let steps = self.steps.iter().skip(done).flat_map(|planned| planned.step.reads());
        steps.chain(self.outputs.iter().flat_map(Output::reads)).collect()
    }

    /// What cannot be made from disk.
    fn needs_memory(&self) -> impl Iterator<Item = Diagnostic> {
        let whole = "a run out of core cannot make this";
        let start = [
            (
                matches!(self.ground, Ground::Empty { finest: Some(_), .. }),
                "`finest`, which --size and --preview set where they make a recipe coarser,",
            ),
            (self.sea_level.is_some(), "`sea_level`"),
            (self.materials.iter().any(|planned| planned.file.is_some()), "`from` of a material"),
        ];
        let start = start.into_iter().filter(|(asked, _)| *asked).map(move |(_, what)| Diagnostic {
            line: 1,
            message: format!("{whole}: {what} needs the landscape in memory"),
        });
        let steps = self.steps.iter().filter_map(move |planned| {
            let why = planned.step.scratch_per_cell(&BTreeSet::new()).err()?;
            let message = format!("{whole}: the step `{}`: {why}", planned.entry.name);
            Some(Diagnostic { line: planned.line, message })
        });
        let outputs = self.outputs.iter().filter(|output| !is_by_windows(output)).map(move |output| Diagnostic {
            line: output.line,
            message: format!(
                "{whole}: {}; of outputs it writes layers as .tif and .zarr, by the presets `cog` and `sharded` or without, and as \
                 .raw, .r16 and .r32, on the grid and in the numbers of the landscape",
                output.file.display()
            ),
        });
        start.chain(steps).chain(outputs)
    }
}

fn is_by_windows(output: &Output) -> bool {
    match &output.content {
        Content::Layer { encode: Encode::Windows { .. } | Encode::Strips { .. }, treatment, .. } => {
            *treatment == Treatment::default()
        }
        _ => false,
    }
}
