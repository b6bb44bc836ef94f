//! How steeply the ground rises to the horizon around each cell, for rows of cells at once.
//!
//! From a cell one looks along sixteen directions, at distances that grow by a fifth, over ground that is averaged over wider
//! squares as it is further away. All cells of a row look the same way at the same distance, so that one row of averages is
//! what they see. Nelson Max 1988, "Horizon mapping: shadows for bump-mapped surfaces", doi 10.1007/BF01905562.

use weald_core::grid::{Field, Size};
use weald_core::vectors;

/// Directions in which horizons are sought.
pub(super) const DIRECTIONS: usize = 16;

/// Distance of the first look in cells, and how much further each next one is.
const FIRST: f32 = 0.75;
const FURTHER: f32 = 1.22;

/// Horizons over a ground.
pub(super) struct Horizons {
    averages: Averages,
    directions: Vec<Direction>,
}

/// A direction, eastward and northward, and all looks along it, nearest first.
struct Direction {
    across: [f32; 2],
    looks: Vec<Look>,
}

/// A look from a cell.
struct Look {
    /// Cells eastward and southward.
    away: [f32; 2],
    /// Metres away.
    ray_length: f32,
    /// Level of the averages.
    level: usize,
}

/// Clockwise from north.
pub(super) fn direction_of(sector: usize) -> [f32; 2] {
    let turn = std::f32::consts::TAU * (sector as f32 + 0.5) / DIRECTIONS as f32;
    [libm::sinf(turn), libm::cosf(turn)]
}

impl Direction {
    fn of(sector: usize, size: Size, spacing: [f32; 2]) -> Self {
        let across = direction_of(sector);
        let cell = spacing[0].min(spacing[1]);
        let farthest = (size.columns as f32 * spacing[0]).hypot(size.rows as f32 * spacing[1]) / cell;
        let look = |cells: f32| {
            let ray_length = cells * cell;
            let away = [across[0] * ray_length / spacing[0], -across[1] * ray_length / spacing[1]];
            // Squares grow to a sixth of the distance.
            let level = (cells / 6.0).max(1.0).to_bits() >> 23;
            Look { away, ray_length, level: level as usize - 127 }
        };
        let cells = std::iter::successors(Some(FIRST), |cells| Some(cells * FURTHER));
        Self { across, looks: cells.take_while(|&cells| cells <= farthest).map(look).collect() }
    }
}

impl Horizons {
    /// Over cells of such sides in metres.
    pub(super) fn new(height: Field, spacing: [f32; 2]) -> Self {
        let size = height.size();
        let directions = (0..DIRECTIONS).map(|sector| Direction::of(sector, size, spacing)).collect();
        Self { averages: Averages::new(height), directions }
    }

    /// How steeply the ground rises to the horizon from each cell of a row, direction by direction; at least with the slope
    /// of the place itself, which is given eastward and northward.
    pub(super) fn row(&self, y: usize, rises: &[[f32; 2]]) -> Vec<Vec<f32>> {
        self.directions.iter().map(|direction| self.along(direction, y, rises)).collect()
    }

    fn along(&self, Direction { across, looks }: &Direction, y: usize, rises: &[[f32; 2]]) -> Vec<f32> {
        let ground = &self.averages.levels[0];
        let columns = ground.size().columns;
        let heights = &ground.values()[y * columns..(y + 1) * columns];
        let own = |rise: &[f32; 2]| (across[0] * rise[0] + across[1] * rise[1]).max(0.0);
        let mut steepest: Vec<f32> = rises.iter().map(own).collect();
        let mut there = vec![0.0; columns];
        for look in looks {
            let Some(seen) = self.averages.row(look, y, &mut there) else { break };
            let row = [&heights[seen.clone()], &there[seen.clone()]];
            if !raise(&mut steepest[seen], row, look.ray_length, self.averages.highest) {
                break;
            }
        }
        steepest
    }
}

/// Raises the horizons of cells of such heights to what they see so far away. Says whether the highest ground of all could
/// still stand above one further away.
fn raise(steepest: &mut [f32], [heights, there]: [&[f32]; 2], ray_length: f32, highest: f32) -> bool {
    let (closer, mut higher) = (1.0 / ray_length, 0);
    vectors::widest(
        #[inline(always)]
        || {
            for ((steepest, height), there) in steepest.iter_mut().zip(heights).zip(there) {
                let rise = (there - height) * closer;
                *steepest = if rise > *steepest { rise } else { *steepest };
                higher |= u32::from(highest - height >= *steepest * ray_length);
            }
        },
    );
    higher > 0
}

/// Heights averaged over squares of 1, 2, 4 … cells.
struct Averages {
    levels: Vec<Field>,
    highest: f32,
}

