//! The shape of a height contour around a centre: its radius by direction.
//!
//! Between cells the height is bilinear. Used for the cone test of thermal weathering (Han 2015, Fig. 2): an
//! isotropic rule leaves a circle, a rule by axes a square.

use weald_core::grid::Field;

/// Cells between the heights that are compared along a ray.
const STRIDE: f64 = 0.25;

/// Distance in cells from `centre` (column and row) to the first point where the height passes `level`, in
/// each of `directions` evenly spaced directions from east over south. `None` where the ray leaves the grid
/// without passing it.
pub fn radii(height: &Field, centre: [f64; 2], level: f64, directions: usize) -> Vec<Option<f64>> {
    let turn = |direction: usize| std::f64::consts::TAU * direction as f64 / directions as f64;
    (0..directions).map(|direction| radius(height, centre, level, turn(direction))).collect()
}

/// Least over greatest radius of a contour: 1 for a circle, 0.71 for a square. `None` where the contour is not
/// closed within the grid.
pub fn roundness(height: &Field, centre: [f64; 2], level: f64) -> Option<f64> {
    let radii: Vec<f64> = radii(height, centre, level, 360).into_iter().collect::<Option<_>>()?;
    let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = radii.iter().copied().fold(0.0, f64::max);
    Some(least / greatest)
}

fn radius(height: &Field, centre: [f64; 2], level: f64, angle: f64) -> Option<f64> {
    let [east, south] = [libm::cos(angle), libm::sin(angle)];
    let above = |distance: f64| {
        Some(bilinear(height, centre[0] + distance * east, centre[1] + distance * south)? - level)
    };
    let mut inner = above(0.0)?;
    for step in 1.. {
        let outer = above(f64::from(step) * STRIDE)?;
        if (inner > 0.0) != (outer > 0.0) {
            let share = inner / (inner - outer);
            return Some((f64::from(step - 1) + share) * STRIDE);
        }
        inner = outer;
    }
    None
}

/// Height at a place between cell centres; `None` outside the outermost centres.
fn bilinear(field: &Field, x: f64, y: f64) -> Option<f64> {
    let size = field.size();
    let inside = |place: f64, count: usize| place >= 0.0 && place <= (count - 1) as f64;
    if !inside(x, size.columns) || !inside(y, size.rows) {
        return None;
    }
    let (column, row) = (x as usize, y as usize);
    let (tx, ty) = (x - column as f64, y - row as f64);
    let at = |dx: usize, dy: usize| {
        f64::from(field.at((column + dx).min(size.columns - 1), (row + dy).min(size.rows - 1)))
    };
    let north = at(0, 0) * (1.0 - tx) + at(1, 0) * tx;
    let south = at(0, 1) * (1.0 - tx) + at(1, 1) * tx;
    Some(north * (1.0 - ty) + south * ty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    fn ground(height: impl Fn(f64, f64) -> f64) -> Field {
        let size = Size::square(129).expect("legal");
        Field::from_function(size, |x, y| height(x as f64 - 64.0, y as f64 - 64.0) as f32)
    }

    #[test]
    fn a_round_cone_has_a_round_contour_of_the_right_radius() {
        let cone = ground(|x, y| 64.0 - (x * x + y * y).sqrt());
        assert!(roundness(&cone, [64.0, 64.0], 32.0).expect("closed") > 0.999);
        assert!(radii(&cone, [64.0, 64.0], 44.0, 8).iter().all(|r| (r.expect("closed") - 20.0).abs() < 0.01));
    }

    #[test]
    fn a_pyramid_has_a_square_contour() {
        let pyramid = ground(|x, y| 64.0 - x.abs().max(y.abs()));
        let roundness = roundness(&pyramid, [64.0, 64.0], 32.0).expect("closed");
        assert!((roundness - 0.5_f64.sqrt()).abs() < 0.005, "{roundness}");
    }

    #[test]
    fn a_contour_that_leaves_the_grid_has_no_roundness() {
        assert_eq!(roundness(&ground(|x, _| x), [64.0, 64.0], 10.0), None);
    }
}
