//! Fields made ready for drawing: no-data filled from the nearest land, large grids averaged down to the
//! sheet.

use rayon::prelude::*;

use super::sheet::Sheet;
use weald_core::grid::{Field, Mask, Size};

/// The field with no-data cells filled, no finer than the sheet.
pub(super) fn drawable(field: &Field, land: Option<&Mask>, sheet: &Sheet) -> Field {
    match land {
        Some(land) => shrink(&fill(field, land), sheet),
        None => shrink(field, sheet),
    }
}

/// Share of land in every cell of a drawable field; `None` where all is land.
pub(super) fn land_share(land: Option<&Mask>, sheet: &Sheet) -> Option<Field> {
    let land = land?;
    let flags = land.flags().iter().map(|&land| f32::from(u8::from(land))).collect();
    Some(shrink(&Field::from_values(land.size(), flags), sheet))
}

/// Rings of filled cells that are evened out, and how often.
const EVENED: usize = 24;

/// Rings of no-data cells take the mean of their known neighbours, from the shore outward, so that slopes at
/// the shore are those of the land. Where the shore has a step, heights of both its sides would go on side by side for ever,
/// as a cliff along the diagonal: the rings next to the shore are evened out.
fn fill(field: &Field, land: &Mask) -> Field {
    let size = field.size();
    let mut filled = field.clone();
    let mut known = land.flags().to_vec();
    let mut ring: Vec<usize> =
        (0..size.cells()).filter(|&cell| !known[cell] && touches(size, &known, cell)).collect();
    if ring.is_empty() {
        filled.values_mut().fill(0.0);
    }
    let mut evened = Vec::new();
    for rings in 0.. {
        if ring.is_empty() {
            break;
        }
        if rings < EVENED {
            evened.extend_from_slice(&ring);
        }
        let means: Vec<f32> = ring
            .iter()
            .map(|&cell| mean_of_neighbours(&filled, |neighbour| known[neighbour], cell))
            .collect();
        for (&cell, mean) in ring.iter().zip(means) {
            filled.values_mut()[cell] = mean;
            known[cell] = true;
        }
        ring = ring.iter().flat_map(|&cell| size.neighbours(cell)).filter(|&cell| !known[cell]).collect();
        ring.sort_unstable();
        ring.dedup();
    }
    for _ in 0..EVENED {
        let mean = |cell: &usize| mean_of_neighbours(&filled, |_| true, *cell);
        let means: Vec<f32> = evened.par_iter().map(mean).collect();
        evened.iter().zip(means).for_each(|(&cell, mean)| filled.values_mut()[cell] = mean);
    }
    filled
}

/// Rings of cells along those without data whose heights tell little of the land: an open edge holds the first where it is,
/// while water that leaves along it wears the next.
const RIM: usize = 3;

/// The land within the rim of what has no data; all of it where no other land is.
pub(super) fn within_rim(land: &Mask) -> Mask {
    let size = land.size();
    let mut flags = land.flags().to_vec();
    for _ in 0..RIM {
        let within = |cell: usize| flags[cell] && size.neighbours(cell).all(|neighbour| flags[neighbour]);
        flags = (0..size.cells()).map(within).collect();
    }
    if flags.contains(&true) { Mask::always(size, flags) } else { land.clone() }
}

fn touches(size: Size, known: &[bool], cell: usize) -> bool {
    size.neighbours(cell).any(|neighbour| known[neighbour])
}

fn mean_of_neighbours(field: &Field, is_known: impl Fn(usize) -> bool, cell: usize) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for neighbour in field.size().neighbours(cell).filter(|&neighbour| is_known(neighbour)) {
        sum += field.values()[neighbour];
        count += 1.0;
    }
    sum / count
}

/// Means over the area of each pixel, on a grid no finer than the sheet; a coarser field comes back as it is.
///
/// The mean is of the surface that is linear between cell centres, so that a plane stays a plane.
pub(super) fn shrink(field: &Field, sheet: &Sheet) -> Field {
    let from = field.size();
    let to = Size { columns: from.columns.min(sheet.width), rows: from.rows.min(sheet.height) };
    if to == from {
        return field.clone();
    }
    let (across, down) = (means(from.columns, to.columns), means(from.rows, to.rows));
    let mut values = vec![0.0; to.cells()];
    values.par_chunks_mut(to.columns).zip(&down).for_each(|(row, rows)| {
        for &(y, weight) in rows {
            let source = field.row(y);
            for (value, columns) in row.iter_mut().zip(&across) {
                *value += weight * columns.iter().map(|&(x, share)| share * source[x]).sum::<f32>();
            }
        }
    });
    Field::from_values(to, values)
}

