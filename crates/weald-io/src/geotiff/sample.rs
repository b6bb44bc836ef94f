//! Types of values, the predictors that ready them for compression, and their way to `f32`.

use super::super::Fault;
use super::directory::Order;

/// Type of the values of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample {
    Unsigned8,
    Unsigned16,
    Unsigned32,
    Signed8,
    Signed16,
    Signed32,
    Float32,
    Float64,
}

impl Sample {
    /// The type behind TIFF's sample format and bits a sample.
    pub(super) fn of(format: u64, bits: u64) -> Result<Self, Fault> {
        match (format, bits) {
            (1, 8) => Ok(Self::Unsigned8),
            (1, 16) => Ok(Self::Unsigned16),
            (1, 32) => Ok(Self::Unsigned32),
            (2, 8) => Ok(Self::Signed8),
            (2, 16) => Ok(Self::Signed16),
            (2, 32) => Ok(Self::Signed32),
            (3, 32) => Ok(Self::Float32),
            (3, 64) => Ok(Self::Float64),
            _ => Err(Fault::damaged(format!(
                "values of {bits} bits in sample format {format}; integers of 8, 16 and 32 bits and floats of \
                 32 and 64 are read: gdal_translate -ot Float32"
            ))),
        }
    }

    /// Name for the user.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Unsigned8 => "uint8",
            Self::Unsigned16 => "uint16",
            Self::Unsigned32 => "uint32",
            Self::Signed8 => "int8",
            Self::Signed16 => "int16",
            Self::Signed32 => "int32",
            Self::Float32 => "float32",
            Self::Float64 => "float64",
        }
    }

    /// Bytes a value.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 | Self::Signed8 => 1,
            Self::Unsigned16 | Self::Signed16 => 2,
            Self::Unsigned32 | Self::Signed32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }

    fn is_float(self) -> bool {
        matches!(self, Self::Float32 | Self::Float64)
    }

    /// The value of a bit pattern.
    pub(super) fn value(self, bits: u64) -> f64 {
        match self {
            Self::Unsigned8 | Self::Unsigned16 | Self::Unsigned32 => bits as f64,
            Self::Signed8 => f64::from(bits as i8),
            Self::Signed16 => f64::from(bits as i16),
            Self::Signed32 => f64::from(bits as i32),
            Self::Float32 => f64::from(f32::from_bits(bits as u32)),
            Self::Float64 => f64::from_bits(bits),
        }
    }

    /// The no-data number as this type holds it: GDAL writes too few digits of some `float32` numbers.
    pub(super) fn nearest(self, number: f64) -> f64 {
        if self == Self::Float32 { f64::from(number as f32) } else { number }
    }
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
            2 => Ok(Self::Horizontal),
            3 if sample.is_float() => Ok(Self::FloatingPoint),
            _ => Err(Fault::damaged(format!(
                "predictor {number} on {} values; 1 and 2 are read, and 3 on floats",
                sample.name()
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
        let mut west = 0_u64;
        for (x, bytes) in row.chunks_exact(width).enumerate() {
            let bits = order.number(bytes);
            west = if self == Self::Horizontal { west.wrapping_add(bits) & mask(width) } else { bits };
            put(x, sample.value(west));
        }
    }
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

    fn undone(predictor: Predictor, row: &[u8], sample: Sample, order: Order) -> Vec<f64> {
        let mut values = Vec::new();
        predictor.undo(&mut row.to_vec(), sample, order, |_, value| values.push(value));
        values
    }

    #[test]
    fn horizontal_differences_wrap_in_the_width_of_the_type() {
        let row = [0xff, 0x7f, 0x01, 0x00, 0xff, 0xff];
        let values = undone(Predictor::Horizontal, &row, Sample::Signed16, Order::Little);
        assert_eq!(values, [32767.0, -32768.0, 32767.0]);
    }

    #[test]
    fn big_endian_values_are_read_most_significant_byte_first() {
        let values = undone(Predictor::None, &[0xff, 0xfe, 0x01, 0x00], Sample::Signed16, Order::Big);
        assert_eq!(values, [-2.0, 256.0]);
    }

    #[test]
    fn all_bits_set_are_minus_one_in_signed_types_and_the_greatest_number_in_unsigned_ones() {
        for (sample, value) in [
            (Sample::Signed8, -1.0),
            (Sample::Signed16, -1.0),
            (Sample::Signed32, -1.0),
            (Sample::Unsigned8, 255.0),
            (Sample::Unsigned16, 65535.0),
            (Sample::Unsigned32, 4_294_967_295.0),
        ] {
            let row = vec![0xff; sample.bytes()];
            assert_eq!(undone(Predictor::None, &row, sample, Order::Little), [value], "{}", sample.name());
        }
    }

    /// GDAL before version 3 wrote the least `float32` with 15 digits, which `float32` cannot tell from 17.
    #[test]
    fn a_no_data_number_with_too_few_digits_still_marks_its_cells() {
        let written = "-3.40282346638529e+38".parse().expect("a number");
        assert_eq!(Sample::Float32.nearest(written), f64::from(f32::MIN));
        assert_ne!(Sample::Float64.nearest(written), f64::from(f32::MIN));
    }

    #[test]
    fn the_floating_point_predictor_knows_no_byte_order() {
        let mut row: Vec<u8> = Vec::new();
        for plane in 0..4 {
            row.extend([1.5_f32, -271.25].map(|value| value.to_be_bytes()[plane]));
        }
        (1..row.len()).rev().for_each(|at| row[at] = row[at].wrapping_sub(row[at - 1]));
        for order in [Order::Little, Order::Big] {
            assert_eq!(undone(Predictor::FloatingPoint, &row, Sample::Float32, order), [1.5, -271.25]);
        }
    }
}
