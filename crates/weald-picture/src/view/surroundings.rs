//! The land and sea around a landscape, where a view has a horizon: ground that goes on beyond the border.
//!
//! At the border the ground goes on by point reflection, so that height and slope are those of the landscape and a
//! valley leads on outward:
//!
//! ```text
//! z = (1 - s) (z(b) + h(z(b) - z(m))) + s (f + a l(z(t) - z̄))
//! h(d) = d / (1 + |d| / h₀)      l(d) = d / (1 + d / d₀) for d > 0, else d
//! ```
//!
//! with the nearest place `b` of the border, the mirrored place `m` within, and the share `s`, which grows smoothly from 0
//! at the border to 1; `h` holds it near the border's height, or peaks on the border would become spikes. From there on it is
//! the ground of another place `t` of the landscape, turned by the golden angle so that nothing is seen twice side by side,
//! about the height `f` of the border in that direction; what stands far above the others is lowered by `l`, or a lone
//! mountain would stand there again and again. Where `f` lies below the sea, `a` is 0: the sea goes on.

use super::border::{DIRECTIONS, Heights, border, far};
use super::surface::Surface;
use weald_core::grain::Octaves;

/// Over how much of the landscape's longer side the ground leaves what the border was like.
pub(super) const JOIN: f32 = 0.18;

/// How far ground goes on beyond the border, in longer sides of the landscape.
pub(super) const REACH: f32 = 7.0;

/// Longer sides beyond the border after which two thirds of the land are lost before what lies farthest.
pub(super) const LOST: f32 = 2.1;

/// Cosine and sine of the golden angle.
pub(super) const TURN: [f32; 2] = [-0.737_37, 0.675_49];

/// Where the middle of the landscape comes to lie when the ground is turned, in sides from its corner.
pub(super) const TURNED_TO: [f32; 2] = [0.618, 0.382];

/// Waves of the turned ground, so that the lines along which it is mirrored are not straight: their length and height, in
/// sides of the landscape.
pub(super) const BEND: [f32; 2] = [0.55, 0.04];

/// Share of the landscape at each side that the turned ground leaves out: a border may be a base level, all of one height.
pub(super) const LEFT_OUT: f32 = 0.12;

/// Metres off its level, as it is drawn, up to which a height is that of the sea.
const AT_SEA: f32 = 0.5;

/// The height `d₀` above the mean that no ground far away reaches, in root mean squares of heights about it.
const HIGHEST: f32 = 2.5;

/// Most by which ground beyond the border rises above the border's height and sinks below it, as shares of that: peaks on
/// the border would become spikes, and ground that rises from a border of one height would be an island in a trench.
const NEAR: [f32; 2] = [0.4, 0.08];

/// Rise of a level of water from the border inward, in cells, with which two thirds of what it has of the level at the border
/// are lost: it is that of another lake, or lies below dry ground that rises.
const OTHER_LAKE: f32 = 0.25;

/// The ground around a landscape.
#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    /// Columns and rows of the landscape.
    pub(super) cells: [f32; 2],
    /// Height of the sea as it is drawn.
    pub(super) sea: Option<f32>,
    /// Mean height of the ground of the landscape.
    pub(super) mean: f32,
    /// Height above that which no ground far away reaches.
    pub(super) highest: f32,
    /// Height far away by direction, clockwise from north, and how uneven the ground there is.
    pub(super) far: [[f32; 2]; DIRECTIONS],
    /// Bounds of all heights beyond the border.
    pub(super) bounds: [f32; 2],
    /// Height that no ground exceeds where all of the border is left behind.
    pub(super) highest_far: f32,
}

/// How high the ground beyond the border is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightsBeyond {
    /// Least and greatest height of all of it.
    pub all: [f32; 2],
    /// The greatest so many cells away from the border and farther.
    pub highest_far: f32,
    /// Those cells.
    pub far_from: f32,
}