/// For each of `to` stretches of an axis of `from` cells, the weights of cells in its mean.
fn means(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let edge = |stretch: usize| stretch as f64 * from as f64 / to as f64 - 0.5;
    (0..to).map(|stretch| mean(from, edge(stretch), edge(stretch + 1))).collect()
}

/// Weights of cells in the mean from `start` to `end`, in cells from the first centre.
fn mean(count: usize, start: f64, end: f64) -> Vec<(usize, f32)> {
    let first = (start.floor() as isize).max(0);
    let last = (end.ceil() as isize).min(count as isize - 1);
    let mut weights = vec![0.0; (last - first + 1) as usize];
    for cell in start.floor() as isize..=end.ceil() as isize {
        let weight = (tent_below(end - cell as f64) - tent_below(start - cell as f64)) / (end - start);
        let inside = cell.clamp(first, last);
        // Beyond the border the surface goes on by point reflection.
        let mirrored = (2 * inside - cell).clamp(first, last);
        if cell == inside {
            weights[(cell - first) as usize] += weight;
        } else {
            weights[(inside - first) as usize] += 2.0 * weight;
            weights[(mirrored - first) as usize] -= weight;
        }
    }
    (first as usize..).zip(weights.into_iter().map(|weight| weight as f32)).collect()
}

/// Integral of the tent `max(0, 1 - |t|)` up to `x`.
fn tent_below(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    if x < 0.0 { 0.5 * (1.0 + x) * (1.0 + x) } else { 1.0 - 0.5 * (1.0 - x) * (1.0 - x) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;

    #[test]
    fn shrinking_keeps_the_mean() {
        let size = Size::new(37, 23).expect("legal");
        let field = Field::from_function(size, |x, y| ((x * 7 + y * 13) % 11) as f32);
        let sheet = Sheet::new(&Domain::new(size, 1.0), Some(16)).expect("legal");
        let small = shrink(&field, &sheet);
        assert_eq!(small.size().columns, 16);
        let mean = |field: &Field| field.sum() / field.size().cells() as f64;
        assert!((mean(&small) - mean(&field)).abs() < 1e-4);
    }

    #[test]
    fn a_shrunk_plane_is_a_plane() {
        let size = Size::new(300, 200).expect("legal");
        let sheet = Sheet::new(&Domain::new(size, 1.0), Some(64)).expect("legal");
        let small = shrink(&Field::from_function(size, |x, y| x as f32 + 4.0 * y as f32), &sheet);
        let rise = 4.0 * 200.0 / small.size().rows as f32;
        for y in 1..small.size().rows {
            let step = small.at(9, y) - small.at(9, y - 1);
            assert!((step - rise).abs() < 1e-3, "row {y}: {step} instead of {rise}");
        }
    }

    #[test]
    fn no_data_is_filled_with_heights_of_the_shore() {
        let size = Size::new(9, 5).expect("legal");
        let land = Mask::new(size, (0..45).map(|cell| cell % 9 < 4).collect()).expect("some no-data");
        let field = Field::from_function(size, |x, _| if x < 4 { 100.0 } else { 0.0 });
        assert!(fill(&field, &land).values().iter().all(|&height| height == 100.0));
    }

    #[test]
    fn a_step_of_the_shore_does_not_go_on_as_a_cliff() {
        let size = Size::new(60, 40).expect("legal");
        let shore = |x: usize| if x < 30 { 30 } else { 29 };
        let land = Mask::always(size, (0..2400).map(|cell| cell / 60 >= shore(cell % 60)).collect());
        let field = Field::from_function(size, |x, _| if x < 30 { 0.0 } else { 100.0 });
        let filled = fill(&field, &land);
        let cliff =
            |y: usize| (1..60).map(|x| (filled.at(x, y) - filled.at(x - 1, y)).abs()).fold(0.0, f32::max);
        assert!(cliff(10) < 12.0 && cliff(29) > 30.0, "{} and {}", cliff(10), cliff(29));
    }

    #[test]
    fn a_rim_over_worn_ground_does_not_go_on() {
        let size = Size::new(9, 5).expect("legal");
        let land = Mask::always(size, (0..45).map(|cell| cell % 9 < 6).collect());
        let field = Field::from_function(size, |x, _| if x < 3 { 40.0 } else { 100.0 });
        assert!(fill(&field, &within_rim(&land)).values().iter().all(|&height| height == 40.0));
        let thread = Mask::always(size, (0..45).map(|cell| cell % 9 == 4).collect());
        assert_eq!(within_rim(&thread), thread, "no other land");
    }
}
