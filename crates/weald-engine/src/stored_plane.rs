//! A plane of which this process has some rows, on disk or in memory, and for a while those around them.

use std::ops::Range;

use crate::ranks::{Ranks, Reader, SharedRows, Writer, agreed};
use weald_core::error::Error;
use weald_core::file_plane::{AT_ONCE, FilePlane, VALUE};
use weald_core::files::File;
use weald_core::grid::Size;
use weald_core::plane::{HeldPlane, Plane, Window};

/// Where the values of a plane lie.
#[derive(Debug)]
enum Values {
    Disk(FilePlane),
    Memory(HeldPlane<f32>),
}

/// A plane of the size of a grid, of which this process has its [own rows](SharedRows::own). Rows are counted in the whole.
#[derive(Debug)]
pub struct StoredPlane {
    columns: usize,
    rows: SharedRows,
    own: Values,
    /// Copies of rows of the neighbours, right to the north and to the south.
    north: Vec<f32>,
    south: Vec<f32>,
}

impl StoredPlane {
    /// A plane of zeros in an empty file, or in memory; `name` is for messages.
    ///
    /// # Errors
    /// As [`FilePlane::new`].
    pub fn new(name: &str, file: Option<File>, (columns, rows): (usize, &SharedRows)) -> Result<Self, Error> {
        let size = Size { columns, rows: rows.own().len() };
        let own = match file {
            Some(file) => Values::Disk(FilePlane::new(name, file, size)?),
            None => Values::Memory(HeldPlane::new(size, vec![0.0; size.cells()])),
        };
        Ok(Self { columns, rows: rows.clone(), own, north: Vec::new(), south: Vec::new() })
    }

    /// Its own rows.
    pub fn own(&self) -> Range<usize> {
        self.rows.own()
    }

    /// Columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// How rows are shared.
    pub fn shared(&self) -> &SharedRows {
        &self.rows
    }

    /// Whether another plane has the same grid, whose rows are shared alike.
    pub fn is_shared_as(&self, other: &Self) -> bool {
        (self.columns, &self.rows) == (other.columns, &other.rows)
    }

    /// The values of whole rows.
    ///
    /// # Errors
    /// As [`Plane::read`].
    pub fn rows(&self, rows: Range<usize>) -> Result<Vec<f32>, Error> {
        self.read(&Window { columns: 0..self.columns, rows })
    }

    /// Replaces the values of whole rows of its own.
    ///
    /// # Errors
    /// As [`Plane::write`].
    pub fn set_rows(&mut self, rows: Range<usize>, values: &[f32]) -> Result<(), Error> {
        self.write(&Window { columns: 0..self.columns, rows }, values)
    }

    /// Its own rows in runs from north to south that are worth reading at a time.
    pub fn runs_of_rows(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let (own, run) = (self.own(), (AT_ONCE / (VALUE as usize * self.columns)).max(1));
        own.clone().step_by(run).map(move |first| first..(first + run).min(own.end))
    }

    /// Cells that it holds of its own and of its neighbours.
    pub fn held_cells(&self) -> usize {
        self.own().len() * self.columns + self.north.len() + self.south.len()
    }

    /// The rows of the northern neighbour, which it holds no longer then.
    pub fn take_north(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.north)
    }

    /// Rows around its own that it holds.
    fn held(&self) -> Range<usize> {
        let own = self.own();
        own.start - self.north.len() / self.columns..own.end + self.south.len() / self.columns
    }

    fn read_own(&self, columns: &Range<usize>, rows: Range<usize>) -> Result<Vec<f32>, Error> {
        let first = self.own().start;
        let window = Window { columns: columns.clone(), rows: rows.start - first..rows.end - first };
        match &self.own {
            Values::Disk(plane) => plane.read(&window),
            Values::Memory(plane) => plane.read(&window),
        }
    }

    /// The first or the last of its own rows, as many as `margin`, for a neighbour.
    fn border(&self, is_north: bool, margin: usize, into: &mut Writer) -> Result<(), Error> {
        let own = self.own();
        let rows = if is_north { own.start..own.start + margin } else { own.end - margin..own.end };
        self.rows(rows).map(|values| into.singles(&values))
    }
}

/// Gets so many rows around its own from the neighbours, as far as the grid goes, for each of these planes, whose rows are
/// shared alike. All ranks call it together.
///
/// # Errors
/// Those of the disk on any rank; [`Error::Run`] where a rank has fewer rows, or where another can no longer be reached.
pub fn swap_margins(planes: &mut [&mut StoredPlane], margin: usize, ranks: &dyn Ranks) -> Result<(), Error> {
    let Some(first) = planes.first() else { return Ok(()) };
    let (rows, columns) = (first.rows.clone(), first.columns);
    if rows.is_whole() {
        return Ok(());
    }
    if margin > rows.least() {
        let least = rows.least();
        return Err(Error::Run(format!(
            "ranks of {least} rows have not the {margin} around them that their neighbours need; run over fewer ranks"
        )));
    }
    let sides = [(true, rows.north()), (false, rows.south())];
    let sides: Vec<_> = sides.into_iter().filter_map(|(is_north, with)| Some((is_north, with?))).collect();
    let given = sides.iter().map(|&(is_north, with)| {
        let mut writer = Writer::default();
        let written = planes.iter().try_for_each(|plane| plane.border(is_north, margin, &mut writer));
        written.map(|()| (with, writer.0))
    });
    let given = agreed(ranks, given.collect::<Result<Vec<_>, _>>())?;
    let taken = if given.is_empty() { Vec::new() } else { ranks.trade(given)? };
    for ((is_north, _), message) in sides.into_iter().zip(taken) {
        let mut reader = Reader(&message);
        for plane in &mut *planes {
            let side = if is_north { &mut plane.north } else { &mut plane.south };
            side.resize(margin * columns, 0.0);
            reader.singles(side)?;
        }
    }
    Ok(())
}

