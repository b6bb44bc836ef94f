//! Types of numbers in files, and their values.

/// A type of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    /// Its name, as `NumPy` and Zarr have it.
    pub(super) name: &'static str,
    /// Bytes of one number.
    pub(super) bytes: usize,
    value: fn(u64) -> f64,
}

const NUMBERS: [Number; 10] = [
    number("float32", 4, |bits| f64::from(f32::from_bits(bits as u32))),
    number("float64", 8, f64::from_bits),
    number("int8", 1, |bits| f64::from(bits as i8)),
    number("int16", 2, |bits| f64::from(bits as i16)),
    number("int32", 4, |bits| f64::from(bits as i32)),
    number("int64", 8, |bits| bits as i64 as f64),
    number("uint8", 1, |bits| bits as f64),
    number("uint16", 2, |bits| bits as f64),
    number("uint32", 4, |bits| bits as f64),
    number("uint64", 8, |bits| bits as f64),
];

const fn number(name: &'static str, bytes: usize, value: fn(u64) -> f64) -> Number {
    Number { name, bytes, value }
}

impl Number {
    /// The type of that name.
    pub(super) fn of(name: &str) -> Option<Self> {
        NUMBERS.into_iter().find(|number| number.name == name)
    }

    /// The value of so many bytes, the most significant first or last.
    pub(super) fn value(self, bytes: &[u8], is_big: bool) -> f64 {
        let join = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        let bits = if is_big { bytes.iter().fold(0, join) } else { bytes.iter().rev().fold(0, join) };
        (self.value)(bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_either_end_with_their_sign() {
        let value = |name, bytes: &[u8], is_big| Number::of(name).expect("known").value(bytes, is_big);
        assert_eq!(value("int16", &[0xff, 0xfe], true), -2.0);
        assert_eq!(value("int16", &[0xfe, 0xff], false), -2.0);
        assert_eq!(value("uint8", &[0xff], false), 255.0);
        assert_eq!(value("int8", &[0xff], false), -1.0);
        assert_eq!(value("float32", &1.5_f32.to_le_bytes(), false), 1.5);
        assert_eq!(value("float64", &(-0.25_f64).to_be_bytes(), true), -0.25);
        assert_eq!(value("int64", &[0xff; 8], true), -1.0);
        assert!(Number::of("float16").is_none());
    }
}