/// A place beyond the border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond {
    /// The place of the landscape that it is like.
    pub(super) place: [f32; 2],
    /// The place whose rivers run there.
    pub(super) river: [f32; 2],
    /// Height of the ground, and its rise by the cell eastward and southward.
    pub(super) surface: [f32; 3],
    /// Height and rise of the ground of the place that it is like: its beds lie by those, or walls of hard beds would have
    /// edges of others.
    pub(super) own: [f32; 3],
    /// How much of the border is left behind: 0 there, 1 far away.
    pub(super) share: f32,
}

/// How much is left behind at a place, and how fast that grows by the cell.
struct Leaving {
    border: [f32; 2],
    share: f32,
    growth: [f32; 2],
}

/// The place within a rectangle that a place is mirrored to, again and again, and the sign of directions there.
fn folded(place: [f32; 2], corner: [f32; 2], cells: [f32; 2]) -> ([f32; 2], [f32; 2]) {
    let fold = |axis: usize| {
        let turn = (place[axis] - corner[axis]) / (2.0 * cells[axis]);
        let share = turn - turn.floor();
        let sign = if share <= 0.5 { 1.0 } else { -1.0 };
        (corner[axis] + cells[axis] * (1.0 - (2.0 * share - 1.0).abs()), sign)
    };
    let ([x, across], [y, down]) = (fold(0).into(), fold(1).into());
    ([x, y], [across, down])
}

impl Surroundings {
    /// What is around ground of such a surface and a sea of a height, as they are drawn.
    pub(super) fn new(bed: &Surface, sea: Option<f32>) -> Self {
        let size = bed.size();
        let Heights { low, high, mean, deviation } = Heights::of(bed);
        let border = border(bed);
        let far = far(&border, sea, high - low);
        let edge = border.iter().fold([f32::MAX, f32::MIN], |[a, b], (_, z)| [a.min(*z), b.max(*z)]);
        let highest_far = HIGHEST * deviation.max(1e-3);
        let of_far =
            |[height, uneven]: &[f32; 2], z: f32| height + uneven * lowered(z - mean, highest_far)[0];
        let lowest = far.iter().map(|far| of_far(far, low)).fold(2.0 * edge[0] - high, f32::min);
        // Nothing stands further above the mean, whatever becomes of the landscape.
        let highest =
            far.iter().map(|[height, uneven]| height + uneven * highest_far).fold(f32::MIN, f32::max);
        let highest = highest.max(sea.unwrap_or(highest));
        // Between the middles of its cells ground is higher and lower than there, but not than its control points are.
        let [least, most] = bed.control.iter().fold([low, high], |[a, b], z| [a.min(*z), b.max(*z)]);
        let between = 2.0 * (low - least).max(most - high);
        let cells = [size.columns as f32, size.rows as f32];
        let bounds = [lowest.min(low) - between, highest.max(2.0 * edge[1] - low).max(high) + between];
        Self { cells, sea, mean, highest: highest_far, far, bounds, highest_far: highest }
    }

    /// How high the ground is.
    pub(super) fn heights(&self) -> HeightsBeyond {
        let far_from = JOIN * self.cells[0].max(self.cells[1]);
        HeightsBeyond { all: self.bounds, highest_far: self.highest_far, far_from }
    }

    /// Whether a place lies beyond the border.
    #[inline]
    pub(super) fn is_beyond(&self, place: [f32; 2]) -> bool {
        (0..2).any(|axis| place[axis] < 0.5 || place[axis] > self.cells[axis] + 0.5)
    }

    fn leaving(&self, place: [f32; 2]) -> Leaving {
        let border = [0, 1].map(|axis| place[axis].clamp(0.5, self.cells[axis] + 0.5));
        let away = [0, 1].map(|axis| place[axis] - border[axis]);
        let length = (away[0] * away[0] + away[1] * away[1]).sqrt();
        let width = JOIN * self.cells[0].max(self.cells[1]);
        let t = (length / width).min(1.0);
        let growth = 6.0 * t * (1.0 - t) / (width * length.max(1e-6));
        Leaving { border, share: t * t * (3.0 - 2.0 * t), growth: away.map(|part| part * growth) }
    }

