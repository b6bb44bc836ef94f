//! A blade as a ribbon along its stem, and six blades as a set.
//!
//! A blade is as wide as α says, with two vertices in each of five rows a level: 40 at level 4 (Kim and Cho 2009). Its shape
//! is a function of where along the stem and on which side, so that it can be drawn with any number of rows. In the
//! source blades are as wide at the tip as at the root, and upright at it; those of a [`Species`] taper, and leave the ground
//! aslant, each by chance. A mown blade is a shorter one, a trodden one lies down. The shader `grass.wgsl` has the same names and the same order of operations.

use super::curves::mix;
use super::growth::{Bend, Growth, LEVELS, MAX_BEND, Point, points};
use super::random::{cosine, direction, random, sine};
use super::species::Species;
use super::spline::Spline;

/// Blades of a set.
pub const BLADES: u32 = 6;

/// Rows of vertices of a level.
pub const ROWS_OF_A_LEVEL: usize = 5;

/// Uses of the random numbers of a blade; the first is of the whole set.
const YAW: u32 = 0;
const PLACE: u32 = 1;
const DISTANCE: u32 = 2;
const HEIGHT: u32 = 3;
const LEAN: u32 = 4;
const FACING: u32 = 5;
const PHASE: u32 = 6;
const RANK: u32 = 7;
const SPLAY: u32 = 8;

/// Share of its height that a blade keeps that is trodden flat.
const TRODDEN: f32 = 0.08;

/// Width of a stalk beside that of a blade, and how far it leans beside one: stalks are stiff.
const STALK_WIDTH: f32 = 0.3;
const STALK_SPLAY: f32 = 0.4;

/// Blades that grow from one place, apart from where that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Set {
    /// How good the soil is, 0 to 1.
    pub soil: f32,
    /// How much light there is, 0 to 1.
    pub light: f32,
    /// Level of growth, 0 to 4; 0 is bare ground.
    pub level: f32,
    /// Height to which it is mown, as a share of its species' greatest; 1 is not mown.
    pub cut: f32,
    /// How far it is trodden down, 0 to 1.
    pub trodden: f32,
    /// Its random number: 16 bits.
    pub seed: u32,
}

/// A blade of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// Its stem, in metres.
    pub stem: Spline,
    /// Its root, in metres east and south of the set's middle.
    pub root: [f32; 2],
    /// To where it bends: a unit vector east and south.
    pub facing: [f32; 2],
    /// Width at the root in metres.
    pub width: f32,
    /// How much narrower its tip is, 0 to 1.
    pub taper: f32,
    /// Slope of its halves.
    pub fold: f32,
    /// Share of the stem, from its tip, that a head takes; without one 1.
    pub head_length: f32,
    /// Width of its head in metres; 0 without one.
    pub head_width: f32,
    /// Share of the good colour.
    pub blend: f32,
}

/// A vertex of a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Metres east, up and south of the set's middle: the axes of an exported mesh.
    pub place: [f32; 3],
    /// Unit normal of the upper side.
    pub normal: [f32; 3],
    /// Share of the good colour.
    pub blend: f32,
    /// Share of the head's colour.
    pub head: f32,
    /// 0 at the root to 1 at the tip.
    pub along: f32,
}

impl Set {
    /// The direction of its first blade in turns, 0 to 1, clockwise from east seen from above.
    #[inline]
    pub fn turns(&self) -> f32 {
        random(self.seed, 0, YAW)
    }

    /// Where in a gust it is, 0 to 1: neighbours do not sway as one.
    #[inline]
    pub fn phase(&self) -> f32 {
        random(self.seed, 0, PHASE)
    }

    /// Its place among its neighbours, 0 to 1: where sets are left out, those of the highest rank go first.
    #[inline]
    pub fn rank(&self) -> f32 {
        random(self.seed, 0, RANK)
    }

    /// The height in metres that its blades have on the average, but for chance.
    pub fn height(&self, species: &Species, bend: Bend) -> f32 {
        let growth = Growth::at(&species.curves, self.soil, self.light);
        let turn = growth.bend * species.bending * bend.of_a_level();
        let stem = splayed(Spline::of(&points(growth.height, turn), self.level), 0.5 * species.splay);
        let stem = trodden(stem, self.trodden);
        (highest(&stem) * species.height * (1.0 / LEVELS as f32)).min(self.cut * species.top())
    }
}

