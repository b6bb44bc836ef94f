//! Steps that look at a cell and at those around it alone: they run on some rows of a landscape at a time, each time as on a small
//! one in memory, so that they need no second program for landscapes on disk and over ranks.

use std::ops::Range;
use std::sync::Arc;

use crate::job::Job;
use crate::ranks::agreed;
use crate::stored::{StoredLandscape, StoredPlane};
use crate::stored_plane::swap_margins;
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::file_plane::VALUE;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;

/// Most rows at a time, after which a run can be interrupted.
const MOST_ROWS: usize = 1 << 10;

/// How far a cell looks: so many metres, and so many cells more.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Metres.
    pub metres: f64,
    /// Cells beside them.
    pub cells: usize,
}

impl Reach {
    /// The same in rows of cells of so many metres.
    pub fn rows(self, cell: f64) -> usize {
        (self.metres / cell).ceil() as usize + self.cells
    }
}

/// What a step does, as far as rows need to know.
#[derive(Debug)]
pub struct LocalWork {
    /// Layers that it reads.
    reads: Vec<String>,
    /// Layers that it writes.
    writes: Vec<String>,
    /// How far it looks.
    reach: Reach,
    /// Bytes of memory for a cell beside these layers.
    bytes_per_cell: u64,
}

impl LocalWork {
    /// That of a step which reads and writes these layers.
    pub fn of(
        (reads, writes): (Vec<String>, Vec<(String, &'static str)>),
        (reach, bytes_per_cell): (Reach, u64),
    ) -> Self {
        let writes = writes.into_iter().map(|(name, _)| name).collect();
        Self { reads, writes, reach, bytes_per_cell }
    }
}

/// Runs on a landscape of some rows.
type OnRows<'a, T> = &'a dyn Fn(&mut Landscape) -> Result<T, Error>;

/// Runs a step on the rows of all ranks, which call it together; gives what it says of the last of them.
///
/// # Errors
/// Those of the step and of the disk on any rank; [`Error::Limit`] where the memory holds no row with those around it.
pub fn run<T>(
    work: &LocalWork,
    landscape: &mut StoredLandscape<'_>,
    job: &Job<'_>,
    on_rows: OnRows<'_, T>,
) -> Result<Option<T>, Error> {
    let ranks = Arc::clone(&landscape.ranks);
    let margin = work.reach.rows(landscape.domain.cell);
    for name in &work.reads {
        swap_margins(&mut [&mut landscape.layer_mut(name)?.plane], margin, &*ranks)?;
    }
    landscape.valid_around(margin)?;
    let wanted = work.writes.iter().filter(|name| landscape.wants(name));
    let mut made =
        wanted.map(|name| Ok((name.as_str(), landscape.plane(name)?))).collect::<Result<Vec<_>, Error>>()?;
    let mut bands = Bands { work, on_rows, landscape, margin, units: Vec::new() };
    let said = agreed(&*ranks, bands.run(&mut made, job))?;
    let units = ranks.tell(bands.units.join("\n").into_bytes())?;
    let units = String::from_utf8_lossy(&units).into_owned();
    for ((name, plane), unit) in made.into_iter().zip(units.split('\n')) {
        landscape.insert(name, unit, plane);
    }
    Ok(said)
}

/// A step on its way over the rows of this rank.
struct Bands<'a, 'b, T> {
    work: &'a LocalWork,
    on_rows: OnRows<'a, T>,
    landscape: &'a StoredLandscape<'b>,
    /// Rows around each that it looks at.
    margin: usize,
    /// Units of the layers that are made, once they are known.
    units: Vec<String>,
}

impl<T> Bands<'_, '_, T> {
    fn run(&mut self, made: &mut [(&str, StoredPlane)], job: &Job<'_>) -> Result<Option<T>, Error> {
        let (own, height) = (self.landscape.rows().own(), self.height()?);
        let mut said = None;
        for first in own.clone().step_by(height) {
            let rows = first..(first + height).min(own.end);
            said = Some(self.some_rows(rows.clone(), made)?);
            job.watcher.progress((rows.end - own.start) as u64, own.len() as u64, 0);
            if job.watcher.cancelled() {
                let all = self.landscape.domain.size.rows;
                return Err(Error::Interrupted(format!("interrupted in row {first} of {all}")));
            }
        }
        Ok(said)
    }

    /// Rows that the memory holds at a time, with those around them.
    fn height(&self) -> Result<usize, Error> {
        let (columns, memory) = (self.landscape.domain.size.columns as u64, self.landscape.memory);
        // A layer that is written is there twice, as it comes and as it was.
        let layers = (self.work.reads.len() + 2 * self.work.writes.len() + 2) as u64;
        let row = columns * (VALUE * layers + self.work.bytes_per_cell);
        let rows = usize::try_from(memory / row.max(1)).unwrap_or(usize::MAX);
        match rows.saturating_sub(2 * self.margin).min(MOST_ROWS) {
            0 => {
                let needed = row * (2 * self.margin as u64 + 1);
                let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory);
                let subject = format!("a row of {columns} columns with {} on either side", self.margin);
                Err(limit.of(subject).remedy("allow more memory").into())
            }
            rows => Ok(rows),
        }
    }

    fn some_rows(&mut self, rows: Range<usize>, made: &mut [(&str, StoredPlane)]) -> Result<T, Error> {
        let Size { columns, rows: all } = self.landscape.domain.size;
        let held = rows.start.saturating_sub(self.margin)..(rows.end + self.margin).min(all);
        let size = Size { columns, rows: held.len() };
        let valid = self.landscape.valid_rows(held.clone())?;
        let mut part = Landscape::new(Domain { size, valid, ..self.landscape.domain.clone() });
        for name in &self.work.reads {
            let layer = self.landscape.layer(name)?;
            part.insert(name, &layer.unit, Field::from_values(size, layer.plane.rows(held.clone())?));
        }
        let said = (self.on_rows)(&mut part)?;
        let inner = (rows.start - held.start) * columns..(rows.end - held.start) * columns;
        self.units.clear();
        for (name, plane) in made {
            let layer = part.layer(name)?;
            plane.set_rows(rows.clone(), &layer.field.values()[inner.clone()])?;
            self.units.push(layer.unit.clone());
        }
        Ok(said)
    }
}
