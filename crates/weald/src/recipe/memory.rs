//! How much memory a run takes at its peak, by the recipe and the grid: so much is there before it starts, or it does not
//! start.
//!
//! While a step runs there are the layers that it found, which its copy of the landscape shares, those that it writes, and
//! what it needs beside them; while outputs are made, the layers of the end and what those need that are made side by
//! side.

use std::collections::BTreeSet;
use std::fmt::{Display, Formatter};
use std::ops::Range;
use std::path::Path;

use super::checkpoint::Head;
use super::plan::{Content, Ground, Output, Planned, Recipe};
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity, bytes_in_words};
use weald_core::landscape::Landscape;
use weald_core::material::layer_names;
use weald_core::sea;
use weald_engine::step::{Layered, Stage};
use weald_io::memory::{available, has_addresses};

/// Bytes of a value of a layer.
const VALUE: u64 = 4;
/// Bytes for a cell of each material above the bedrock in a simulation, as measured with four of them.
const A_MATERIAL: u64 = 40;
/// Fewest bytes for a cell of a step that is a simulation with planes of its own.
const SIMULATION: u64 = 40;
/// Most outputs that are made side by side: a thread that waits for a part of one begins another, on the same stack.
pub(super) const SIDE_BY_SIDE: usize = 8;
/// What a run takes on the smallest grid: the program, its threads and their stacks.
const PROGRAM: u64 = 16 << 20;

/// Addresses that allocators and threads may set aside without memory, beside twice the estimate.
const BESIDE: u64 = 256 << 20;

/// The peak of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Bytes.
    pub bytes: u64,
    /// The step or the output at which it is.
    pub at: String,
}

impl Display for Memory {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "about {} at {}", bytes_in_words(self.bytes), self.at)
    }
}

impl Recipe {
    /// An estimate of the most memory that a run on this grid takes.
    pub fn memory(&self, first: &Domain) -> Memory {
        let mut layers: BTreeSet<String> = BTreeSet::new();
        layers.extend(matches!(self.ground, Ground::File { .. }).then(|| "height".to_owned()));
        layers.extend(self.sea_level.iter().flat_map(|_| sea::LAYERS.map(str::to_owned)));
        let files = self.materials.iter().filter(|planned| planned.file.is_some());
        layers.extend(files.map(|planned| planned.material.name.clone()));
        self.memory_from(first, 0, layers)
    }

    /// The same for what is left of a run after so many steps, which made these layers.
    fn memory_from(&self, here: &Domain, done: usize, mut layers: BTreeSet<String>) -> Memory {
        let (steps, last) = self.grids_from(here, done);
        let finest = if done == 0 { self.finest_ground(here) } else { None };
        let mut peaks: Vec<Memory> = finest.into_iter().collect();
        for (index, (planned, grid)) in steps.iter().enumerate() {
            let found = layers.len() as u64;
            let written = self.written_by(planned);
            let next = steps.get(index + 1).map_or(&last, |(_, grid)| grid);
            let a_cell = VALUE * (found + written.len() as u64) + self.working_bytes(planned);
            layers.extend(written);
            // A step that changes the grid makes all layers anew.
            let after = if next.size == grid.size { 0 } else { VALUE * found * next.size.cells() as u64 };
            let at = format!("step {} (`{}`)", done + index + 1, planned.entry.name);
            peaks.push(Memory { bytes: a_cell * grid.size.cells() as u64 + after, at });
        }
        let cells = last.size.cells() as u64;
        let kept = VALUE * layers.len() as u64 * cells;
        for group in self.groups(&layers, cells) {
            let outputs = &self.outputs[group];
            let bytes = kept + outputs.iter().map(|output| output.bytes(&layers, cells)).sum::<u64>();
            let largest = outputs.iter().max_by_key(|output| output.bytes(&layers, cells));
            let at = largest.map_or_else(String::new, |output| output.file.display().to_string());
            peaks.push(Memory { bytes, at });
        }
        let start = Memory { bytes: 0, at: "the start".to_owned() };
        let peak = peaks.into_iter().max_by_key(|peak| peak.bytes).unwrap_or(start);
        Memory { bytes: peak.bytes + PROGRAM, ..peak }
    }

    /// The outputs in their order, in groups that are made side by side.
    pub(super) fn output_groups(&self, landscape: &Landscape) -> Vec<Range<usize>> {
        let layers = landscape.layers().map(|(name, _)| name.to_owned()).collect();
        self.groups(&layers, landscape.domain.size.cells() as u64)
    }

    /// The same for these layers: together a group takes no more than those and the largest output. A device draws one picture
    /// at a time.
    fn groups(&self, layers: &BTreeSet<String>, cells: u64) -> Vec<Range<usize>> {
        let bytes: Vec<u64> = self.outputs.iter().map(|output| output.bytes(layers, cells)).collect();
        let room = VALUE * layers.len() as u64 * cells + bytes.iter().copied().max().unwrap_or_default();
        let (mut groups, mut first, mut taken) = (Vec::new(), 0, 0);
        let is_drawn = |number: usize| self.outputs[number].render().is_some();
        for (number, bytes) in bytes.into_iter().enumerate() {
            let is_full = number - first == SIDE_BY_SIDE || taken + bytes > room;
            if number > first && (is_full || is_drawn(number) || is_drawn(number - 1)) {
                groups.push(first..number);
                (first, taken) = (number, 0);
            }
            taken += bytes;
        }
        groups.extend((first < self.outputs.len()).then_some(first..self.outputs.len()));
        groups
    }

