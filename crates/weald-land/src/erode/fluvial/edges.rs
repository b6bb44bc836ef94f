//! Sums over the eight edges of a cell.
//!
//! Fluxes are positive to the east, south, south-east and south-west. Those of the axes come as east, west, south,
//! north; those of the diagonals as south-east, north-west, south-west, north-east.

/// Conductance of a pipe along the axes. With [`PIPE_DIAGONAL`] a slope drives water down itself in every direction alike
/// (`w_a + 2 w_d = 1`). How far water spreads to the sides on its way decides where it gathers: what runs down an axis
/// has the variance `2 w_d` across it a cell, what runs down a diagonal `w_a / √2`. The nine-point Laplacian, with 2/3
/// and 1/6, spreads 1.4 times as much along diagonals, and rills run along the axes; `2 - √2` spreads alike. A little
/// less makes up for single diagonal channels being narrower than a cell: relief at 2.5 to 5 cells had 1.8 times the
/// power along the axes with 2/3, 1.35 times with `2 - √2`, 1.2 times with this.
pub(crate) const PIPE_AXIS: f32 = 0.54;

/// Conductance of a pipe along the diagonals.
pub(crate) const PIPE_DIAGONAL: f32 = 0.23;

/// Conductance of an edge along the axes for what creeps and slides: with [`DIAGONAL`] the isotropic nine-point
/// Laplacian.
pub(crate) const AXIS: f32 = 2.0 / 3.0;

/// Conductance of an edge along the diagonals.
pub(crate) const DIAGONAL: f32 = 1.0 / 6.0;

/// Squared discharge below which water counts as still.
const STILL: f32 = 1e-30;

/// How much more the cells of a staircase concentrate their flow than a sheet does: a single channel along an axis half
/// as much.
const MOST_GATHERED: f32 = 2.0 / PIPE_AXIS;

/// The discharge of a cell as the mean over its edges: `q = ½ Σ f e`, with `e` the vector of the edge.
pub(super) struct Discharge {
    /// `|q|`, in cells² a step.
    pub(super) size: f32,
    /// `½ Σ f²/w / q²`: 1 where water flows as a sheet, 1.9 in a single channel along an axis, 2.2 in one along a
    /// diagonal.
    pub(super) gathered: f32,
    /// `½ Σ |f|`: all that runs through the cell, whichever way it turns in it.
    through: f32,
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
        let energy = squares(axes) * (0.5 / PIPE_AXIS) + squares(diagonals) * (0.5 / PIPE_DIAGONAL);
        let square = eastward * eastward + southward * southward;
        let gathered =
            if square > STILL { (energy / square).clamp(1.0, MOST_GATHERED) } else { MOST_GATHERED };
        let sizes = |[a, b, c, d]: [f32; 4]| (a.abs() + b.abs()) + (c.abs() + d.abs());
        let through = 0.5 * (sizes(axes) + sizes(diagonals));
        Self { size: square.sqrt(), gathered, through }
    }

    /// Share of the ground that the channels of this discharge take, at most 1, and its reciprocal. A sheet gathers in channels that lie
    /// `gathering` cells apart; what has gathered in a cell is one channel, which carries all that runs through and is
    /// as long as its water is displaced: `|q| / through`, 1 along an axis, √2 along a diagonal, 1/√2 in each cell of a
    /// staircase. Its width in cells is `channel_width` times the root of its discharge.
    #[inline(always)]
    pub(super) fn occupied(&self, gathering: f32, channel_width: f32) -> [f32; 2] {
        let single = ((self.gathered - 1.0) * 2.0).clamp(0.0, 1.0);
        let apart = gathering + (1.0 - gathering) * single;
        let carried = self.size + (self.through - self.size) * single;
        // Width times length, over the distance of the channels: `ground / √square`. It and its reciprocal wait for one
        // division and one root, which are worked out side by side.
        let ground = (channel_width * larger(self.size, SHORTEST * carried)).max(LEAST_CARRIED);
        let square = (carried * apart).max(LEAST_CARRIED);
        let (root, both) = (square.sqrt(), 1.0 / (square * ground));
        let share = root * (ground * (ground * both));
        [share.clamp(LEAST_OCCUPIED, 1.0), (root * (square * both)).clamp(1.0, 1.0 / LEAST_OCCUPIED)]
    }
}

/// Shortest way of a channel through a cell. Water that springs in it or turns back is hardly displaced, and yet no
/// knife.
const SHORTEST: f32 = 0.5;

/// Numbers of water that are as good as none where something is divided by them.
const LEAST_CARRIED: f32 = 1e-18;

/// The larger of two numbers.
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    // Unlike `max` it need not find out which one is not a number, which takes three instructions.
    if a > b { a } else { b }
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
        let [main, other] = [PIPE_DIAGONAL * (x + y), PIPE_DIAGONAL * (y - x)];
        ([PIPE_AXIS * x, PIPE_AXIS * x, PIPE_AXIS * y, PIPE_AXIS * y], [main, main, other, other])
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
        assert!((along_axis.gathered - 1.852).abs() < 1e-3 && (along_diagonal.gathered - 2.174).abs() < 1e-3);
        let shares = [along_axis, along_diagonal].map(|discharge| discharge.occupied(1.0, 0.3)[0]);
        let longer = std::f32::consts::SQRT_2;
        assert!((shares[0] - 0.3).abs() < 1e-6 && (shares[1] - 0.3 * longer).abs() < 1e-6, "{shares:?}");
        // In from the west, out to the south; and on to the south-east.
        let bent = Discharge::of([0.0, 1.0, 1.0, 0.0], [0.0; 4]).occupied(1.0, 0.3)[0];
        assert!(
            (bent - 0.3 / longer).abs() < 1e-6,
            "two cells of a staircase are as long as a diagonal: {bent}"
        );
        // Out to all sides.
        let spring = Discharge::of([1.0, -1.0, 1.0, -1.0], [0.0; 4]).occupied(1.0, 0.3)[0];
        assert!((spring - 0.5 * 0.3 * 2.0_f32.sqrt()).abs() < 1e-6, "{spring}");
        let between = Discharge::of([0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]).occupied(1.0, 0.3)[0];
        assert!((between - 0.3 * 1.25_f32.sqrt()).abs() < 1e-6, "{between}");
    }

    #[test]
    fn still_water_has_neither_discharge_nor_width() {
        let still = Discharge::of([0.0; 4], [0.0; 4]);
        assert_eq!((still.size, still.occupied(1.0, 1.0)), (0.0, [LEAST_OCCUPIED, 1.0 / LEAST_OCCUPIED]));
    }
}
