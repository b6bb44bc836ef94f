//! Sums over the eight edges of a cell.
//!
//! Fluxes are positive to the east, south, south-east and south-west. Those of the axes come as east, west, south,
//! north; those of the diagonals as south-east, north-west, south-west, north-east.

/// Conductance of an edge along the axes: with [`DIAGONAL`] the isotropic nine-point Laplacian.
pub(super) const AXIS: f32 = 2.0 / 3.0;

/// Conductance of an edge along the diagonals.
pub(super) const DIAGONAL: f32 = 1.0 / 6.0;

/// Squared discharge below which water counts as still.
const STILL: f32 = 1e-30;

/// How much more a single diagonal channel concentrates its flow than a sheet does; a single channel along the axes,
/// half as much.
const MOST_GATHERED: f32 = 3.0;

/// The discharge of a cell as the mean over its edges: `q = ½ Σ f e`, with `e` the vector of the edge.
pub(super) struct Discharge {
    /// `|q|`, in cells² a step.
    pub(super) size: f32,
    /// `½ Σ f²/w / q²`: 1 where water flows as a sheet, 3/2 in a single channel along an axis, 3 in one along a
    /// diagonal.
    pub(super) gathered: f32,
}

impl Discharge {
    /// Of the fluxes of the axes and of the diagonals.
    #[inline(always)]
    pub(super) fn of(axes: [f32; 4], diagonals: [f32; 4]) -> Self {
        let [east, west, south, north] = axes;
        let [south_east, north_west, south_west, north_east] = diagonals;
        let (main, other) = (south_east + north_west, south_west + north_east);
        let eastward = 0.5 * ((east + west) + (main - other));
        let southward = 0.5 * ((south + north) + (main + other));
        let squares = |[a, b, c, d]: [f32; 4]| (a * a + b * b) + (c * c + d * d);
        let energy = 0.5 * (squares(axes) / AXIS + squares(diagonals) / DIAGONAL);
        let square = eastward * eastward + southward * southward;
        let gathered =
            if square > STILL { (energy / square).clamp(1.0, MOST_GATHERED) } else { MOST_GATHERED };
        Self { size: square.sqrt(), gathered }
    }

    /// Share of the ground that the channels of this discharge take, at most 1. A sheet gathers in channels that lie
    /// `gathering` cells apart; what has gathered in a cell is one channel. Its width in cells is `channel_width`
    /// times the root of its discharge.
    #[inline(always)]
    pub(super) fn occupied(&self, gathering: f32, channel_width: f32) -> f32 {
        let single = ((self.gathered - 1.0) * 2.0).clamp(0.0, 1.0);
        let apart = gathering + (1.0 - gathering) * single;
        // What a cell's length is to that of the channel in it: less than 1 along a diagonal.
        let along = (1.5 / self.gathered).sqrt().min(1.0);
        let width = channel_width * (self.size * apart * along).sqrt();
        (width / (apart * along)).clamp(LEAST_OCCUPIED, 1.0)
    }
}

/// Least share of the ground that channels take: trickles do not cut like knives.
const LEAST_OCCUPIED: f32 = 0.01;

/// What leaves a cell.
#[inline(always)]
pub(super) fn outflow(axes: [f32; 4], diagonals: [f32; 4]) -> f32 {
    let leaving = |[a, b, c, d]: [f32; 4]| (a.max(0.0) + (-b).max(0.0)) + (c.max(0.0) + (-d).max(0.0));
    leaving(axes) + leaving(diagonals)
}

/// Power of what leaves a cell: `Σ f ΔH`, in cells² a step; on a plane it is discharge times slope.
#[inline(always)]
pub(super) fn power(
    (axes, diagonals): ([f32; 4], [f32; 4]),
    surface: f32,
    along_axes: [f32; 4],
    along_diagonals: [f32; 4],
) -> f32 {
    let given = |[a, b, c, d]: [f32; 4], [to_a, to_b, to_c, to_d]: [f32; 4]| {
        (a.max(0.0) * (surface - to_a) + (-b).max(0.0) * (surface - to_b))
            + (c.max(0.0) * (surface - to_c) + (-d).max(0.0) * (surface - to_d))
    };
    (given(axes, along_axes) + given(diagonals, along_diagonals)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fluxes of a sheet that runs in some direction: `w (e · q)`.
    fn sheet(degrees: f64) -> ([f32; 4], [f32; 4]) {
        let (y, x) = degrees.to_radians().sin_cos();
        let (x, y) = (x as f32, y as f32);
        let [main, other] = [DIAGONAL * (x + y), DIAGONAL * (y - x)];
        ([AXIS * x, AXIS * x, AXIS * y, AXIS * y], [main, main, other, other])
    }

    #[test]
    fn a_sheet_has_the_same_discharge_and_power_in_every_direction() {
        for degrees in (0..72).map(|at| 5.0 * f64::from(at)) {
            let (axes, diagonals) = sheet(degrees);
            let discharge = Discharge::of(axes, diagonals);
            assert!((discharge.size - 1.0).abs() < 1e-6 && discharge.gathered < 1.0 + 1e-6);
            // Down a surface that falls by a tenth in the direction of the sheet.
            let (y, x) = degrees.to_radians().sin_cos();
            let at = |east: f64, south: f64| -0.1 * (east * x + south * y) as f32;
            let along_axes = [at(1.0, 0.0), at(-1.0, 0.0), at(0.0, 1.0), at(0.0, -1.0)];
            let along_diagonals = [at(1.0, 1.0), at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, -1.0)];
            let power = power((axes, diagonals), 0.0, along_axes, along_diagonals);
            assert!((power - 0.1).abs() < 1e-6, "{degrees}°: {power}");
        }
    }

    #[test]
    fn single_channels_take_as_much_ground_a_length_along_a_diagonal_as_along_an_axis() {
        let along_axis = Discharge::of([1.0, 1.0, 0.0, 0.0], [0.0; 4]);
        let along_diagonal = Discharge::of([0.0; 4], [1.0, 1.0, 0.0, 0.0]);
        assert!((along_axis.gathered - 1.5).abs() < 1e-6 && (along_diagonal.gathered - 3.0).abs() < 1e-6);
        let shares = [along_axis, along_diagonal].map(|discharge| discharge.occupied(1.0, 0.3));
        let longer = std::f32::consts::SQRT_2;
        assert!((shares[0] - 0.3).abs() < 1e-6 && (shares[1] - 0.3 * longer).abs() < 1e-6, "{shares:?}");
    }

    #[test]
    fn still_water_has_neither_discharge_nor_width() {
        let still = Discharge::of([0.0; 4], [0.0; 4]);
        assert_eq!((still.size, still.occupied(1.0, 1.0)), (0.0, LEAST_OCCUPIED));
    }
}
