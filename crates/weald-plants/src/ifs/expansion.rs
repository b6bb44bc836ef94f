//! All codes to a depth: every part of a fractal, each once.
//!
//! The deterministic algorithm (Barnsley 1988, section III.8): N maps give N^d parts of d digits. Parts come out in
//! the order of their codes.

use std::cell::Cell;

use super::code::Code;
use super::map::{Map, Point};
use super::system::Ifs;
use weald_core::error::{Error, Limit, Quantity};

/// Most parts of one expansion: 5 GiB of points with their codes.
pub const MAX_PARTS: u64 = 1 << 26;

/// A part: its code, and the map that makes it of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its code.
    pub code: Code,
    /// From the whole to the part.
    pub map: Map,
}

/// A point with the code that leads to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coded {
    /// Where it is.
    pub at: Point,
    /// Its address.
    pub code: Code,
}

/// Shows all parts of `depth` digits.
///
/// # Errors
/// [`Error::Limit`] beyond [`MAX_PARTS`] parts, or where codes have no room for so many digits.
pub fn parts(ifs: &Ifs, depth: usize, mut look: impl FnMut(&Part)) -> Result<(), Error> {
    let maps = ifs.maps().len();
    let count = (maps as u64).checked_pow(depth as u32);
    if count.is_none_or(|count| count > MAX_PARTS) || depth > ifs.digits().room() {
        let limit = Limit::new(Quantity::Parts, count, 0..=MAX_PARTS);
        let subject = format!("{}: all parts to a depth of {depth}", ifs.name());
        return Err(limit.of(subject).remedy(format!("choose a depth of {} or less", deepest(maps))).into());
    }
    let whole = Part { code: Code::empty(ifs.digits()), map: Map::IDENTITY };
    descend(ifs, whole, depth, &|_| false, &mut look);
    Ok(())
}

/// Shows the parts that are the first on their way down to be at most as large as `size`, a share of the whole.
///
/// # Errors
/// [`Error::Limit`] beyond [`MAX_PARTS`] parts.
pub fn parts_of_size(ifs: &Ifs, size: f64, mut look: impl FnMut(&Part)) -> Result<(), Error> {
    let whole = Part { code: Code::empty(ifs.digits()), map: Map::IDENTITY };
    let small = |part: &Part| part.map.ratio() <= size;
    let count = Cell::new(0_u64);
    // Beyond the limit every part ends the way down, so that counting ends soon.
    let enough = |part: &Part| count.get() > MAX_PARTS || small(part);
    descend(ifs, whole, ifs.digits().room(), &enough, &mut |_| count.set(count.get() + 1));
    if count.get() > MAX_PARTS {
        let limit = Limit::new(Quantity::Parts, None, 0..=MAX_PARTS);
        let limit = limit.of(format!("{}: parts larger than {size} of its size", ifs.name()));
        return Err(limit.remedy("choose a larger size").into());
    }
    descend(ifs, whole, ifs.digits().room(), &small, &mut look);
    Ok(())
}

fn descend(ifs: &Ifs, part: Part, left: usize, stop: &dyn Fn(&Part) -> bool, look: &mut dyn FnMut(&Part)) {
    if left == 0 || stop(&part) {
        return look(&part);
    }
    for (digit, weighted) in ifs.maps().iter().enumerate() {
        let inner = Part { code: part.code.with(digit as u8), map: part.map.after(&weighted.map) };
        descend(ifs, inner, left - 1, stop, look);
    }
}

fn deepest(maps: usize) -> u32 {
    (1..64).find(|&depth| (maps as u64).pow(depth + 1) > MAX_PARTS).unwrap_or(1)
}

/// The points of all codes of `depth` digits, in the order of their codes.
///
/// # Errors
/// As [`parts`].
pub fn points(ifs: &Ifs, depth: usize) -> Result<Vec<Coded>, Error> {
    let mut points = Vec::new();
    parts(ifs, depth, |part| points.push(Coded { at: ifs.point(&part.code), code: part.code }))?;
    Ok(points)
}
