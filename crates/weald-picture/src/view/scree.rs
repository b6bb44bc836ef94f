//! Where stones that fall from cliffs come to lie: on what is steep enough for them to roll, below bare rock.

use rayon::prelude::*;

use super::vector::ramp;
use weald_core::grid::{Field, Size};

/// Cells that stones roll, and what is left of them a cell further on.
const ROLLED: usize = 12;
const LEFT: f32 = 0.87;

/// Fall over run on which stones still roll.
const ROLLS: f32 = 0.42;

/// From 0 to 1, how much of what lies on each cell has fallen from rock that is bare from a slope on.
pub(super) fn fallen(height: &Field, spacing: [f32; 2], rock: f32) -> Field {
    let size = height.size();
    let steep = |cell: usize| {
        let (x, y) = (cell % size.columns, cell / size.columns);
        let rise =
            |a: [usize; 2], b: [usize; 2], run: f32| (height.at(b[0], b[1]) - height.at(a[0], a[1])) / run;
        let (left, right) = (x.saturating_sub(1), (x + 1).min(size.columns - 1));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(size.rows - 1));
        let east = rise([left, y], [right, y], ((right - left) as f32 * spacing[0]).max(1e-6));
        let south = rise([x, above], [x, below], ((below - above) as f32 * spacing[1]).max(1e-6));
        ramp((east * east + south * south).sqrt() / rock, 1.0, 1.2)
    };
    let mut fallen: Vec<f32> = (0..size.cells()).into_par_iter().map(steep).collect();
    for _ in 0..ROLLED {
        let mut next = fallen.clone();
        let rows = next.par_chunks_mut(size.columns).enumerate();
        rows.for_each(|(y, row)| roll(row, y, (&fallen, height), spacing));
        fallen = next;
    }
    Field::from_values(size, fallen)
}

/// Lets stones roll one cell further into a row.
fn roll(row: &mut [f32], y: usize, (fallen, height): (&[f32], &Field), spacing: [f32; 2]) {
    let size: Size = height.size();
    let heights = height.values();
    let [across, down] = spacing;
    let slant = (across * across + down * down).sqrt();
    for (x, most) in row.iter_mut().enumerate() {
        let here = heights[y * size.columns + x];
        for beside in y.saturating_sub(1)..(y + 2).min(size.rows) {
            for other in x.saturating_sub(1)..(x + 2).min(size.columns) {
                let from = beside * size.columns + other;
                let left = LEFT * fallen[from];
                // Nothing has fallen on most cells, which is known soonest.
                if left <= *most {
                    continue;
                }
                let run = match (beside == y, other == x) {
                    (true, _) => across,
                    (false, true) => down,
                    (false, false) => slant,
                };
                if heights[from] - here > ROLLS * run {
                    *most = left;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stones_lie_below_a_cliff_and_not_above_it_nor_out_on_the_plain() {
        // A plain, a slope of 0.6, a cliff and a plateau, from left to right; cells of 10 m.
        let profile = |x: usize| match x {
            0..20 => 0.0,
            20..30 => 6.0 * (x - 19) as f32,
            30..34 => 60.0 + 25.0 * (x - 29) as f32,
            _ => 160.0,
        };
        let height = Field::from_function(Size::new(60, 9).expect("small"), |x, _| profile(x));
        let fallen = fallen(&height, [10.0; 2], 1.0);
        let at = |x: usize| fallen.at(x, 4);
        assert!(at(28) > 0.5 && at(24) > 0.3, "{} and {}", at(28), at(24));
        assert!(at(10) == 0.0 && at(45) == 0.0, "{} and {}", at(10), at(45));
    }
}
