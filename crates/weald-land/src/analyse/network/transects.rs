//! Valleys as the rows and columns of the grid cut them: how far apart, how wide, of what shape.
//!
//! Along a line, heights are followed from turn to turn; a turn counts where the ground then rises or falls by
//! a cell or more. A valley is a low turn between two high ones, as deep as the lower of them stands above it.

use super::ground::Ground;

/// Rise or fall that makes a turn, in cells.
const MIN_DEPTH: f64 = 1.0;

/// Mean form of the valleys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValleyForm {
    /// Length of all lines over the number of valleys on them, in cells. Lines that cross a valley aslant see it
    /// wider, so only landscapes without a common grain compare.
    pub spacing: f64,
    /// Mean width at half their depth, in cells.
    pub width: f64,
    /// Mean ratio of the widths at a quarter and at three quarters of the depth: a third for a V, a half for a
    /// sine, 1 for a slot with upright walls.
    pub shape: f64,
    /// Mean depth in cells.
    pub depth: f64,
}

/// The form of the valleys; `None` where there are none.
pub(super) fn valley_form(ground: &Ground<'_>) -> Option<ValleyForm> {
    let mut sums = Sums::default();
    for line in lines(ground) {
        sums.length += line.len() as f64;
        for valley in valleys(&line) {
            sums.add(&line, &valley);
        }
    }
    (sums.count > 0.0).then(|| ValleyForm {
        spacing: sums.length / sums.count,
        width: sums.width / sums.count,
        shape: sums.shape / sums.count,
        depth: sums.depth / sums.count,
    })
}

#[derive(Default)]
struct Sums {
    length: f64,
    count: f64,
    width: f64,
    shape: f64,
    depth: f64,
}

impl Sums {
    fn add(&mut self, line: &[f64], valley: &Valley) {
        let width = |share: f64| width(line, valley, share);
        self.count += 1.0;
        self.width += width(0.5);
        self.shape += width(0.25) / width(0.75);
        self.depth += valley.depth;
    }
}

/// Unbroken stretches of land along all rows and columns.
fn lines(ground: &Ground<'_>) -> Vec<Vec<f64>> {
    let size = ground.size;
    let rows = (0..size.rows).map(|y| (0..size.columns).map(|x| size.index(x, y)).collect());
    let columns = (0..size.columns).map(|x| (0..size.rows).map(|y| size.index(x, y)).collect());
    let all = rows.chain(columns).collect::<Vec<Vec<usize>>>();
    let stretches = all.iter().flat_map(|line| line.split(|&cell| !ground.is_valid(cell)));
    stretches.map(|cells| cells.iter().map(|&cell| ground.height[cell]).collect()).collect()
}

/// A low turn, and how far the lower of the high turns beside it stands above.
struct Valley {
    lowest: usize,
    depth: f64,
}

fn valleys(line: &[f64]) -> Vec<Valley> {
    let turns = turns(line);
    let triples = turns.windows(3).filter(|turns| line[turns[1]] < line[turns[0]]);
    triples
        .map(|turns| Valley { lowest: turns[1], depth: line[turns[0]].min(line[turns[2]]) - line[turns[1]] })
        .collect()
}

/// Places where the line turns, high and low by turns. Its ends count if the way to the next turn is long enough.
fn turns(line: &[f64]) -> Vec<usize> {
    let mut turns = Vec::new();
    let (mut lowest, mut highest) = (0, 0);
    let mut rising = None;
    for (place, &height) in line.iter().enumerate() {
        if height < line[lowest] {
            lowest = place;
        }
        if height > line[highest] {
            highest = place;
        }
        if rising != Some(true) && height - line[lowest] >= MIN_DEPTH {
            turns.push(lowest);
            (rising, highest) = (Some(true), place);
        } else if rising != Some(false) && line[highest] - height >= MIN_DEPTH {
            turns.push(highest);
            (rising, lowest) = (Some(false), place);
        }
    }
    match rising {
        Some(true) => turns.push(highest),
        Some(false) => turns.push(lowest),
        None => {}
    }
    turns
}

/// Width in cells at a share of the depth, heights in between being linear.
fn width(line: &[f64], valley: &Valley, share: f64) -> f64 {
    let level = line[valley.lowest] + share * valley.depth;
    let up = |next: &dyn Fn(usize) -> usize| {
        let mut place = valley.lowest;
        let mut steps = 0.0;
        while line[next(place)] < level {
            place = next(place);
            steps += 1.0;
        }
        steps + (level - line[place]) / (line[next(place)] - line[place])
    };
    up(&|place| place + 1) + up(&|place| place - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    fn form(height: impl Fn(f64) -> f64) -> Option<ValleyForm> {
        let size = Size::new(600, 4).expect("legal");
        let height = (0..size.cells()).map(|cell| height((cell % 600) as f64)).collect();
        let ground = Ground { size, valid: None, height, depth: vec![0.0; size.cells()] };
        valley_form(&ground)
    }

    /// Rows alone cross the valleys; columns add their length.
    fn spacing_by_rows(form: &ValleyForm) -> f64 {
        form.spacing / 2.0
    }

    #[test]
    fn furrows_of_triangles_are_v_shaped_and_a_wavelength_apart() {
        let form = form(|x| 0.5 * (x % 20.0 - 10.0).abs()).expect("valleys");
        assert!((spacing_by_rows(&form) - 20.0).abs() < 0.1, "{form:?}");
        assert!((form.width - 10.0).abs() < 0.1 && (form.depth - 5.0).abs() < 0.1, "{form:?}");
        assert!((form.shape - 1.0 / 3.0).abs() < 0.01, "{form:?}");
    }

    #[test]
    fn slots_are_as_wide_below_as_above_and_waves_lie_between() {
        let slots = form(|x| if x % 20.0 < 12.0 { 0.0 } else { 30.0 }).expect("valleys");
        assert!(slots.shape > 0.85, "{slots:?}");
        let waves = form(|x| 4.0 * libm::sin(x / 40.0 * std::f64::consts::TAU)).expect("valleys");
        assert!((waves.shape - 0.5).abs() < 0.01, "{waves:?}");
    }

    #[test]
    fn dents_of_less_than_a_cell_are_no_valleys() {
        assert_eq!(form(|x| x + 0.4 * (x % 2.0)), None);
        let form = form(|x| 0.5 * (x % 20.0 - 10.0).abs() + 0.3 * (x % 2.0)).expect("valleys");
        assert!((spacing_by_rows(&form) - 20.0).abs() < 0.1, "{form:?}");
    }
}
