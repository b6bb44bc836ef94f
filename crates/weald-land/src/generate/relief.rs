//! Heights brought to a stated relief: the lowest point to 0, the highest to `relief`.

use rayon::prelude::*;

use weald_core::grid::Field;

/// Cells a task works on; the result does not depend on it.
const CELLS_PER_TASK: usize = 1 << 16;

/// Maps the field's range to `0..relief`. A flat field becomes 0 everywhere.
pub fn rescale(field: &mut Field, relief: f32) {
    let (low, high) = range(field.values());
    let span = high - low;
    field.values_mut().par_chunks_mut(CELLS_PER_TASK).for_each(|chunk| {
        for value in chunk {
            // Dividing first gives exactly 1 at the highest point.
            *value = if span > 0.0 { (*value - low) / span * relief } else { 0.0 };
        }
    });
}

fn range(values: &[f32]) -> (f32, f32) {
    let nothing = (f32::INFINITY, f32::NEG_INFINITY);
    let wider = |a: (f32, f32), b: (f32, f32)| (a.0.min(b.0), a.1.max(b.1));
    values.par_chunks(CELLS_PER_TASK).map(chunk_range).reduce(|| nothing, wider)
}

/// Sixteen lanes, since a lone running minimum is one long chain of dependent operations.
fn chunk_range(chunk: &[f32]) -> (f32, f32) {
    let mut low = [f32::INFINITY; 16];
    let mut high = [f32::NEG_INFINITY; 16];
    let (lanes, rest) = chunk.as_chunks::<16>();
    for values in lanes {
        for lane in 0..16 {
            low[lane] = low[lane].min(values[lane]);
            high[lane] = high[lane].max(values[lane]);
        }
    }
    let least = rest.iter().chain(&low).copied().fold(f32::INFINITY, f32::min);
    let greatest = rest.iter().chain(&high).copied().fold(f32::NEG_INFINITY, f32::max);
    (least, greatest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn the_lowest_point_comes_to_zero_and_the_highest_to_the_relief() {
        let size = Size::new(37, 5).expect("small");
        let mut field = Field::from_function(size, |x, y| 3.7 * x as f32 - 1.1 * y as f32 - 50.0);
        rescale(&mut field, 812.5);
        assert_eq!(field.range(None), Some((0.0, 812.5)));
    }

    #[test]
    fn a_flat_field_stays_flat() {
        let mut field = Field::filled(Size::square(3).expect("small"), 4.0);
        rescale(&mut field, 100.0);
        assert_eq!(field.range(None), Some((0.0, 0.0)));
    }
}
