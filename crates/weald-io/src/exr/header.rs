//! The header: named attributes, of which some give the size and the kind of the pixels.

use super::super::{Fault, Limits};
use super::compression::Compression;
use weald_core::grid::Size;

/// The first bytes of a file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

const VERSION: u8 = 2;
/// Bits of the version field that change what follows.
const TILED: u32 = 1 << 9;
const NOT_FLAT: u32 = 1 << 11;
const MULTI_PART: u32 = 1 << 12;

/// Bytes of a file, read from front to back.
#[derive(Clone, Debug)]
pub(super) struct Bytes<'a> {
    pub(super) rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(|| {
            Fault::damaged(format!("{count} bytes are missing at the end; the file is truncated or damaged"))
        })?;
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        Ok(self.take(N)?.try_into().expect("as many as were asked for"))
    }

    pub(super) fn number(&mut self) -> Result<i32, Fault> {
        Ok(i32::from_le_bytes(self.array()?))
    }

    /// Text up to a NUL.
    fn text(&mut self) -> Result<&'a [u8], Fault> {
        let end = self.rest.iter().position(|&byte| byte == 0);
        let end =
            end.ok_or_else(|| Fault::damaged("the header ends within a name; the file is truncated"))?;
        let text = self.take(end)?;
        self.take(1)?;
        Ok(text)
    }
}

/// One attribute as it stands in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attribute<'a> {
    name: &'a [u8],
    kind: &'a [u8],
    value: &'a [u8],
}

/// All attributes of a file.
#[derive(Debug)]
pub(super) struct Attributes<'a>(Vec<Attribute<'a>>);

impl<'a> Attributes<'a> {
    fn parse(bytes: &mut Bytes<'a>) -> Result<Self, Fault> {
        let mut attributes = Vec::new();
        loop {
            let name = bytes.text()?;
            if name.is_empty() {
                return Ok(Self(attributes));
            }
            let kind = bytes.text()?;
            let length = usize::try_from(bytes.number()?)
                .map_err(|_| Fault::damaged("an attribute has a negative length; the file is damaged"))?;
            attributes.push(Attribute { name, kind, value: bytes.take(length)? });
        }
    }

    /// The bytes of an attribute of that name and type.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for one of another type.
    pub(super) fn value(&self, name: &str, kind: &str) -> Result<Option<&'a [u8]>, Fault> {
        let Some(found) = self.0.iter().find(|attribute| attribute.name == name.as_bytes()) else {
            return Ok(None);
        };
        if found.kind != kind.as_bytes() {
            let shown = String::from_utf8_lossy(found.kind);
            return Err(Fault::damaged(format!("attribute {name} is of type {shown}, but must be a {kind}")));
        }
        Ok(Some(found.value))
    }

    /// An attribute that every file has, of a fixed length.
    fn needed<const N: usize>(&self, name: &str, kind: &str) -> Result<[u8; N], Fault> {
        let value = self.value(name, kind)?;
        let value = value.ok_or_else(|| Fault::damaged(format!("the header has no attribute {name}")))?;
        value.try_into().map_err(|_| {
            Fault::damaged(format!("attribute {name} has {} bytes, but must have {N}", value.len()))
        })
    }
}

/// Type of the samples of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample {
    Uint,
    Half,
    Float,
}

impl Sample {
    pub(super) fn bytes(self) -> usize {
        if self == Self::Half { 2 } else { 4 }
    }

    /// Name for users.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Uint => "uint32",
            Self::Half => "float16",
            Self::Float => "float32",
        }
    }
}

/// One channel.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub(super) name: String,
    pub(super) sample: Sample,
}

/// What the header says of the pixels.
#[derive(Debug)]
pub(super) struct Header<'a> {
    pub(super) attributes: Attributes<'a>,
    pub(super) channels: Vec<Channel>,
    pub(super) compression: Compression,
    pub(super) size: Size,
    /// First column and row of the data window.
    pub(super) corner: [i32; 2],
    /// Columns and rows of a tile.
    pub(super) tile: Option<[usize; 2]>,
}

