//! A grid in cells, workgroups and bytes.

use weald::Error;
use weald::engine::program::{Buffer, COUNTED, Content, GROUP, Program};
use weald::error::{DeviceError, DeviceErrorKind, Quantity, bytes_in_words};
use weald::grid::Size;

use super::parts::Part;
use crate::gpu::Gpu;
use crate::memory::too_many_bytes;

/// Bytes of one sum of one workgroup: a total and its rounding error.
const SUM_BYTES: usize = 8;

/// A grid that a program works on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extents {
    pub(crate) size: Size,
    /// Workgroups from west to east.
    pub(crate) across: usize,
    /// Workgroups from north to south.
    pub(crate) down: usize,
    /// Rows of workgroups from one place where a dispatch may begin to the next.
    pub(crate) unit: usize,
}

impl Extents {
    /// A grid on which dispatches begin at no more than so many places.
    pub(crate) fn of(size: Size, places: usize) -> Self {
        let [across, down] = [size.columns, size.rows].map(|cells| cells.div_ceil(GROUP));
        Self { size, across, down, unit: down.div_ceil(places).max(1) }
    }

    /// Places where a dispatch may begin.
    pub(crate) fn units(self) -> usize {
        self.down.div_ceil(self.unit)
    }

    fn cells(self) -> u64 {
        product([self.size.columns, self.size.rows, 1, 1])
    }

    /// Bytes that hold the sums of all workgroups.
    pub(crate) fn sums_bytes(self) -> u64 {
        product([self.across, self.down, COUNTED, SUM_BYTES])
    }

    /// Workgroups of a part, from north to south.
    pub(crate) fn rows(self, part: Part) -> usize {
        (part.units * self.unit).min(self.down - part.first * self.unit)
    }

    /// Whether another grid has room where this one has.
    pub(crate) fn hold(self, other: Self) -> bool {
        self.cells() >= other.cells() && self.sums_bytes() >= other.sums_bytes()
    }

    /// Refuses what no device can do.
    pub(crate) fn check(self, gpu: &Gpu, program: &Program) -> Result<(), Error> {
        let Size { columns, rows } = self.size;
        let most = gpu.context.limits.max_compute_workgroups_per_dimension as usize;
        if columns == 0 || rows == 0 || self.across > most || self.down > most {
            let most = most * GROUP;
            let message =
                format!("the GPU cannot work on {columns} × {rows} cells; each side may have 1 to {most}");
            let asked = if columns.min(rows) == 0 { 0 } else { columns.max(rows) };
            let (what, asked, allowed) = (Quantity::CellsPerSide, asked as u64, 1..=most as u64);
            let kind = DeviceErrorKind::OverLimit { what, asked, allowed };
            return Err(DeviceError::new(kind, message).into());
        }
        let named = program.buffers.iter().map(|buffer| (buffer.name, bytes(buffer, self.size)));
        let largest = gpu.largest_binding();
        match named.max_by_key(|&(_, bytes)| bytes) {
            Some((name, bytes)) if bytes > largest => {
                let message = format!(
                    "buffer `{name}` of `{}` takes {} for {columns} × {rows} cells; {} allows {}; use a smaller \
                     grid or --engine cpu",
                    program.name,
                    bytes_in_words(bytes),
                    gpu.context.adapter,
                    bytes_in_words(largest)
                );
                Err(DeviceError::new(too_many_bytes(bytes, largest), message).into())
            }
            _ => Ok(()),
        }
    }
}

/// Bytes of a buffer over a grid; the greatest number where none holds them.
pub(crate) fn bytes(buffer: &Buffer, size: Size) -> u64 {
    match buffer.content {
        Content::Table(elements) => product([4, buffer.lanes, elements, 1]),
        _ => product([4, buffer.lanes, size.columns, size.rows]),
    }
}

fn product(factors: [usize; 4]) -> u64 {
    factors.iter().fold(1, |product: u64, &factor| product.saturating_mul(factor as u64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_all_rows_of_workgroups_where_places_are_few() {
        let size = Size { columns: 100, rows: 1000 };
        let extents = Extents::of(size, 10);
        assert_eq!((extents.across, extents.down, extents.unit, extents.units()), (7, 63, 7, 9));
        let rows = |first| extents.rows(Part { step: 0, pass: 0, first, units: 1 });
        assert_eq!((0..9).map(rows).sum::<usize>(), 63);
    }

    #[test]
    fn a_size_beyond_all_numbers_takes_the_greatest_number_of_bytes() {
        let size = Size { columns: usize::MAX, rows: usize::MAX };
        let buffer = Buffer::new("vast", 4, Content::Scratch);
        assert_eq!(bytes(&buffer, size), u64::MAX);
    }
}
