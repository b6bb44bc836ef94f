//! Deformations of a fractal by the codes of its points.
//!
//! Source: Han and Kim 2007, "Fractal deformation using code and displacement vectors", J. Korea Contents Association.
//! Each kind is a file. Several go together in this order, whatever the order in which they are given:
//!
//! 1. **Code changes**, one after the other as listed, give a point x with the code m another code m'. It stands for the
//!    point x'; without changes x' = x.
//! 2. **Fields and displacement vectors** add up: `x + Σ V(x') + Σ d(m)` (eq. 7, 15 and 16). Without any field a code
//!    change moves the point itself, to `x' + Σ d(m)`.
//! 3. **Part-wise maps** turn what now stands there about joints that went along, the finest part first, parts of the
//!    same size as listed; so a part carries the parts in it, and joints never part.

mod change;
mod displacement;
mod field;
mod frame;
mod insertion;
mod interval;
mod keys;
mod part;
mod permutation;
mod replacement;
mod reversal;
mod swap;
#[cfg(test)]
mod tests;

pub use change::CodeChange;
pub use displacement::Displacement;
pub use field::{Field, Polynomial, Term};
pub use frame::Frame;
pub use insertion::Insertion;
pub use interval::Interval;
pub use keys::{By, DeformKeys, Units};
pub use part::Part;
pub use permutation::Permutation;
pub use replacement::Replacement;
pub use reversal::Reversal;
pub use swap::Swap;

use super::code::Code;
use super::map::Point;
use super::system::Ifs;

/// One deformation.
#[derive(Debug)]
pub enum Deform {
    /// A change of codes.
    Codes(Box<dyn CodeChange>),
    /// A continuous field.
    Field(Field),
    /// A vector for each digit.
    Displacement(Displacement),
    /// A linear map of one part.
    Part(Part),
}

/// Several deformations of one fractal.
#[derive(Debug)]
pub struct Deformation<'a> {
    ifs: &'a Ifs,
    changes: Vec<Box<dyn CodeChange>>,
    fields: Vec<Field>,
    displacements: Vec<Displacement>,
    /// The finest first, each with its joint.
    parts: Vec<(Part, Point)>,
}

impl<'a> Deformation<'a> {
    /// Puts deformations in their order.
    ///
    /// # Errors
    /// A sentence for the user, for each that does not fit the fractal: an interval that is empty or beyond the codes,
    /// a digit that names no map, an insertion for which the packing has no room.
    pub fn new(ifs: &'a Ifs, deforms: Vec<Deform>) -> Result<Self, Vec<String>> {
        let faults: Vec<String> = deforms.iter().filter_map(|deform| deform.fault(ifs)).collect();
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut this = Self {
            ifs,
            changes: Vec::new(),
            fields: Vec::new(),
            displacements: Vec::new(),
            parts: Vec::new(),
        };
        let mut parts = Vec::new();
        for deform in deforms {
            match deform {
                Deform::Codes(change) => this.changes.push(change),
                Deform::Field(field) => this.fields.push(field),
                Deform::Displacement(displacement) => this.displacements.push(displacement),
                Deform::Part(part) => parts.push(part),
            }
        }
        let longest = ifs.code_digits() + this.changes.iter().map(|change| change.lengthens()).sum::<usize>();
        if longest > ifs.digits().room() {
            let room = ifs.digits().room();
            return Err(vec![format!("insertions make codes of {longest} digits; they hold at most {room}")]);
        }
        parts.sort_by_key(|part: &Part| std::cmp::Reverse(part.prefix.len()));
        this.parts = parts.into_iter().map(|part| (part, this.joint(&part.prefix))).collect();
        Ok(this)
    }

    /// Whether it leaves every point where it is.
    pub fn is_nothing(&self) -> bool {
        self.changes.is_empty()
            && self.fields.is_empty()
            && self.displacements.is_empty()
            && self.parts.is_empty()
    }

    /// Where a point of that code goes.
    pub fn apply(&self, point: Point, code: &Code) -> Point {
        let moved = self.moved(point, code);
        self.parts.iter().fold(moved, |point, (part, joint)| {
            if code.starts_with(&part.prefix) { part.about(*joint, point) } else { point }
        })
    }

    /// The changed code.
    pub fn code(&self, code: &Code) -> Code {
        self.changes.iter().fold(*code, |code, change| change.change(&code, self.ifs.digits()))
    }

    /// A point after code changes, fields and displacement vectors.
    fn moved(&self, point: Point, code: &Code) -> Point {
        let seen = if self.changes.is_empty() { point } else { self.ifs.point(&self.code(code)) };
        let start = if self.fields.is_empty() { seen } else { point };
        let shifts = self.fields.iter().map(|field| field.at(seen));
        let shifts = shifts.chain(self.displacements.iter().map(|displacement| displacement.of(code)));
        shifts.fold(start, |sum, shift| std::array::from_fn(|i| sum[i] + shift[i]))
    }

    /// Where the joint of a part stands after everything but part-wise maps.
    fn joint(&self, prefix: &Code) -> Point {
        let digits = prefix.digits().chain(std::iter::repeat(0)).take(self.ifs.code_digits());
        let code = Code::packed(self.ifs.digits(), digits);
        self.moved(self.ifs.point(&code), &code)
    }
}

impl Deform {
    fn fault(&self, ifs: &Ifs) -> Option<String> {
        let digits = ifs.digits();
        match self {
            Self::Codes(change) => {
                change.interval().fault(ifs.code_digits()).or_else(|| change.fault(digits))
            }
            Self::Field(_) => None,
            Self::Displacement(displacement) => {
                displacement.interval.fault(ifs.code_digits()).or_else(|| displacement.fault(digits))
            }
            Self::Part(part) => (part.prefix.len() > ifs.code_digits()).then(|| {
                format!("the prefix {} is longer than the codes of {} digits", part.prefix, ifs.code_digits())
            }),
        }
    }
}