    /// Height far away in the direction of a place, and how uneven the ground is there; and the rise of both by the cell
    /// eastward and southward, since the direction turns.
    fn far_at(&self, place: [f32; 2]) -> ([f32; 2], [[f32; 2]; 2]) {
        let [east, south] = [0, 1].map(|axis| place[axis] - 0.5 - 0.5 * self.cells[axis]);
        let turn = libm::atan2f(east, -south) / std::f32::consts::TAU;
        let at = (turn - turn.floor()) * DIRECTIONS as f32;
        let (first, t) = (at as usize, at - at.floor());
        let [one, other] = [first, first + 1].map(|direction| self.far[direction % DIRECTIONS]);
        let (share, growth) = (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t));
        let swing =
            growth * DIRECTIONS as f32 / std::f32::consts::TAU / (east * east + south * south).max(1e-6);
        let change = [0, 1].map(|part| other[part] - one[part]);
        let swings = [-south, east].map(|turned| change.map(|change| change * swing * turned));
        ([0, 1].map(|part| one[part] + change[part] * share), swings)
    }

    fn mirrored(&self, place: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        folded(place, [0.5; 2], self.cells)
    }

    /// The place whose ground is far away at another, and what a rise there becomes: eastward and southward here, of those
    /// there.
    fn turned(&self, place: [f32; 2]) -> ([f32; 2], [[f32; 2]; 2]) {
        let [x, y] = [0, 1].map(|axis| place[axis] - 0.5 - 0.5 * self.cells[axis]);
        let longer = self.cells[0].max(self.cells[1]);
        let (wave, height) = (std::f32::consts::TAU / (BEND[0] * longer), BEND[1] * longer);
        let (across, down) = (libm::sincosf(wave * y), libm::sincosf(wave * x));
        let [u, v] = [x + height * across.0, y + height * down.0];
        let [bent_x, bent_y] = [across.1, down.1].map(|cosine| height * wave * cosine);
        let [cosine, sine] = TURN;
        let turned = [cosine * u - sine * v, sine * u + cosine * v];
        let at = [0, 1].map(|axis| 0.5 + TURNED_TO[axis] * self.cells[axis] + turned[axis]);
        let corner = self.cells.map(|cells| 0.5 + LEFT_OUT * cells);
        let (place, sign) = folded(at, corner, self.cells.map(|cells| (1.0 - 2.0 * LEFT_OUT) * cells));
        let east = [sign[0] * (cosine - sine * bent_y), sign[1] * (sine + cosine * bent_y)];
        let south = [sign[0] * (cosine * bent_x - sine), sign[1] * (sine * bent_x + cosine)];
        (place, [east, south])
    }

    /// Height of the ground at a place beyond the border, as [`Surroundings::at`] has it, and how much of the border is left
    /// behind there. Rays ask for it at each step.
    pub(super) fn height(&self, bed: &Surface, place: [f32; 2]) -> [f32; 2] {
        let Leaving { border, share, .. } = self.leaving(place);
        let far = || {
            let ([height, uneven], _) = self.far_at(place);
            let (turned, _) = self.turned(place);
            height + uneven * lowered(bed.at(turned) - self.mean, self.highest)[0]
        };
        if share >= 1.0 {
            return [far(), share];
        }
        let edge = bed.at(border);
        let near = edge + self.held(edge - bed.at(self.mirrored(place).0))[0];
        [if share > 0.0 { near + (far() - near) * share } else { near }, share]
    }

    /// The ground at a place beyond the border, for the surface of the landscape's own.
    pub(super) fn at(&self, bed: &Surface, place: [f32; 2]) -> Beyond {
        let Leaving { border, share, growth } = self.leaving(place);
        let (mirrored, mirror) = self.mirrored(place);
        let (turned, turns) = self.turned(place);
        let (edge, within, there) =
            (bed.with_slope(border), bed.with_slope(mirrored), bed.with_slope(turned));
        let ([height, uneven], swings) = self.far_at(place);
        let [off, kept] = self.held(edge[0] - within[0]);
        let near = edge[0] + off;
        let [unlike, steep] = lowered(there[0] - self.mean, self.highest);
        let far = height + uneven * unlike;
        let far_rise = [0, 1].map(|axis| {
            let [east, south] = turns[axis];
            let [of_height, of_uneven] = swings[axis];
            uneven * steep * (east * there[1] + south * there[2]) + of_height + of_uneven * unlike
        });
        let rise = |axis: usize| {
            let along = if place[axis] == border[axis] { (1.0 + kept) * edge[1 + axis] } else { 0.0 };
            let near_rise = along - kept * mirror[axis] * within[1 + axis];
            near_rise + (far_rise[axis] - near_rise) * share + (far - near) * growth[axis]
        };
        let surface = [near + (far - near) * share, rise(0), rise(1)];
        let river = if share < 0.5 { mirrored } else { turned };
        let (place, own) = if self.is_near(place, share) { (mirrored, within) } else { (turned, there) };
        Beyond { place, river, surface, own, share }
    }

    /// Whether a place is like the mirrored one and not like the turned one; the border between them is ragged.
    fn is_near(&self, place: [f32; 2], share: f32) -> bool {
        let patches =
            Octaves { wavelength: 0.05 * self.cells[0].max(self.cells[1]), count: 4, gain: 0.55, seed: 0x61 };
        let patchy = patches.at([place[0], place[1], 0.0], 0.0).value;
        share + 0.5 * patchy < 0.5
    }

    /// Level of the water at a place beyond the border, for that of the landscape, and the height of the ground there and how
    /// much of the border is left behind. A lake at the border goes on beyond it; one within does not stand there again.
    pub(super) fn level(
        &self,
        level: &Surface,
        [height, share]: [f32; 2],
        place: [f32; 2],
        cell: f32,
    ) -> f32 {
        let dry = height - cell;
        let far = self.sea.unwrap_or(dry);
        if share >= 1.0 {
            return far;
        }
        let within = level.at(self.mirrored(place).0);
        let off = (within - level.at(self.leaving(place).border)).abs();
        let same = libm::expf(-off / (OTHER_LAKE * cell));
        let near = (dry + (within - dry) * same).max(self.sea.unwrap_or(f32::MIN));
        near + (far - near) * share
    }

    /// How far ground beyond the border stands off the border's height, where it would by so much, and how much of its
    /// slope is left.
    fn held(&self, off: f32) -> [f32; 2] {
        let most = self.highest * if off < 0.0 { NEAR[1] } else { NEAR[0] };
        let lower = 1.0 + off.abs() / most;
        [off / lower, 1.0 / (lower * lower)]
    }

    /// What rivers keep of their width there.
    pub(super) fn river_share(beyond: &Beyond) -> f32 {
        (1.0 - 2.0 * beyond.share).abs()
    }

    /// Whether a height is that of the sea.
    pub(super) fn is_at_sea(&self, height: f32) -> bool {
        self.sea.is_some_and(|sea| (height - sea).abs() < AT_SEA)
    }

    /// Height of what lies beyond all that is drawn in the direction of a place, and whether it is the sea.
    pub(super) fn plain_at(&self, place: [f32; 2]) -> (f32, bool) {
        let ([height, _], _) = self.far_at(place);
        match self.sea {
            Some(sea) if height < sea => (sea, true),
            _ => (height, false),
        }
    }

    /// The share in which what lies at a place beyond the border fades into what lies farthest.
    pub(super) fn lost_share(&self, place: [f32; 2]) -> f32 {
        let away = |axis: usize| place[axis] - place[axis].clamp(0.5, self.cells[axis] + 0.5);
        let reach = LOST * self.cells[0].max(self.cells[1]);
        let square = (away(0) * away(0) + away(1) * away(1)) / (reach * reach);
        1.0 - libm::expf(-square)
    }
}

/// How far ground stands off the mean that is so far off it in the landscape, and how much of its slope is left.
fn lowered(unlike: f32, highest: f32) -> [f32; 2] {
    let lower = 1.0 + unlike.max(0.0) / highest;
    if unlike > 0.0 { [unlike / lower, 1.0 / (lower * lower)] } else { [unlike, 1.0] }
}

#[cfg(test)]
mod tests;
