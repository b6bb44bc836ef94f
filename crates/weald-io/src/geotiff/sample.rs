//! Types of values, the predictors that ready them for compression, and their way to `f32`.

use super::super::Fault;
use super::directory::Order;

/// Type of the values of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sample {
    format: Format,
    bits: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Unsigned,
    Signed,
    Float,
}

impl Sample {
    /// The type behind TIFF's sample format and bits a sample. The order of three bytes is that of the file by the
    /// specification, and the other one in files of GDAL: they are refused.
    pub(super) fn of(format: u64, bits: u64) -> Result<Self, Fault> {
        let format_of = match (format, bits) {
            (1, 1..=23 | 25..=32 | 64) => Some(Format::Unsigned),
            (2, 8 | 16 | 32 | 64) => Some(Format::Signed),
            (3, 16 | 32 | 64) => Some(Format::Float),
            _ => None,
        };
        let format = format_of.ok_or_else(|| {
            Fault::damaged(format!(
                "values of {bits} bits in sample format {format}; unsigned integers of 1 to 32 (but not 24) and 64 bits, signed \
                 ones of 8, 16, 32 and 64, and floats of 16, 32 and 64 are read: gdal_translate -ot Float32"
            ))
        })?;
        Ok(Self { format, bits: bits as usize })
    }

    /// Name for the user: the type that holds the bits.
    pub(super) fn name(self) -> &'static str {
        let names = match self.format {
            Format::Unsigned => ["uint8", "uint16", "uint32", "uint64"],
            Format::Signed => ["int8", "int16", "int32", "int64"],
            Format::Float => ["float8", "float16", "float32", "float64"],
        };
        names[self.bytes().next_power_of_two().ilog2() as usize]
    }

    /// Bits a value.
    pub(super) fn bits(self) -> usize {
        self.bits
    }

    /// Bytes that hold a value.
    fn bytes(self) -> usize {
        self.bits.div_ceil(8)
    }

    /// Whether values are whole bytes in the order of the file; others follow each other bit by bit, the most
    /// significant first.
    fn is_whole_bytes(self) -> bool {
        self.bits.is_multiple_of(8)
    }

    fn is_float(self) -> bool {
        self.format == Format::Float
    }

    /// The value of a bit pattern.
    pub(super) fn value(self, bits: u64) -> f64 {
        let above = 64 - self.bits;
        match (self.format, self.bits) {
            (Format::Unsigned, _) => bits as f64,
            (Format::Signed, _) => (((bits << above) as i64) >> above) as f64,
            (Format::Float, 16) => half(bits as u16),
            (Format::Float, 32) => f64::from(f32::from_bits(bits as u32)),
            (Format::Float, _) => f64::from_bits(bits),
        }
    }

    /// The no-data number as this type holds it: GDAL writes too few digits of some `float32` numbers.
    pub(super) fn nearest(self, number: f64) -> f64 {
        if self.is_float() && self.bits <= 32 { f64::from(number as f32) } else { number }
    }
}

/// A number of IEEE 754's binary16: a sign, five bits of exponent, ten of fraction.
fn half(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2.0_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

/// What was done to the values before compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Predictor {
    /// Nothing.
    None,
    /// Each value but the first of a row is the difference to its western neighbour.
    Horizontal,
    /// Floats split into bytes, most significant first, then differences byte by byte.
    FloatingPoint,
}

impl Predictor {
    /// The predictor behind tag 317, where it fits the type of the values.
    pub(super) fn of(number: u64, sample: Sample) -> Result<Self, Fault> {
        match number {
            1 => Ok(Self::None),
            2 if sample.is_whole_bytes() => Ok(Self::Horizontal),
            3 if sample.is_float() => Ok(Self::FloatingPoint),
            _ => Err(Fault::damaged(format!(
                "predictor {number} on {} values of {} bits; 1 is read, 2 on whole bytes, and 3 on floats: \
                 gdal_translate -co PREDICTOR=1",
                sample.name(),
                sample.bits
            ))),
        }
    }

    /// Calls `put` with the position and the value of each cell of a row, in order; `row` holds whole values
    /// and is overwritten.
    pub(super) fn undo(self, row: &mut [u8], sample: Sample, order: Order, mut put: impl FnMut(usize, f64)) {
        let width = sample.bytes();
        if self == Self::FloatingPoint {
            add_up(row);
            let columns = row.len() / width;
            let byte = |plane: usize, x: usize| u64::from(row[plane * columns + x]);
            (0..columns).for_each(|x| {
                put(x, sample.value((0..width).fold(0, |bits, plane| bits << 8 | byte(plane, x))));
            });
            return;
        }
        if !sample.is_whole_bytes() {
            (0..row.len() * 8 / sample.bits).for_each(|x| put(x, sample.value(bits_at(row, x, sample.bits))));
            return;
        }
        let mut west = 0_u64;
        for (x, bytes) in row.chunks_exact(width).enumerate() {
            let bits = order.number(bytes);
            west = if self == Self::Horizontal { west.wrapping_add(bits) & mask(width) } else { bits };
            put(x, sample.value(west));
        }
    }
}

