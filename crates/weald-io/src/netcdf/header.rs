//! The header: dimensions, attributes, and where each variable lies in the file.

use std::collections::BTreeSet;

use super::super::Fault;
use super::super::cf::{Attribute, Attributes};
use super::cursor::Cursor;
use super::kind::{CHARACTER, DOUBLE, FLOAT, Kind, tag};
use weald_core::error::{Limit, Quantity};

/// Most numbers of one attribute that are kept; longer ones are read past.
const MAX_NUMBERS: usize = 1 << 16;

/// What a header says.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) dimensions: Vec<Dimension>,
    pub(super) attributes: Attributes,
    pub(super) variables: Vec<Variable>,
}

#[derive(Clone, Debug)]
pub(super) struct Dimension {
    pub(super) name: String,
    /// Its length; the number of records for that which may grow.
    pub(super) length: usize,
    is_record: bool,
}

/// A variable and its bytes.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    /// Positions in the list of dimensions.
    pub(super) dimensions: Vec<usize>,
    pub(super) attributes: Attributes,
    pub(super) kind: Kind,
    /// Position of its first byte.
    pub(super) begin: u64,
    /// Numbers in one record, or in all where it has none.
    pub(super) record: usize,
    /// Records; 1 for a variable that has none.
    pub(super) records: usize,
    /// Bytes from one record to the next.
    pub(super) stride: u64,
}

impl Header {
    /// # Errors
    /// [`Fault::Damaged`] for a header that is cut off or contradicts itself or the length of the file.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, Fault> {
        let version = version(bytes)?;
        let mut cursor = Cursor::new(bytes, version == 5);
        let records = cursor.count().map_err(|_| {
            Fault::damaged(
                "the number of records was never written; `nccopy` mends a file that a program still held",
            )
        })?;
        let dimensions = list(&mut cursor, tag::DIMENSIONS, |cursor| Dimension::of(cursor, records))?;
        let attributes = attributes(&mut cursor)?;
        let mut variables =
            list(&mut cursor, tag::VARIABLES, |cursor| Variable::of(cursor, version, &dimensions))?;
        ensure_names_differ(&variables)?;
        lay_out_records(&mut variables, &dimensions)?;
        for variable in &variables {
            variable.ensure_within(bytes.len())?;
        }
        Ok(Self { dimensions, attributes, variables })
    }
}

fn version(bytes: &[u8]) -> Result<u8, Fault> {
    match bytes {
        [b'C', b'D', b'F', version @ (1 | 2 | 5), ..] => Ok(*version),
        [0x89, b'H', b'D', b'F', ..] => Err(Fault::damaged(
            "a NetCDF-4 file, which is HDF5; the classic format is read: nccopy -k classic in.nc out.nc, or with \
             xarray ds.to_netcdf(path, format='NETCDF3_CLASSIC')",
        )),
        _ => Err(Fault::damaged("the file does not begin with CDF and 1, 2 or 5, as classic NetCDF does")),
    }
}

/// A list with its tag and its count. Nothing is allocated for a count; each entry takes bytes of the file.
fn list<'a, T>(
    cursor: &mut Cursor<'a>,
    wanted: u32,
    entry: impl Fn(&mut Cursor<'a>) -> Result<T, Fault>,
) -> Result<Vec<T>, Fault> {
    let (found, count) = (cursor.word()?, cursor.count()?);
    if found != wanted && (found, count) != (tag::ABSENT, 0) {
        return Err(Fault::damaged(format!(
            "tag {found} with {count} entries before byte {}, where a list with tag {wanted} belongs",
            cursor.at()
        )));
    }
    (0..count).map(|_| entry(cursor)).collect()
}

impl Dimension {
    fn of(cursor: &mut Cursor<'_>, records: usize) -> Result<Self, Fault> {
        let (name, length) = (cursor.name()?, cursor.count()?);
        let is_record = length == 0;
        Ok(Self { name, length: if is_record { records } else { length }, is_record })
    }
}

fn attributes(cursor: &mut Cursor<'_>) -> Result<Attributes, Fault> {
    list(cursor, tag::ATTRIBUTES, attribute).map(Attributes)
}

fn attribute(cursor: &mut Cursor<'_>) -> Result<(String, Attribute), Fault> {
    let (name, kind, count) = (cursor.name()?, Kind::of(cursor.word()?)?, cursor.count()?);
    let length = count.checked_mul(kind.number.bytes).ok_or_else(|| {
        Fault::damaged(format!("attribute `{name}` claims {count} numbers of {} bytes", kind.number.bytes))
    })?;
    let bytes = cursor.padded(length)?;
    let numbers = || bytes.chunks_exact(kind.number.bytes).take(MAX_NUMBERS).map(|bytes| kind.value(bytes));
    let value = match kind.code {
        CHARACTER => Attribute::Text(String::from_utf8_lossy(bytes).into_owned()),
        FLOAT if count == 1 => Attribute::Float(kind.value(bytes) as f32),
        FLOAT | DOUBLE => Attribute::Doubles(numbers().collect()),
        _ => Attribute::of_whole(numbers().collect()),
    };
    Ok((name, value))
}