impl Averages {
    fn new(height: Field) -> Self {
        let highest = height.values().iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let mut levels = vec![height];
        while let Some(finer) = levels.last().filter(|field| field.size().columns.min(field.size().rows) > 3)
        {
            levels.push(halved(finer));
        }
        Self { levels, highest }
    }

    /// The heights that the cells of a row see by a look, between the four nearest averages, and which cells see any; `None`
    /// where all look beyond the border.
    fn row(&self, look: &Look, y: usize, there: &mut [f32]) -> Option<std::ops::Range<usize>> {
        let size = self.levels[0].size();
        let down = y as f32 + 0.5 + look.away[1];
        // The middle of a cell is at a half.
        let first = (-0.5 - look.away[0]).ceil().max(0.0) as usize;
        let end = (size.columns as f32 + 0.5 - look.away[0]).floor().clamp(0.0, size.columns as f32) as usize;
        if down < 0.0 || down > size.rows as f32 || first >= end {
            return None;
        }
        let level = look.level.min(self.levels.len() - 1);
        let nearer = ((1_u32 << level) as f32).recip();
        let averages = padded_row(&self.levels[level], down * nearer);
        for (x, there) in there.iter_mut().enumerate().take(end).skip(first) {
            let place = (x as f32 + 0.5 + look.away[0]) * nearer + 0.5;
            let before = (place.max(0.0) as usize).min(averages.len() - 2);
            let share = place - before as f32;
            *there = averages[before] + (averages[before + 1] - averages[before]) * share;
        }
        Some(first..end)
    }
}

/// Values along a row between two of a field, with those at both ends twice; places count rows from the upper border.
fn padded_row(field: &Field, place: f32) -> Vec<f32> {
    let columns = field.size().columns;
    let (above, below, share) = neighbours(place, field.size().rows);
    let [above, below] = [above, below].map(|row| &field.values()[row * columns..(row + 1) * columns]);
    let mut values = Vec::with_capacity(columns + 2);
    values.push(0.0);
    values.extend(above.iter().zip(below).map(|(above, below)| above + (below - above) * share));
    values[0] = values[1];
    values.push(values[columns]);
    values
}

fn halved(finer: &Field) -> Field {
    let from = finer.size();
    let size = Size { columns: from.columns.div_ceil(2), rows: from.rows.div_ceil(2) };
    Field::from_function(size, |x, y| {
        let (right, below) = ((2 * x + 1).min(from.columns - 1), (2 * y + 1).min(from.rows - 1));
        0.25 * (finer.at(2 * x, 2 * y)
            + finer.at(right, 2 * y)
            + finer.at(2 * x, below)
            + finer.at(right, below))
    })
}

/// The two cells whose centres a place lies between, and its share of the way.
#[inline(always)]
pub(super) fn neighbours(place: f32, count: usize) -> (usize, usize, f32) {
    let centred = (place - 0.5).clamp(0.0, (count - 1) as f32);
    let first = centred as usize;
    (first, (first + 1).min(count - 1), centred - first as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_between_the_middles_of_cells() {
        assert_eq!(neighbours(2.75, 10), (2, 3, 0.25));
        assert_eq!((neighbours(0.1, 10), neighbours(9.9, 10)), ((0, 1, 0.0), (9, 9, 0.0)));
    }

    #[test]
    fn a_row_sees_what_each_of_its_cells_does_and_nothing_beyond_the_border() {
        let size = Size::new(37, 21).expect("small");
        let averages = Averages::new(Field::from_function(size, |x, y| (x * x % 31 + 3 * y * y % 17) as f32));
        for (away, level) in [([0.6, -0.4], 0), ([-9.3, 4.2], 1), ([17.0, 9.5], 2), ([-30.0, -7.0], 3)] {
            let (look, mut there) = (Look { away, ray_length: 1.0, level }, vec![0.0; 37]);
            let seen = averages.row(&look, 10, &mut there).expect("some");
            let field = &averages.levels[level];
            let side = (1 << level) as f32;
            for (x, there) in there.iter().enumerate() {
                let place = [x as f32 + 0.5 + away[0], 10.5 + away[1]];
                assert_eq!(seen.contains(&x), (0.0..=37.0).contains(&place[0]), "{x} {away:?}");
                if seen.contains(&x) {
                    let (left, right, across) = neighbours(place[0] / side, field.size().columns);
                    let (above, below, down) = neighbours(place[1] / side, field.size().rows);
                    let along = |y| field.at(left, y) * (1.0 - across) + field.at(right, y) * across;
                    let expected = along(above) * (1.0 - down) + along(below) * down;
                    assert!((there - expected).abs() < 1e-3, "{there} for {expected} at {x}");
                }
            }
        }
        let beyond = Look { away: [0.0, 10.6], ray_length: 1.0, level: 0 };
        assert_eq!(averages.row(&beyond, 10, &mut [0.0; 37]), None);
    }
}