impl Plane<f32> for StoredPlane {
    fn size(&self) -> Size {
        Size { columns: self.columns, rows: self.rows.count() }
    }

    fn read(&self, window: &Window) -> Result<Vec<f32>, Error> {
        let (own, held, Window { columns, rows }) = (self.own(), self.held(), window);
        if rows.start < held.start || rows.end > held.end {
            return Err(Error::Run(format!(
                "rows {rows:?} of a plane were asked for where {held:?} are held"
            )));
        }
        let of_copy = |copy: &[f32], first: usize, rows: Range<usize>, values: &mut Vec<f32>| {
            for y in rows {
                values.extend_from_slice(&copy[(y - first) * self.columns..][columns.clone()]);
            }
        };
        let (north, south) = (rows.start..rows.end.min(own.start), rows.start.max(own.end)..rows.end);
        let inner = rows.start.max(own.start)..rows.end.min(own.end);
        if north.is_empty() && south.is_empty() {
            return self.read_own(columns, inner);
        }
        let mut values = Vec::with_capacity(window.size().cells());
        of_copy(&self.north, held.start, north, &mut values);
        if !inner.is_empty() {
            values.extend(self.read_own(columns, inner)?);
        }
        of_copy(&self.south, own.end, south, &mut values);
        Ok(values)
    }

    fn write(&mut self, window: &Window, values: &[f32]) -> Result<(), Error> {
        let (own, Window { columns, rows }) = (self.own(), window);
        if rows.start < own.start || rows.end > own.end {
            return Err(Error::Run(format!("rows {rows:?} of a plane were to be written where {own:?} are")));
        }
        let window = Window { columns: columns.clone(), rows: rows.start - own.start..rows.end - own.start };
        match &mut self.own {
            Values::Disk(plane) => plane.write(&window, values),
            Values::Memory(plane) => plane.write(&window, values),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::ranks_in_threads;

    #[test]
    fn ranks_read_the_rows_around_theirs_as_they_were_when_they_were_swapped() {
        let (columns, count, ring) = (5, 3, 1);
        let work = |ranks: &dyn Ranks| {
            let rows = SharedRows::of((ranks.rank(), count), 200).ringed(ring);
            let value = |x: usize, y: usize, plane: usize| (1000 * plane + 10 * y + x) as f32;
            let mut planes: Vec<_> = (0..2)
                .map(|number| {
                    let file = (number == 1).then(|| {
                        let path = std::env::temp_dir().join(format!(
                            "weald-rows-{}-{}",
                            std::process::id(),
                            ranks.rank()
                        ));
                        let file = File::options().read(true).write(true).create_new(true).open(&path);
                        std::fs::remove_file(&path).expect("it needs no name");
                        file.expect("a file")
                    });
                    let mut plane = StoredPlane::new("test", file, (columns, &rows)).expect("room");
                    for run in plane.runs_of_rows() {
                        let cells = run.clone().flat_map(|y| (0..columns).map(move |x| value(x, y, number)));
                        let cells: Vec<_> = cells.collect();
                        plane.set_rows(run, &cells).expect("room");
                    }
                    plane
                })
                .collect();
            let [first, second] = &mut planes[..] else { unreachable!("two planes") };
            swap_margins(&mut [first, second], 7, ranks).expect("all are there");
            let own = rows.own();
            for (number, plane) in planes.iter_mut().enumerate() {
                let zeros = vec![0.0; own.len() * columns];
                plane.set_rows(own.clone(), &zeros).expect("room");
                let held = own.start.saturating_sub(7)..(own.end + 7).min(rows.count());
                assert_eq!(plane.held(), held);
                let window = Window { columns: 1..4, rows: held.clone() };
                let expected = held.flat_map(|y| {
                    let is_own = own.contains(&y);
                    (1..4).map(move |x| if is_own { 0.0 } else { value(x, y, number) })
                });
                assert_eq!(plane.read(&window).expect("held"), expected.collect::<Vec<_>>());
                assert!(plane.rows(own.start..own.end + 8).is_err(), "more than it holds");
                assert!(plane.set_rows(own.end..own.end + 1, &[0.0; 5]).is_err(), "not its own");
            }
            let [first, _] = &mut planes[..] else { unreachable!("two planes") };
            swap_margins(&mut [first], 67, ranks).expect_err("there are 66 rows").to_string()
        };
        std::thread::scope(|scope| {
            let running: Vec<_> =
                ranks_in_threads(count).into_iter().map(|ranks| scope.spawn(move || work(&*ranks))).collect();
            for rank in running {
                assert!(rank.join().expect("as expected").contains("fewer ranks"));
            }
        });
    }
}