impl Blade {
    /// A blade of a set, by its number from 0 to 5.
    #[inline]
    pub fn of(species: &Species, tuft: &Set, number: u32, bend: Bend) -> Self {
        let random = |purpose| random(tuft.seed, number, purpose);
        let growth = Growth::at(&species.curves, tuft.soil, tuft.light);
        let stalk = number < species.heads;
        let tall = (1.0 - species.variation * random(HEIGHT)) * if stalk { species.stalk } else { 1.0 };
        let lean = 1.0 + species.variation * (random(LEAN) - 0.5);
        let turn = (growth.bend * species.bending * lean).clamp(0.0, MAX_BEND) * bend.of_a_level();
        let stem = Spline::of(&points(growth.height, turn), tuft.level);
        let splay = species.splay * if stalk { STALK_SPLAY } else { 1.0 };
        let stem = trodden(splayed(stem, splay * random(SPLAY)), tuft.trodden);
        let scale = species.height * tall * (1.0 / LEVELS as f32);
        let limit = tuft.cut * species.top();
        let kept = (limit / (highest(&stem) * scale).max(1e-20)).min(1.0);
        let place = direction(around(tuft.seed, number, random(PLACE)));
        let distance = species.spread * mix(0.25, 1.0, random(DISTANCE));
        let sprouted = tuft.level.clamp(0.0, 1.0);
        let ripe = (tuft.level - 3.0).clamp(0.0, 1.0) * growth.blend * kept;
        let width = growth.width * 4.0 * species.width * sprouted;
        Self {
            stem: Spline(stem.0.map(|[up, out]| [up * (scale * kept), out * (scale * kept)])),
            root: [place[0] * distance, place[1] * distance],
            facing: direction(around(tuft.seed, number, random(FACING))),
            width: if stalk { width * STALK_WIDTH } else { width },
            taper: if stalk { 0.5 } else { species.taper },
            fold: species.fold,
            head_length: if stalk { species.head_length } else { 1.0 },
            head_width: if stalk { species.head_width * ripe } else { 0.0 },
            blend: growth.blend,
        }
    }

    /// The vertex so far along the blade, 0 at the root to 1 at the tip, on the left (-1) or right (1) side of it.
    #[inline]
    pub fn vertex(&self, along: f32, side: f32) -> Vertex {
        let ([up, out], [rise, run]) = self.stem.at(along);
        let [x, y] = self.facing;
        let bulge = self.bulge(along);
        let half = side * 0.5 * (self.width * (1.0 - self.taper * along * along) + self.head_width * bulge);
        let length = (rise * rise + run * run).sqrt();
        // A blade of no length looks up.
        let [slope, lean] = if length > 1e-12 { [run / length, rise / length] } else { [1.0, 0.0] };
        let turned = side * self.fold;
        let shorter = 1.0 / (1.0 + turned * turned).sqrt();
        Vertex {
            place: [self.root[0] + x * out - y * half, up, self.root[1] + y * out + x * half],
            normal: [(y * turned - x * lean) * shorter, slope * shorter, (-x * turned - y * lean) * shorter],
            blend: self.blend,
            head: if self.head_width > 0.0 { (bulge * 4.0).min(1.0) } else { 0.0 },
            along,
        }
    }

    /// A vertex in the wind. `push` is how far the wind, east and south, shifts the tip of a stiff blade, as a share of
    /// its height. The distance to the root stays, and a blade never goes below it.
    #[inline]
    pub fn swayed(&self, vertex: &Vertex, push: [f32; 2]) -> Vertex {
        let share = vertex.along * vertex.along;
        let (east, south) = (push[0] * share, push[1] * share);
        let [x, up, y] = [vertex.place[0] - self.root[0], vertex.place[1], vertex.place[2] - self.root[1]];
        let shifted = [x + east * up, up, y + south * up];
        let length = |[x, y, z]: [f32; 3]| (x * x + y * y + z * z).sqrt();
        let kept = length([x, up, y]) / length(shifted).max(1e-20);
        let [a, b, c] = vertex.normal;
        let normal = [a, b - east * a - south * c, c];
        let longer = 1.0 / length(normal).max(1e-20);
        Vertex {
            place: [self.root[0] + shifted[0] * kept, up * kept, self.root[1] + shifted[2] * kept],
            normal: normal.map(|part| part * longer),
            ..*vertex
        }
    }

    /// All vertices of so many rows, from the root, left before right.
    pub fn vertices(self, rows: usize) -> impl Iterator<Item = Vertex> {
        let last = rows.saturating_sub(1).max(1) as f32;
        (0..rows).flat_map(move |row| [-1.0, 1.0].map(|side| self.vertex(row as f32 / last, side)))
    }

    /// How much of its width a head has: 0 outside it, 1 at its widest, a third from its foot.
    #[inline]
    fn bulge(&self, along: f32) -> f32 {
        let inside = ((along - 1.0) / self.head_length.max(1e-6) + 1.0).clamp(0.0, 1.0);
        6.75 * inside * (1.0 - inside) * (1.0 - inside)
    }
}

/// Rows of a blade of that level, as many as the source draws.
pub fn rows(level: f32) -> usize {
    ROWS_OF_A_LEVEL * (level.ceil() as usize).clamp(1, LEVELS)
}

/// A direction of a blade in turns from 0 to 1: even around the set, but for chance.
#[inline]
fn around(seed: u32, number: u32, random_of_blade: f32) -> f32 {
    let turns = random(seed, 0, YAW) + (number as f32 + random_of_blade) * (1.0 / BLADES as f32);
    turns - turns.floor()
}

/// A stem that leaves the ground at such an angle from upright.
#[inline]
fn splayed(stem: Spline, angle: f32) -> Spline {
    let (s, c) = (sine(angle), cosine(angle));
    Spline(stem.0.map(|[up, out]| [up * c - out * s, up * s + out * c]))
}

/// A stem that is trodden so far down.
#[inline]
fn trodden(stem: Spline, share: f32) -> Spline {
    let upright = 1.0 - share * (1.0 - TRODDEN);
    let lying = (1.0 - upright * upright).max(0.0).sqrt();
    Spline(stem.0.map(|[up, out]| [up * upright, out + up * lying]))
}

/// A height that no point of the stem exceeds.
#[inline]
fn highest(stem: &Spline) -> f32 {
    stem.0.iter().fold(0.0, |highest, point: &Point| point[0].max(highest))
}
