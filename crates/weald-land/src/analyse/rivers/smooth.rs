//! Takes the staircase of eight directions out of rivers: they run in the valley between the centres of cells.
//!
//! Every cell of a river has one place, which moves towards the middle of its neighbours on the main stem and to the
//! lowest line of the valley, again and again, as an active contour (Kass, Witkin, Terzopoulos 1988, "Snakes", doi
//! 10.1007/BF00133570), but never leaves the circle that its cell holds, so that rivers side by side stay apart. Reaches
//! that meet still do, and a main stem runs through a confluence without a bend; heads and mouths stay.

use weald_core::grid::{Field, Size};

/// Passes that draw rivers tight and into their valleys, and those after them that only draw them tight.
const PASSES: usize = 30;
const LAST_PASSES: usize = 6;

/// Farthest that a place moves from the centre of its cell, in cells. With a whole cell rivers crossed others.
const FARTHEST: f64 = 0.5;

/// Part of the way to the lowest line of the valley that a place goes in a pass.
const TO_VALLEY: f64 = 0.5;

/// A cell of a river.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Its centre in cells from the western and the northern edge of the grid.
    pub(super) home: [f64; 2],
    /// Numbers of the nodes above, on the main stem, and below; an end lacks one and stays.
    pub(super) beside: Option<[usize; 2]>,
}

/// Where each node lies in the end, in cells; `ground` has heights in any unit.
pub(super) fn smooth(nodes: &[Node], ground: Option<&Field>) -> Vec<[f64; 2]> {
    let mut places: Vec<_> = nodes.iter().map(|node| node.home).collect();
    for pass in 0..PASSES + LAST_PASSES {
        let before = places.clone();
        for ((node, place), own) in nodes.iter().zip(&mut places).zip(&before) {
            let Some([above, below]) = node.beside.map(|beside| beside.map(|at| before[at])) else {
                continue;
            };
            let mut wanted = [0, 1].map(|axis| 0.25 * (above[axis] + 2.0 * own[axis] + below[axis]));
            if let Some(ground) = ground.filter(|_| pass < PASSES) {
                let along = [below[0] - above[0], below[1] - above[1]];
                let length = libm::hypot(along[0], along[1]).max(f64::MIN_POSITIVE);
                let across = [-along[1] / length, along[0] / length];
                let aside = TO_VALLEY * lowest(ground, wanted, across);
                wanted = [0, 1].map(|axis| wanted[axis] + aside * across[axis]);
            }
            *place = within_reach(node.home, wanted);
        }
    }
    places
}

fn within_reach(home: [f64; 2], place: [f64; 2]) -> [f64; 2] {
    let (x, y) = (place[0] - home[0], place[1] - home[1]);
    let share = (FARTHEST / libm::hypot(x, y).max(FARTHEST)).min(1.0);
    [home[0] + share * x, home[1] + share * y]
}

/// How far the lowest line of the valley lies from a place along a unit vector, in cells: at most half a cell, and 0
/// where the ground is no valley.
fn lowest(ground: &Field, place: [f64; 2], across: [f64; 2]) -> f64 {
    let beside = |side: f64| height_at(ground, [0, 1].map(|axis| place[axis] + side * across[axis]));
    let [left, here, right] = [beside(-1.0), beside(0.0), beside(1.0)];
    let bend = left + right - 2.0 * here;
    if bend > 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// Bilinear between the centres of cells.
fn height_at(ground: &Field, place: [f64; 2]) -> f64 {
    let Size { columns, rows } = ground.size();
    let span = |place: f64, count: usize| {
        let place = (place - 0.5).clamp(0.0, (count - 1) as f64);
        let first = place as usize;
        (first, (first + 1).min(count - 1), place - first as f64)
    };
    let ((west, east, across), (north, south, down)) = (span(place[0], columns), span(place[1], rows));
    let of = |x, y| f64::from(ground.at(x, y));
    let row = |y| of(west, y) + across * (of(east, y) - of(west, y));
    row(north) + down * (row(south) - row(north))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A river of one line.
    fn stem(line: &[[f64; 2]]) -> Vec<Node> {
        let is_end = |at: usize| at == 0 || at + 1 == line.len();
        let beside = |at: usize| (!is_end(at)).then(|| [at - 1, at + 1]);
        line.iter().enumerate().map(|(at, &home)| Node { home, beside: beside(at) }).collect()
    }

    fn turning(line: &[[f64; 2]]) -> f64 {
        let heading = |pair: &[[f64; 2]]| libm::atan2(pair[1][1] - pair[0][1], pair[1][0] - pair[0][0]);
        let headings: Vec<f64> = line.windows(2).map(heading).collect();
        headings.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
    }

    #[test]
    fn a_staircase_becomes_nearly_straight_between_ends_that_stay() {
        let line: Vec<[f64; 2]> = (0..40).map(|at| [f64::from(at), f64::from(at / 3)]).collect();
        let smooth = smooth(&stem(&line), None);
        assert!(turning(&line) > 15.0);
        assert!(turning(&smooth) < 0.1 * turning(&line), "{}", turning(&smooth));
        assert_eq!((smooth[0], smooth[39]), (line[0], line[39]));
    }

    #[test]
    fn no_point_leaves_its_cell_by_more_than_half_a_cell() {
        let line: Vec<[f64; 2]> = (0..20).map(|at| [f64::from(at), f64::from(at % 2 * 9)]).collect();
        let moved = smooth(&stem(&line), None);
        let far = |(a, b): (&[f64; 2], &[f64; 2])| libm::hypot(a[0] - b[0], a[1] - b[1]);
        assert!(line.iter().zip(&moved).map(far).all(|far| far <= 0.5 + 1e-12));
        assert!(far((&line[5], &moved[5])) > 0.4);
    }

    #[test]
    fn lines_of_one_and_two_points_stay() {
        for line in [vec![[1.5, 2.5]], vec![[1.5, 2.5], [2.5, 3.5]]] {
            assert_eq!(smooth(&stem(&line), None), line);
        }
    }

    #[test]
    fn a_river_lies_on_the_line_of_its_valley_at_ten_angles() {
        for degrees in [0.0, 5.0, 10.0, 15.0, 22.5, 26.565, 30.0, 35.0, 40.0, 45.0_f64] {
            let slope = libm::tan(degrees.to_radians());
            let middle = |x: f64| 8.3 + slope * x;
            let away = |[x, y]: [f64; 2]| (y - middle(x)) * libm::cos(degrees.to_radians());
            let size = Size::new(48, 64).expect("small");
            let ground = Field::from_function(size, |x, y| {
                let away = away([x as f64 + 0.5, y as f64 + 0.5]);
                (4.0 * away * away - 0.1 * x as f64) as f32
            });
            let line: Vec<_> =
                (0..48).map(|x| f64::from(x) + 0.5).map(|x| [x, middle(x).floor() + 0.5]).collect();
            let smooth = smooth(&stem(&line), Some(&ground));
            let farthest = smooth[6..42].iter().map(|&place| away(place).abs()).fold(0.0, f64::max);
            assert!(farthest < 0.1, "{degrees}°: {farthest} cells off");
        }
    }
}