    /// What ground takes that is generated on a finer grid than the landscape's: its heights, and half as many twice.
    fn finest_ground(&self, first: &Domain) -> Option<Memory> {
        let generates = |planned: &Planned| planned.entry.stage == Stage::Generate;
        let generator = self.steps.iter().find(|planned| generates(planned))?;
        let cells = first.finest?.cells() as u64;
        Some(Memory {
            bytes: 2 * VALUE * cells,
            at: format!("`{}` on the finest grid", generator.entry.name),
        })
    }

    /// Bytes for a cell that a step needs beside layers: a simulation of several materials has planes of each.
    fn working_bytes(&self, planned: &Planned) -> u64 {
        let own = planned.step.bytes_per_cell();
        let simulates = own >= SIMULATION && planned.step.layered() == Layered::Changes;
        let materials = if simulates { self.materials.len().saturating_sub(1) as u64 } else { 0 };
        own + A_MATERIAL * materials
    }

    fn written_by(&self, planned: &Planned) -> BTreeSet<String> {
        let mut written: BTreeSet<_> = planned.step.writes().into_iter().map(|(name, _)| name).collect();
        if planned.step.layered() == Layered::Changes {
            let materials: Vec<_> = self.materials.iter().map(|planned| planned.material.clone()).collect();
            written.extend(layer_names(&materials).map(str::to_owned));
        }
        written
    }

    /// Refuses a run that would take more memory than there is.
    ///
    /// # Errors
    /// [`Error::Limit`] with what it would take and what is allowed.
    pub(super) fn ensure_memory(&self, first: &Domain, allowed: Option<u64>) -> Result<(), Error> {
        self.ensure_peak(&self.memory(first), allowed)
    }

    /// The same for a run that goes on from a checkpoint, by its head.
    ///
    /// # Errors
    /// As [`Recipe::ensure_memory`].
    pub(super) fn ensure_memory_after(&self, head: &Head, allowed: Option<u64>) -> Result<(), Error> {
        self.ensure_peak(&self.memory_from(&head.domain, head.done, head.layers.clone()), allowed)
    }

    fn ensure_peak(&self, peak: &Memory, allowed: Option<u64>) -> Result<(), Error> {
        let there = self::allowed(allowed);
        let has_room = has_addresses(&[peak.bytes, peak.bytes, BESIDE]);
        if peak.bytes <= there && has_room {
            return Ok(());
        }
        let there = if has_room { there } else { there.min(peak.bytes - 1) };
        let limit = Limit::new(Quantity::MemoryBytes, peak.bytes, 0..=there);
        let remedy = "choose a smaller `size`, or, if there is more memory, say so with --memory";
        Err(limit.of(format!("{}: {}", self.file, peak.at)).remedy(remedy).into())
    }
}

impl Output {
    /// Bytes on so many cells, beside the layers that there are.
    fn bytes(&self, layers: &BTreeSet<String>, cells: u64) -> u64 {
        let working = match &self.content {
            Content::Layer { .. } => 16 * cells,
            Content::Picture { picture, .. } | Content::Film { picture, .. } => {
                let optional = picture.optional().into_iter().filter(|name| layers.contains(name));
                picture.working_bytes(cells)
                    + optional.map(|name| picture.optional_bytes(&name, cells)).sum::<u64>()
            }
            Content::Export { export, .. } => export.working_bytes(cells),
        };
        working + self.bytes_of_pixels()
    }

    /// Bytes whatever the landscape: those of the pixels.
    fn bytes_of_pixels(&self) -> u64 {
        16 * self.view_pixels().unwrap_or(0)
    }

    /// Pixels of a picture on so many cells: a map has one a cell, and as many as it takes to be read on a small grid.
    pub(super) fn pixels(&self, cells: u64) -> u64 {
        self.view_pixels().unwrap_or(0).max(cells)
    }

    fn view_pixels(&self) -> Option<u64> {
        let (Content::Picture { picture, .. } | Content::Film { picture, .. }) = &self.content else {
            return None;
        };
        Some(picture.as_view().map_or(1 << 20, |view| u64::from(view.width) * u64::from(view.height)))
    }
}

/// Refuses a file that is longer than the memory that there is, before any of it is read.
///
/// # Errors
/// [`Error::Limit`] with the length and what is allowed.
pub(super) fn ensure_file(path: &Path, bytes: u64, allowed: Option<u64>) -> Result<(), Error> {
    let there = self::allowed(allowed);
    if bytes <= there {
        return Ok(());
    }
    let limit = Limit::new(Quantity::MemoryBytes, bytes, 0..=there).of(path.display());
    Err(limit
        .remedy(
            "the file is read whole: cut or convert it, or, if there is more memory, say so with --memory",
        )
        .into())
}

/// Most memory that this process has taken until now, in bytes, where the system tells it.
#[cfg(target_os = "linux")]
pub(super) fn taken() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn taken() -> Option<u64> {
    None
}

/// Memory that a run may take: what it was allowed, else what is free.
pub(super) fn allowed(asked: Option<u64>) -> u64 {
    asked.or_else(available).unwrap_or(u64::MAX)
}
