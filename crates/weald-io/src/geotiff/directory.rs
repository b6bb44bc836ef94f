//! The first tag directory of a TIFF or `BigTIFF` file, in either byte order.
//!
//! Nothing is copied until a tag is asked for, and a tag's values must lie within the file, so what is
//! allocated is at most eight times the file.

use super::super::Fault;

/// Numbers of the TIFF tags and codes that are read or written.
pub(super) mod tag {
    pub(in super::super) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(in super::super) const IMAGE_WIDTH: u16 = 256;
    pub(in super::super) const IMAGE_LENGTH: u16 = 257;
    pub(in super::super) const BITS_PER_SAMPLE: u16 = 258;
    pub(in super::super) const COMPRESSION: u16 = 259;
    pub(in super::super) const PHOTOMETRIC: u16 = 262;
    pub(in super::super) const FILL_ORDER: u16 = 266;
    pub(in super::super) const IMAGE_DESCRIPTION: u16 = 270;
    pub(in super::super) const STRIP_OFFSETS: u16 = 273;
    pub(in super::super) const SAMPLES_PER_PIXEL: u16 = 277;
    pub(in super::super) const ROWS_PER_STRIP: u16 = 278;
    pub(in super::super) const STRIP_BYTE_COUNTS: u16 = 279;
    pub(in super::super) const PLANAR_CONFIGURATION: u16 = 284;
    pub(in super::super) const SOFTWARE: u16 = 305;
    pub(in super::super) const PREDICTOR: u16 = 317;
    pub(in super::super) const TILE_WIDTH: u16 = 322;
    pub(in super::super) const TILE_LENGTH: u16 = 323;
    pub(in super::super) const TILE_OFFSETS: u16 = 324;
    pub(in super::super) const TILE_BYTE_COUNTS: u16 = 325;
    pub(in super::super) const SAMPLE_FORMAT: u16 = 339;
    pub(in super::super) const MODEL_PIXEL_SCALE: u16 = 33550;
    pub(in super::super) const MODEL_TIE_POINT: u16 = 33922;
    pub(in super::super) const MODEL_TRANSFORMATION: u16 = 34264;
    pub(in super::super) const GEO_KEY_DIRECTORY: u16 = 34735;
    pub(in super::super) const GEO_DOUBLE_PARAMETERS: u16 = super::super::super::geokeys::DOUBLES;
    pub(in super::super) const GEO_ASCII_PARAMETERS: u16 = 34737;
    pub(in super::super) const GDAL_METADATA: u16 = 42112;
    pub(in super::super) const GDAL_NO_DATA: u16 = 42113;

    /// Deflate in a zlib stream, the code that Adobe registered.
    pub(in super::super) const DEFLATE: u16 = 8;
    /// Predictor that stores differences of numbers.
    pub(in super::super) const HORIZONTAL_PREDICTOR: u16 = 2;
    /// Predictor that splits floats into bytes, most significant first, and stores their differences.
    pub(in super::super) const FLOATING_POINT_PREDICTOR: u16 = 3;
}

/// Byte order of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

impl Order {
    /// The number in 1 to 8 bytes.
    pub(super) fn number(self, bytes: &[u8]) -> u64 {
        let join = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        match self {
            Self::Little => bytes.iter().rev().fold(0, join),
            Self::Big => bytes.iter().fold(0, join),
        }
    }
}

impl Order {
    /// Puts a number into 1 to 8 bytes.
    fn put(self, bytes: &mut [u8], number: u64) {
        let width = bytes.len();
        match self {
            Self::Little => bytes.copy_from_slice(&number.to_le_bytes()[..width]),
            Self::Big => bytes.copy_from_slice(&number.to_be_bytes()[8 - width..]),
        }
    }
}

/// One tag: type of the values, their count, and their bytes in the file.
#[derive(Debug)]
struct Entry<'a> {
    tag: u16,
    kind: u16,
    /// `None` where the values lie outside the file: an error only for a tag that is asked for.
    values: Option<&'a [u8]>,
}

/// The tags of the first image of a file.
#[derive(Debug)]
pub(super) struct Directory<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) order: Order,
    widths: &'static Widths,
    entries: Vec<Entry<'a>>,
    /// Where the next directory lies; 0 behind the last.
    next: u64,
}

/// More than any pyramid of overviews has; it also ends a chain that runs in a cycle.
const MAX_DIRECTORIES: usize = 64;

/// Widths of the fields that differ between TIFF and `BigTIFF`.
#[derive(Debug)]
struct Widths {
    entries: usize,
    offset: usize,
    first: usize,
}

static CLASSIC: Widths = Widths { entries: 2, offset: 4, first: 4 };
static BIG: Widths = Widths { entries: 8, offset: 8, first: 8 };

const ASCII: u16 = 2;
const FLOAT: u16 = 11;
const DOUBLE: u16 = 12;