impl Variable {
    fn of(cursor: &mut Cursor<'_>, version: u8, dimensions: &[Dimension]) -> Result<Self, Fault> {
        let name = cursor.name()?;
        let rank = cursor.count()?;
        let axes: Vec<usize> = (0..rank).map(|_| cursor.count()).collect::<Result<_, _>>()?;
        let attributes = attributes(cursor)?;
        let mut kind = Kind::of(cursor.word()?)?;
        if attributes.text("_Unsigned").is_some_and(|text| text == "true") {
            kind = kind.unsigned();
        }
        // The size that the file states follows from the dimensions, and some writers state another.
        cursor.pass_count()?;
        let begin = if version == 1 { u64::from(cursor.word()?) } else { cursor.long()? };
        let (record, records) = numbers(&name, &axes, dimensions)?;
        Ok(Self { name, dimensions: axes, attributes, kind, begin, record, records, stride: 0 })
    }

    /// Bytes of one record, or of all.
    fn record_bytes(&self) -> Result<u64, Fault> {
        (self.record as u64).checked_mul(self.kind.number.bytes as u64).ok_or_else(|| too_large(&self.name))
    }

    fn is_record(&self, dimensions: &[Dimension]) -> bool {
        self.dimensions.first().is_some_and(|axis| dimensions[*axis].is_record)
    }

    /// Whether all of it is in the file.
    fn ensure_within(&self, length: usize) -> Result<(), Fault> {
        let before_last = self.stride.checked_mul(self.records.saturating_sub(1) as u64);
        let last = if self.records == 0 { Some(0) } else { Some(self.record_bytes()?) };
        let end = before_last.zip(last).and_then(|(before, last)| {
            before.checked_add(last)?.checked_add(if self.records == 0 { 0 } else { self.begin })
        });
        match end {
            Some(end) if end <= length as u64 => Ok(()),
            _ => Err(Fault::damaged(format!(
                "`{}` of {} × {} numbers begins at byte {} and does not end within the {length} bytes of the \
                 file; it is cut off or damaged",
                self.name, self.records, self.record, self.begin
            ))),
        }
    }
}

/// Variables are found by their names.
fn ensure_names_differ(variables: &[Variable]) -> Result<(), Fault> {
    let mut names = BTreeSet::new();
    match variables.iter().find(|variable| !names.insert(variable.name.as_str())) {
        Some(variable) => Err(Fault::damaged(format!("two variables are called `{}`", variable.name))),
        None => Ok(()),
    }
}

fn too_large(name: &str) -> Fault {
    let limit = Limit::new(Quantity::Numbers, None, 0..=usize::MAX as u64).of(format!("`{name}`"));
    limit.remedy("no file holds so many, so it is damaged").into()
}

/// Numbers in a record, and records.
fn numbers(name: &str, axes: &[usize], dimensions: &[Dimension]) -> Result<(usize, usize), Fault> {
    let (mut record, mut records) = (1_usize, 1);
    for (position, axis) in axes.iter().enumerate() {
        let dimension = dimensions.get(*axis).ok_or_else(|| {
            Fault::damaged(format!("`{name}` has dimension {axis}, but there are {}", dimensions.len()))
        })?;
        match (dimension.is_record, position) {
            (false, _) => record = record.checked_mul(dimension.length).ok_or_else(|| too_large(name))?,
            (true, 0) => records = dimension.length,
            (true, _) => {
                let what = format!("`{name}` grows along a dimension that is not its first");
                return Err(Fault::damaged(what));
            }
        }
    }
    Ok((record, records))
}

/// One record of each variable that has records lies after the other, each padded to four bytes; a variable that
/// is alone is not padded.
fn lay_out_records(variables: &mut [Variable], dimensions: &[Dimension]) -> Result<(), Fault> {
    let (mut sum, mut alone, mut count) = (0_u64, 0, 0);
    for variable in variables.iter().filter(|variable| variable.is_record(dimensions)) {
        alone = variable.record_bytes()?;
        let padded = alone.checked_next_multiple_of(4);
        sum = padded.and_then(|padded| sum.checked_add(padded)).ok_or_else(|| too_large(&variable.name))?;
        count += 1;
    }
    let stride = if count == 1 { alone } else { sum };
    for variable in variables.iter_mut().filter(|variable| variable.is_record(dimensions)) {
        variable.stride = stride;
    }
    Ok(())
}
