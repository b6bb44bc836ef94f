//! Takes the staircase of eight directions out of a line.
//!
//! Points move towards the middle of their neighbours, again and again, but never leave the circle that their
//! cell holds. The ends stay, so that reaches that meet still do.

/// Passes over the line.
const PASSES: usize = 12;

/// Farthest that a point moves, in cells.
const FARTHEST: f64 = 0.5;

/// A smoother line of as many points; places are in cells.
pub(super) fn smooth(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut places = line.to_vec();
    for _ in 0..PASSES {
        let before = places.clone();
        for (at, place) in places.iter_mut().enumerate().skip(1).take(line.len().saturating_sub(2)) {
            let towards =
                |axis: usize| 0.25 * (before[at - 1][axis] + 2.0 * before[at][axis] + before[at + 1][axis]);
            *place = within_reach(line[at], [towards(0), towards(1)]);
        }
    }
    places
}

fn within_reach(home: [f64; 2], place: [f64; 2]) -> [f64; 2] {
    let (x, y) = (place[0] - home[0], place[1] - home[1]);
    let share = (FARTHEST / libm::hypot(x, y).max(FARTHEST)).min(1.0);
    [home[0] + share * x, home[1] + share * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turning(line: &[[f64; 2]]) -> f64 {
        let heading = |pair: &[[f64; 2]]| libm::atan2(pair[1][1] - pair[0][1], pair[1][0] - pair[0][0]);
        let headings: Vec<f64> = line.windows(2).map(heading).collect();
        headings.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
    }

    #[test]
    fn a_staircase_becomes_nearly_straight_between_ends_that_stay() {
        let line: Vec<[f64; 2]> = (0..40).map(|at| [f64::from(at), f64::from(at / 3)]).collect();
        let smooth = smooth(&line);
        assert!(turning(&line) > 15.0);
        assert!(turning(&smooth) < 0.2 * turning(&line), "{}", turning(&smooth));
        assert_eq!((smooth[0], smooth[39]), (line[0], line[39]));
    }

    #[test]
    fn no_point_leaves_its_cell_by_more_than_half_a_cell() {
        let line: Vec<[f64; 2]> = (0..20).map(|at| [f64::from(at), f64::from(at % 2 * 9)]).collect();
        let moved = smooth(&line);
        let far = |(a, b): (&[f64; 2], &[f64; 2])| libm::hypot(a[0] - b[0], a[1] - b[1]);
        assert!(line.iter().zip(&moved).map(far).all(|far| far <= 0.5 + 1e-12));
        assert!(far((&line[5], &moved[5])) > 0.4);
    }

    #[test]
    fn lines_of_one_and_two_points_stay() {
        for line in [vec![[1.5, 2.5]], vec![[1.5, 2.5], [2.5, 3.5]]] {
            assert_eq!(smooth(&line), line);
        }
    }
}