/// The number at a position of a row in which each takes so many bits.
fn bits_at(row: &[u8], position: usize, bits: usize) -> u64 {
    let of_bit = |at: usize| u64::from(row[at / 8] >> (7 - at % 8) & 1);
    (position * bits..(position + 1) * bits).fold(0, |number, at| number << 1 | of_bit(at))
}

fn mask(width: usize) -> u64 {
    u64::MAX >> (64 - 8 * width)
}

fn add_up(row: &mut [u8]) {
    let mut west = 0_u8;
    for byte in row {
        west = west.wrapping_add(*byte);
        *byte = west;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGNED_16: Sample = Sample { format: Format::Signed, bits: 16 };
    const FLOAT_32: Sample = Sample { format: Format::Float, bits: 32 };
    const FLOAT_64: Sample = Sample { format: Format::Float, bits: 64 };

    fn undone(predictor: Predictor, row: &[u8], sample: Sample, order: Order) -> Vec<f64> {
        let mut values = Vec::new();
        predictor.undo(&mut row.to_vec(), sample, order, |_, value| values.push(value));
        values
    }

    #[test]
    fn horizontal_differences_wrap_in_the_width_of_the_type() {
        let row = [0xff, 0x7f, 0x01, 0x00, 0xff, 0xff];
        let values = undone(Predictor::Horizontal, &row, SIGNED_16, Order::Little);
        assert_eq!(values, [32767.0, -32768.0, 32767.0]);
    }

    #[test]
    fn big_endian_values_are_read_most_significant_byte_first() {
        let values = undone(Predictor::None, &[0xff, 0xfe, 0x01, 0x00], SIGNED_16, Order::Big);
        assert_eq!(values, [-2.0, 256.0]);
    }

    #[test]
    fn all_bits_set_are_minus_one_in_signed_types_and_the_greatest_number_in_unsigned_ones() {
        for bits in [8_u64, 16, 32] {
            for (format, value) in [(1, 2.0_f64.powi(bits as i32) - 1.0), (2, -1.0)] {
                let sample = Sample::of(format, bits).expect("read");
                let row = vec![0xff; sample.bytes()];
                assert_eq!(
                    undone(Predictor::None, &row, sample, Order::Little),
                    [value],
                    "{}",
                    sample.name()
                );
            }
        }
    }

    #[test]
    fn numbers_of_few_bits_follow_each_other_from_the_most_significant_on() {
        let twelve = Sample::of(1, 12).expect("read");
        assert_eq!(undone(Predictor::None, &[0x12, 0x3a, 0xbc], twelve, Order::Little), [291.0, 2748.0]);
        assert_eq!((twelve.name(), Sample::of(1, 1).expect("read").name()), ("uint16", "uint8"));
        let one = Sample::of(1, 1).expect("read");
        assert_eq!(undone(Predictor::None, &[0b1010_0000], one, Order::Big)[..4], [1.0, 0.0, 1.0, 0.0]);
        assert!(Predictor::of(2, twelve).is_err() && Sample::of(2, 12).is_err());
    }

    #[test]
    fn halves_are_those_of_ieee_754() {
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_477_539_063e-8),
            (0x3555, 0.333_251_953_125),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan() && half(0xfc00) == f64::NEG_INFINITY);
    }

    /// GDAL before version 3 wrote the least `float32` with 15 digits, which `float32` cannot tell from 17.
    #[test]
    fn a_no_data_number_with_too_few_digits_still_marks_its_cells() {
        let written = "-3.40282346638529e+38".parse().expect("a number");
        assert_eq!(FLOAT_32.nearest(written), f64::from(f32::MIN));
        assert_ne!(FLOAT_64.nearest(written), f64::from(f32::MIN));
    }

    #[test]
    fn the_floating_point_predictor_knows_no_byte_order() {
        let mut row: Vec<u8> = Vec::new();
        for plane in 0..4 {
            row.extend([1.5_f32, -271.25].map(|value| value.to_be_bytes()[plane]));
        }
        (1..row.len()).rev().for_each(|at| row[at] = row[at].wrapping_sub(row[at - 1]));
        for order in [Order::Little, Order::Big] {
            assert_eq!(undone(Predictor::FloatingPoint, &row, FLOAT_32, order), [1.5, -271.25]);
        }
    }
}
