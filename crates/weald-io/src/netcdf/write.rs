//! The bytes of a file: header, then variable after variable.

use super::super::cf::{Attribute, Attributes, Axis, Dataset, Order, Values, Variable};
use super::kind::{CHARACTER, DOUBLE, FLOAT, INTEGER, tag};
use weald_core::grid::Size;

/// Axes in the order of their dimensions.
const AXES: [Axis; 2] = [Axis::Y, Axis::X];

/// All of a file. Offsets are of 32 bits where they suffice, since every reader knows those.
pub(super) fn bytes(dataset: &Dataset<'_>) -> Vec<u8> {
    let lengths: Vec<u64> = dataset.variables.iter().map(|variable| length(variable, dataset.size)).collect();
    let data: u64 = lengths.iter().sum();
    let small = header(dataset, &lengths, false);
    let is_large = small.len() as u64 + data > i32::MAX as u64;
    let mut file = if is_large { header(dataset, &lengths, true) } else { small };
    file.reserve_exact(data as usize);
    for variable in &dataset.variables {
        numbers(&variable.values, &mut file);
    }
    file
}

/// Bytes of the numbers, a multiple of four for each of our types.
fn length(variable: &Variable<'_>, size: Size) -> u64 {
    match &variable.values {
        Values::Nothing => 4,
        Values::Along(axis, _) => 8 * axis.length(size) as u64,
        Values::Cells(..) => 4 * size.cells() as u64,
    }
}

fn header(dataset: &Dataset<'_>, lengths: &[u64], is_large: bool) -> Vec<u8> {
    // Where the numbers begin depends on the length of the header, which does not depend on where they begin.
    let length = header_at(dataset, lengths, is_large, 0).len() as u64;
    header_at(dataset, lengths, is_large, length)
}

fn header_at(dataset: &Dataset<'_>, lengths: &[u64], is_large: bool, begin: u64) -> Vec<u8> {
    let mut header = Header(vec![b'C', b'D', b'F', if is_large { 2 } else { 1 }]);
    header.word(0); // No records.
    header.list(tag::DIMENSIONS, AXES.len());
    for axis in AXES {
        header.name(axis.name());
        header.word(axis.length(dataset.size) as u32);
    }
    header.attributes(&dataset.attributes);
    header.list(tag::VARIABLES, dataset.variables.len());
    let mut begin = begin;
    for (variable, length) in dataset.variables.iter().zip(lengths) {
        header.variable(variable, *length as u32);
        if is_large {
            header.0.extend(begin.to_be_bytes());
        } else {
            header.word(begin as u32);
        }
        begin += length;
    }
    header.0
}

/// A header that grows.
struct Header(Vec<u8>);

impl Header {
    fn word(&mut self, word: u32) {
        self.0.extend(word.to_be_bytes());
    }

    fn list(&mut self, tag: u32, entries: usize) {
        self.word(if entries == 0 { tag::ABSENT } else { tag });
        self.word(entries as u32);
    }

    fn padded(&mut self, bytes: &[u8]) {
        self.0.extend(bytes);
        self.0.resize(self.0.len().next_multiple_of(4), 0);
    }

    fn name(&mut self, name: &str) {
        self.word(name.len() as u32);
        self.padded(name.as_bytes());
    }

    fn attributes(&mut self, attributes: &Attributes) {
        self.list(tag::ATTRIBUTES, attributes.0.len());
        for (name, value) in &attributes.0 {
            self.name(name);
            self.value(value);
        }
    }

    fn value(&mut self, value: &Attribute) {
        let (kind, count, bytes) = match value {
            Attribute::Text(text) => (CHARACTER, text.len(), text.as_bytes().to_vec()),
            Attribute::Float(number) => (FLOAT, 1, number.to_be_bytes().to_vec()),
            Attribute::Doubles(numbers) => (DOUBLE, numbers.len(), big_endian(numbers, f64::to_be_bytes)),
            Attribute::Integers(numbers) => (INTEGER, numbers.len(), big_endian(numbers, i32::to_be_bytes)),
        };
        self.word(kind);
        self.word(count as u32);
        self.padded(&bytes);
    }

    /// All of a variable but where it begins.
    fn variable(&mut self, variable: &Variable<'_>, length: u32) {
        self.name(&variable.name);
        let axes = variable.values.axes();
        self.word(axes.len() as u32);
        for axis in axes {
            let position = AXES.iter().position(|known| known == axis);
            self.word(position.expect("there are two axes") as u32);
        }
        let mut attributes = variable.attributes.clone();
        let kind = match &variable.values {
            Values::Nothing => INTEGER,
            Values::Along(..) => DOUBLE,
            Values::Cells(cells) if cells.are_whole() => INTEGER,
            Values::Cells(..) => {
                attributes.0.push(("_FillValue".to_owned(), Attribute::Float(f32::NAN)));
                FLOAT
            }
        };
        self.attributes(&attributes);
        self.word(kind);
        self.word(length);
    }
}

fn big_endian<T: Copy, const N: usize>(numbers: &[T], bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    numbers.iter().flat_map(|number| bytes(*number)).collect()
}

fn numbers(values: &Values<'_>, file: &mut Vec<u8>) {
    match values {
        Values::Nothing => file.extend(0_i32.to_be_bytes()),
        Values::Along(_, centres) => file.extend(big_endian(centres, f64::to_be_bytes)),
        Values::Cells(cells) => {
            for row in 0..cells.size().rows {
                let bytes = |x: usize| cells.bytes(cells.at(x, row), Order::Big);
                file.extend((0..cells.size().columns).flat_map(bytes));
            }
        }
    }
}
