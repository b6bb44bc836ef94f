//! Planes whose rows lie with the ranks, as the first rank reads them to write a file: a window at a time, so that it never
//! holds the whole.
//!
//! The first rank says what it wants, and all give or take what of it lies in their own rows.

use std::cell::RefCell;
use std::ops::Range;

use crate::ranks::{Ranks, Reader, SharedRows, Writer, agreed};
use crate::stored::{StoredLandscape, StoredPlane};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::plane::{Plane, Window};

/// What the first rank wants of all.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Request {
    /// A new plane of zeros.
    Make(Size),
    /// What lies in a window of a plane.
    Read(usize, Window),
    /// What lies there is replaced by the values that follow.
    Write(usize, Window),
    /// Nothing more.
    End,
}

impl Request {
    fn message(&self) -> Writer {
        let mut writer = Writer::default();
        let window = |writer: &mut Writer, kind: usize, plane: usize, Window { columns, rows }: &Window| {
            writer.counts(&[kind, plane, columns.start, columns.end, rows.start, rows.end]);
        };
        match self {
            Self::End => writer.count(0),
            Self::Make(Size { columns, rows }) => writer.counts(&[1, *columns, *rows]),
            Self::Read(plane, of) => window(&mut writer, 2, *plane, of),
            Self::Write(plane, of) => window(&mut writer, 3, *plane, of),
        }
        writer
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        let kind = reader.count()?;
        if kind == 0 {
            return Ok(Self::End);
        }
        let first = reader.count()?;
        if kind == 1 {
            return Ok(Self::Make(Size { columns: first, rows: reader.count()? }));
        }
        let columns = reader.count()?..reader.count()?;
        let window = Window { columns, rows: reader.count()?..reader.count()? };
        Ok(if kind == 2 { Self::Read(first, window) } else { Self::Write(first, window) })
    }
}

/// Makes a plane of zeros, whose rows lie with the ranks as well.
pub type MakePlane<'a> = &'a dyn Fn(Size) -> Result<Box<dyn Plane<f32> + 'a>, Error>;

/// Lets `work` read planes on the first rank, and make and use others of any size; the other ranks serve it. All ranks call
/// it together; what `work` gives is there on the first alone.
///
/// # Errors
/// Those of `work`, and of the disk of any rank, on all.
pub fn served<T>(
    landscape: &StoredLandscape<'_>,
    given: &[&StoredPlane],
    work: impl FnOnce(&[&dyn Plane<f32>], MakePlane<'_>) -> Result<T, Error>,
) -> Result<Option<T>, Error> {
    let ranks = &*landscape.ranks;
    if ranks.count() == 1 {
        let make = |size: Size| {
            let rows = SharedRows::of((0, 1), size.rows);
            let plane = landscape.plane_alone("smaller image", (size.columns, &rows))?;
            Ok(Box::new(plane) as Box<dyn Plane<f32> + '_>)
        };
        let given: Vec<_> = given.iter().map(|&plane| plane as &dyn Plane<f32>).collect();
        return work(&given, &make).map(Some);
    }
    let planes = RefCell::new(Planes { landscape, given, made: Vec::new() });
    if !ranks.leads() {
        return agreed(ranks, serve(ranks, &planes)).map(|()| None);
    }
    let of = |number: usize, size: Size| Served { ranks, planes: &planes, number, size };
    let make = |size: Size| {
        ask(ranks, &planes, &Request::Make(size), &[])?;
        let number = given.len() + planes.borrow().made.len() - 1;
        Ok(Box::new(of(number, size)) as Box<dyn Plane<f32> + '_>)
    };
    let read: Vec<_> = given.iter().enumerate().map(|(number, plane)| of(number, plane.size())).collect();
    let read: Vec<_> = read.iter().map(|plane| plane as &dyn Plane<f32>).collect();
    let done = work(&read, &make);
    ranks.tell(Request::End.message().0)?;
    agreed(ranks, done.map(Some))
}

/// This rank's rows of the planes that are served.
struct Planes<'a> {
    landscape: &'a StoredLandscape<'a>,
    given: &'a [&'a StoredPlane],
    made: Vec<StoredPlane>,
}

impl Planes<'_> {
    /// Does what is wanted of this rank; gives the values that are asked for.
    fn answer(&mut self, request: &Request, values: &mut Reader<'_>) -> Result<Vec<f32>, Error> {
        match request {
            Request::Make(size) => {
                let ranks = &self.landscape.ranks;
                let rows = SharedRows::of((ranks.rank(), ranks.count()), size.rows);
                self.made.push(self.landscape.plane_alone("smaller image", (size.columns, &rows))?);
                Ok(Vec::new())
            }
            Request::Read(number, window) => {
                let made = number.checked_sub(self.given.len()).and_then(|made| self.made.get(made));
                let given = || self.given.get(*number).copied();
                let plane = made.or_else(given).ok_or_else(missing)?;
                let rows = common(&plane.own(), &window.rows);
                let part = Window { columns: window.columns.clone(), rows };
                if part.rows.is_empty() { Ok(Vec::new()) } else { plane.read(&part) }
            }
            Request::Write(number, window) => {
                let made = number.checked_sub(self.given.len()).and_then(|made| self.made.get_mut(made));
                let plane = made.ok_or_else(missing)?;
                let mut all = vec![0.0; window.size().cells()];
                values.singles(&mut all)?;
                let (rows, columns) = (common(&plane.own(), &window.rows), window.columns.len());
                if rows.is_empty() {
                    return Ok(Vec::new());
                }
                let cells =
                    (rows.start - window.rows.start) * columns..(rows.end - window.rows.start) * columns;
                let part = Window { columns: window.columns.clone(), rows };
                plane.write(&part, &all[cells]).map(|()| Vec::new())
            }
            Request::End => Ok(Vec::new()),
        }
    }
}