impl<'a> Directory<'a> {
    /// Finds the first directory.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, Fault> {
        let (order, widths) = header(bytes)?;
        let start = order.number(field(bytes, widths.first as u64, widths.offset)?);
        Self::at(bytes, order, widths, start)
    }

    fn at(bytes: &'a [u8], order: Order, widths: &'static Widths, start: u64) -> Result<Self, Fault> {
        let count = order.number(field(bytes, start, widths.entries)?);
        let entry_width = 4 + 2 * widths.offset;
        let Some(length) = (count as usize).checked_mul(entry_width) else {
            return Err(Fault::damaged(format!("the directory at byte {start} claims {count} tags")));
        };
        let first = start + widths.entries as u64;
        let table = field(bytes, first, length)?;
        let entries = table.chunks_exact(entry_width).map(|row| entry(bytes, order, row)).collect();
        let next = field(bytes, first + length as u64, widths.offset).map_or(0, |next| order.number(next));
        Ok(Self { bytes, order, widths, entries, next })
    }

    /// The directories of the images behind the first one: overviews and masks. Damage among them ends the
    /// list, since the first image is whole without them.
    pub(super) fn others(&self) -> impl Iterator<Item = Self> {
        std::iter::successors(self.next(), Self::next).take(MAX_DIRECTORIES)
    }

    fn next(&self) -> Option<Self> {
        (self.next != 0).then(|| Self::at(self.bytes, self.order, self.widths, self.next).ok())?
    }

    fn find(&self, tag: u16) -> Result<Option<(u16, &'a [u8])>, Fault> {
        let Some(entry) = self.entries.iter().find(|entry| entry.tag == tag) else { return Ok(None) };
        let values = entry.values.ok_or_else(|| {
            Fault::damaged(format!(
                "the values of tag {tag} lie outside the file of {} bytes; the file is truncated or damaged",
                self.bytes.len()
            ))
        })?;
        Ok(Some((entry.kind, values)))
    }

    /// The whole numbers of a tag.
    pub(super) fn numbers(&self, tag: u16) -> Result<Option<Vec<u64>>, Fault> {
        let Some((kind, values)) = self.find(tag)? else { return Ok(None) };
        let width = match kind {
            1 => 1,
            3 => 2,
            4 | 13 => 4,
            16 | 18 => 8,
            _ => return Err(wrong_type(tag, kind, "whole numbers")),
        };
        Ok(Some(values.chunks_exact(width).map(|number| self.order.number(number)).collect()))
    }

    /// The first whole number of a tag.
    pub(super) fn number(&self, tag: u16) -> Result<Option<u64>, Fault> {
        match self.numbers(tag)?.map(|numbers| numbers.first().copied()) {
            None => Ok(None),
            Some(Some(number)) => Ok(Some(number)),
            Some(None) => Err(Fault::damaged(format!("tag {tag} is empty, but must hold a number"))),
        }
    }

    /// The first whole number of a tag that the file must have.
    pub(super) fn needed(&self, tag: u16) -> Result<u64, Fault> {
        self.number(tag)?.ok_or_else(|| Fault::damaged(format!("tag {tag} is missing; this is no raster")))
    }

    /// The floating-point numbers of a tag.
    pub(super) fn doubles(&self, tag: u16) -> Result<Option<Vec<f64>>, Fault> {
        let Some((kind, values)) = self.find(tag)? else { return Ok(None) };
        let double = |bytes| f64::from_bits(self.order.number(bytes));
        let float = |bytes| f64::from(f32::from_bits(self.order.number(bytes) as u32));
        match kind {
            DOUBLE => Ok(Some(values.chunks_exact(8).map(double).collect())),
            FLOAT => Ok(Some(values.chunks_exact(4).map(float).collect())),
            _ => Err(wrong_type(tag, kind, "floating-point numbers")),
        }
    }

    /// The bytes of a tag of text, up to the first NUL.
    pub(super) fn text(&self, tag: u16) -> Result<Option<&'a [u8]>, Fault> {
        match self.find(tag)? {
            None => Ok(None),
            Some((ASCII, text)) => Ok(text.split(|&byte| byte == 0).next()),
            Some((kind, _)) => Err(wrong_type(tag, kind, "text")),
        }
    }
}

/// Most bytes of directories with the values of their tags.
const MOST_OF_HEAD: u64 = 1 << 30;

/// Reads bytes from a place of a file, as many as are asked for.
type ReadAt<'a> = &'a mut dyn FnMut(u64, u64) -> Result<Vec<u8>, Fault>;

