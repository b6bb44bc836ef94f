//! Tags of the lists in a header; types of numbers by their codes, and what stands where none was written. All are big-endian.

use super::super::Fault;
use super::super::number::Number;

/// Tags of the lists in a header.
pub(super) mod tag {
    pub(in super::super) const ABSENT: u32 = 0;
    pub(in super::super) const DIMENSIONS: u32 = 10;
    pub(in super::super) const VARIABLES: u32 = 11;
    pub(in super::super) const ATTRIBUTES: u32 = 12;
}

/// A type of numbers or letters in a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    /// Code in the file.
    pub(super) code: u32,
    /// The numbers; letters are bytes.
    pub(super) number: Number,
    /// What stands where nothing was written; bytes have no such number.
    pub(super) fill: Option<f64>,
}

/// The type of letters.
pub(super) const CHARACTER: u32 = 2;
pub(super) const INTEGER: u32 = 4;
pub(super) const FLOAT: u32 = 5;
pub(super) const DOUBLE: u32 = 6;

/// What floats hold where nothing was written, in `float32`: 15 · 2^119.
const FLOAT_FILL: f64 = 9.969_209_968_386_869e36;

/// Codes, types and fill values; those from 7 on are of CDF-5.
const KINDS: [(u32, &str, Option<f64>); 11] = [
    (1, "int8", None),
    (CHARACTER, "uint8", None),
    (3, "int16", Some(-32767.0)),
    (INTEGER, "int32", Some(-2_147_483_647.0)),
    (FLOAT, "float32", Some(FLOAT_FILL)),
    (DOUBLE, "float64", Some(FLOAT_FILL)),
    (7, "uint8", None),
    (8, "uint16", Some(65535.0)),
    (9, "uint32", Some(4_294_967_295.0)),
    (10, "int64", Some(-9_223_372_036_854_775_806.0)),
    (11, "uint64", Some(18_446_744_073_709_551_614.0)),
];

impl Kind {
    pub(super) fn of(code: u32) -> Result<Self, Fault> {
        let known = KINDS.iter().find(|(known, ..)| *known == code);
        let (_, name, fill) =
            known.ok_or_else(|| Fault::damaged(format!("type {code} of numbers; there are 1 to 11")))?;
        let number = Number::of(name).expect("the table names types that there are");
        Ok(Self { code, number, fill: *fill })
    }

    /// The same bits without a sign, as `_Unsigned = "true"` asks for.
    pub(super) fn unsigned(self) -> Self {
        let twin = match self.code {
            1 => 7,
            3 => 8,
            INTEGER => 9,
            _ => return self,
        };
        Self::of(twin).unwrap_or(self)
    }

    /// The value of so many bytes.
    pub(super) fn value(self, bytes: &[u8]) -> f64 {
        self.number.value(bytes, true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fill_values_are_those_of_the_format() {
        let of = |code| Kind::of(code).expect("known");
        assert_eq!(of(1).value(&[0xff]), -1.0);
        assert_eq!(of(1).unsigned().value(&[0xff]), 255.0);
        assert_eq!(of(3).value(&[0x80, 0x01]), of(3).fill.expect("has one"));
        assert_eq!(of(FLOAT).value(&0x7cf0_0000_u32.to_be_bytes()), FLOAT_FILL);
        assert!(Kind::of(0).is_err() && Kind::of(12).is_err());
    }
}