fn missing() -> Error {
    Error::Run("a plane was asked for that was never made".to_owned())
}

/// Serves the first rank until that wants nothing more.
fn serve(ranks: &dyn Ranks, planes: &RefCell<Planes<'_>>) -> Result<(), Error> {
    loop {
        let message = ranks.tell(Vec::new())?;
        let mut reader = Reader(&message);
        let request = Request::read(&mut reader)?;
        if request == Request::End {
            return Ok(());
        }
        let answer = planes.borrow_mut().answer(&request, &mut reader);
        ranks.collect(said(answer), &mut |_, _| Ok(()))?;
    }
}

/// Asks all ranks for something; gives what they have, from north to south.
fn ask(
    ranks: &dyn Ranks,
    planes: &RefCell<Planes<'_>>,
    request: &Request,
    values: &[f32],
) -> Result<Vec<f32>, Error> {
    let mut message = request.message();
    message.singles(values);
    ranks.tell(message.0)?;
    let mut bytes = Writer::default();
    bytes.singles(values);
    let own = planes.borrow_mut().answer(request, &mut Reader(&bytes.0));
    let (mut all, mut failed) = (Vec::new(), None);
    ranks.collect(said(own), &mut |rank, message| {
        match message.split_first() {
            Some((0, values)) => {
                let first = all.len();
                all.resize(first + values.len() / size_of::<f32>(), 0.0);
                Reader(values).singles(&mut all[first..])?;
            }
            told => {
                let text = told.map(|(_, text)| String::from_utf8_lossy(text).into_owned());
                failed = failed.take().or(Some(format!("rank {rank}: {}", text.unwrap_or_default())));
            }
        }
        Ok(())
    })?;
    failed.map_or(Ok(all), |text| Err(Error::Run(text)))
}

/// An answer as a message.
fn said(answer: Result<Vec<f32>, Error>) -> Vec<u8> {
    match answer {
        Ok(values) => {
            let mut writer = Writer(vec![0]);
            writer.singles(&values);
            writer.0
        }
        Err(error) => [vec![1], error.to_string().into_bytes()].concat(),
    }
}

/// A plane as the first rank sees it.
struct Served<'a, 'b> {
    ranks: &'a dyn Ranks,
    planes: &'a RefCell<Planes<'b>>,
    number: usize,
    size: Size,
}

impl Plane<f32> for Served<'_, '_> {
    fn size(&self) -> Size {
        self.size
    }

    fn read(&self, window: &Window) -> Result<Vec<f32>, Error> {
        ask(self.ranks, self.planes, &Request::Read(self.number, window.clone()), &[])
    }

    fn write(&mut self, window: &Window, values: &[f32]) -> Result<(), Error> {
        ask(self.ranks, self.planes, &Request::Write(self.number, window.clone()), values).map(drop)
    }
}

fn common(own: &Range<usize>, wanted: &Range<usize>) -> Range<usize> {
    own.start.max(wanted.start)..own.end.min(wanted.end)
}