impl<'a> Header<'a> {
    /// Reads the header; `bytes` then stands at the table of chunks.
    pub(super) fn parse(bytes: &mut Bytes<'a>, limits: Limits) -> Result<Self, Fault> {
        let flags = flags(bytes)?;
        let attributes = Attributes::parse(bytes)?;
        let (size, corner) = window(&attributes.needed("dataWindow", "box2i")?, limits)?;
        let [compression] = attributes.needed("compression", "compression")?;
        let channels = attributes.value("channels", "chlist")?;
        let channels = channels.ok_or_else(|| Fault::damaged("the header has no attribute channels"))?;
        let tile = (flags & TILED != 0).then(|| tile(&attributes.needed("tiles", "tiledesc")?));
        Ok(Self {
            channels: self::channels(channels)?,
            compression: Compression::of(compression)?,
            tile: tile.transpose()?,
            size,
            corner,
            attributes,
        })
    }

    /// Bytes of one column of one row, over all channels.
    pub(super) fn pixel_bytes(&self) -> usize {
        self.channels.iter().map(|channel| channel.sample.bytes()).sum()
    }
}

fn flags(bytes: &mut Bytes<'_>) -> Result<u32, Fault> {
    if bytes.rest.get(..4) != Some(&MAGIC) {
        return Err(Fault::damaged("the file does not begin as an OpenEXR file does, with 76 2f 31 01"));
    }
    bytes.take(4)?;
    let field = u32::from_le_bytes(bytes.array()?);
    if field as u8 != VERSION {
        return Err(Fault::damaged(format!("OpenEXR version {}; {VERSION} is read", field as u8)));
    }
    if field & (NOT_FLAT | MULTI_PART) != 0 {
        return Err(Fault::damaged(
            "the file has several parts or deep pixels; one flat image is read: exrmultipart -separate, or \
             choose the height layer where the file is made",
        ));
    }
    Ok(field)
}

/// Size and first column and row of the data window.
fn window(corners: &[u8; 16], limits: Limits) -> Result<(Size, [i32; 2]), Fault> {
    let corner = |at: usize| i32::from_le_bytes([0, 1, 2, 3].map(|byte| corners[4 * at + byte]));
    let [left, top, right, bottom] = [0, 1, 2, 3].map(corner);
    let side = |first: i32, last: i32| usize::try_from(i64::from(last) - i64::from(first) + 1).unwrap_or(0);
    Ok((limits.size(side(left, right), side(top, bottom))?, [left, top]))
}

/// Columns and rows of a tile. What levels there are does not matter: the finest comes first.
fn tile(description: &[u8; 9]) -> Result<[usize; 2], Fault> {
    let side = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|byte| description[4 * at + byte])) as usize;
    match [side(0), side(1)] {
        [0, _] | [_, 0] => Err(Fault::damaged("tiles have no cells; the file is damaged")),
        sides => Ok(sides),
    }
}

fn channels(list: &[u8]) -> Result<Vec<Channel>, Fault> {
    let (mut bytes, mut channels) = (Bytes { rest: list }, Vec::new());
    loop {
        let name = String::from_utf8_lossy(bytes.text()?).into_owned();
        if name.is_empty() {
            break;
        }
        let sample = match bytes.number()? {
            0 => Sample::Uint,
            1 => Sample::Half,
            2 => Sample::Float,
            kind => return Err(Fault::damaged(format!("channel {name} is of type {kind}; 0 to 2 exist"))),
        };
        bytes.take(4)?;
        let sampling = [bytes.number()?, bytes.number()?];
        if sampling != [1, 1] {
            return Err(Fault::damaged(format!(
                "channel {name} has a sample for {} × {} cells; one a cell is read",
                sampling[0], sampling[1]
            )));
        }
        channels.push(Channel { name, sample });
    }
    if channels.is_empty() {
        return Err(Fault::damaged("the file has no channels"));
    }
    Ok(channels)
}