/// The directories of a file that is not in memory, with the values of their tags, as a file of their own. What places chunks
/// in it is as it was. Damage behind the first directory ends the list, as of [`Directory::others`].
pub(super) fn relocated(read: ReadAt<'_>) -> Result<Vec<u8>, Fault> {
    let mut head = read(0, 8)?;
    let (order, widths) = header(&head)?;
    if widths.offset == 8 {
        head.extend(read(8, 8)?);
    }
    let mut pointer = widths.first;
    for number in 0..=MAX_DIRECTORIES {
        let start = order.number(&head[pointer..pointer + widths.offset]);
        order.put(&mut head[pointer..pointer + widths.offset], 0);
        if number > 0 && start == 0 {
            break;
        }
        match table(start, (order, widths), read) {
            Ok(table) => {
                let place = head.len() as u64;
                order.put(&mut head[pointer..pointer + widths.offset], place);
                pointer = head.len() + table.len() - widths.offset;
                let first = head.len() + widths.entries;
                head.extend(table);
                for row in (first..pointer).step_by(4 + 2 * widths.offset) {
                    bring_values(&mut head, row, (order, widths), read);
                }
            }
            Err(fault) if number == 0 => return Err(fault),
            Err(_) => break,
        }
    }
    Ok(head)
}

/// A directory with its count of tags and the place of the next one.
fn table(start: u64, (order, widths): (Order, &'static Widths), read: ReadAt<'_>) -> Result<Vec<u8>, Fault> {
    let count = order.number(&read(start, widths.entries as u64)?);
    let length = count.checked_mul(4 + 2 * widths.offset as u64);
    let length = length.and_then(|length| length.checked_add((widths.entries + widths.offset) as u64));
    let length = length.filter(|&length| length <= MOST_OF_HEAD);
    let claims = || Fault::damaged(format!("the directory at byte {start} claims {count} tags"));
    read(start, length.ok_or_else(claims)?)
}

/// Puts the values of a tag behind all else; those that lie outside the file lie outside here too.
fn bring_values(head: &mut Vec<u8>, row: usize, (order, widths): (Order, &'static Widths), read: ReadAt<'_>) {
    let kind = order.number(&head[row + 2..row + 4]) as u16;
    let field = row + 4 + widths.offset..row + 4 + 2 * widths.offset;
    let count = order.number(&head[row + 4..field.start]);
    let length = count.checked_mul(value_width(kind));
    if length.is_some_and(|length| length <= widths.offset as u64) {
        return;
    }
    let start = order.number(&head[field.clone()]);
    let room = MOST_OF_HEAD.saturating_sub(head.len() as u64);
    let place = match length.filter(|&length| length <= room).map(|length| read(start, length)) {
        Some(Ok(values)) => {
            let place = head.len() as u64;
            head.extend(values);
            place
        }
        _ => u64::MAX,
    };
    order.put(&mut head[field], place);
}

fn header(bytes: &[u8]) -> Result<(Order, &'static Widths), Fault> {
    let order = match bytes.get(..2) {
        Some(b"II") => Order::Little,
        Some(b"MM") => Order::Big,
        _ => return Err(Fault::damaged("the file does not begin as a TIFF does, with II or MM")),
    };
    match order.number(field(bytes, 2, 2)?) {
        42 => Ok((order, &CLASSIC)),
        43 if order.number(field(bytes, 4, 2)?) == 8 => Ok((order, &BIG)),
        version => {
            Err(Fault::damaged(format!("TIFF version {version}; 42 (TIFF) and 43 (BigTIFF) are read")))
        }
    }
}

fn entry<'a>(bytes: &'a [u8], order: Order, row: &'a [u8]) -> Entry<'a> {
    let (tag, kind) = (order.number(&row[..2]) as u16, order.number(&row[2..4]) as u16);
    let (count, inline) = row[4..].split_at((row.len() - 4) / 2);
    let length = order.number(count).checked_mul(value_width(kind)).and_then(|n| usize::try_from(n).ok());
    let values = length.and_then(|length| match inline.get(..length) {
        Some(values) => Some(values),
        None => field(bytes, order.number(inline), length).ok(),
    });
    Entry { tag, kind, values }
}

/// Bytes of one value of a TIFF type; 0, and so no values, for a type that does not exist.
fn value_width(kind: u16) -> u64 {
    match kind {
        1 | 2 | 6 | 7 => 1,
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16..=18 => 8,
        _ => 0,
    }
}

/// `length` bytes of the file from `start`.
pub(super) fn field(bytes: &[u8], start: u64, length: usize) -> Result<&[u8], Fault> {
    let range = usize::try_from(start).ok().and_then(|start| Some(start..start.checked_add(length)?));
    range.and_then(|range| bytes.get(range)).ok_or_else(|| {
        Fault::damaged(format!(
            "{length} bytes from byte {start} on are missing: the file ends at byte {}; it is truncated or \
             damaged",
            bytes.len()
        ))
    })
}

fn wrong_type(tag: u16, kind: u16, wanted: &str) -> Fault {
    Fault::damaged(format!("tag {tag} has values of TIFF type {kind}, but must hold {wanted}"))
}
