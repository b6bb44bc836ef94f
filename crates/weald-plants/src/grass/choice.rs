//! Which sets of a meadow are drawn, and how finely: what a device chooses anew for each picture.
//!
//! ```text
//! share of the sets that stand at distance d     (V / max(c^1.5 d, V))^1.15 · clamp((F - d) / 0.35 F, 0, 1)
//! height share of a set of rank r                clamp((1.25 share - r) / 0.25, 0, 1)
//! ```
//!
//! with V = W min(D / n, 1)^(1 / 1.15) and W = 10 m, up to which all stand of a meadow with n sets on a square metre, if these are no more than
//! D = 110, F = 96 m, beyond which none does, and c = 1 but where pixels are larger than a thousandth of a radian: there it is how many times as large they are, 2 at
//! most (never less than 1 of [`coarser`]). With as many sets in them,
//! blades, of which none is drawn much thinner than a pixel, were a pale coat. A picture that need not be drawn many times a second
//! may have blades that reach farther: all distances d count as so many times less, and D is so many times as much. A set whose turn it is to be left out sinks
//! into the ground over a fifth of the ranks, so that none vanishes at once. Those that stand are drawn at one of three
//! levels of detail, each with its list, of blades with fewer and fewer rows of vertices; before the level changes every
//! second row has slid onto its neighbour, so that the blade is that of the next level already. A level ends where the bends of
//! the next are two pixels off, so the nearer the larger pixels are: what a pixel does not show is not drawn. Nor is a set that
//! ground hides, which is looked for at a few places on the way to it. A device does the same in `meadow.wgsl`, which has
//! the same names; it keeps each list in the order of the sets, so that a picture is the same each time.

use super::blade::{Set, rows};
use super::species::Species;
use weald_engine::uniform;

/// Distances in metres up to which blades have their finest and middle shapes where pixels are of a thousandth of a radian, and
/// beyond which there is none.
pub const NEAR: f32 = 4.5;
/// See [`NEAR`].
pub const MIDDLE: f32 = 14.0;
/// See [`NEAR`].
pub const FARTHEST: f32 = 96.0;

/// Lists by distance.
pub const LISTS: usize = 3;

/// Rows of the blades of each level of detail, of which each has its list.
pub const ROWS: [u32; LISTS] = [9, 5, 3];

/// Distance in metres up to which every set stands of a meadow that is no denser than [`CLOSEST`], and how fast they become fewer beyond it.
const WHOLE: f32 = 10.0;
const THINNING: f32 = 1.15;

/// Most sets on a square metre of which all stand up to there in a moving picture.
const CLOSEST: f64 = 110.0;

/// Share of ranks over which a set that is left out sinks.
const SINKING: f32 = 0.25;

/// Share of a list's farthest distance at which its rows begin to slide.
const SLIDE: f32 = 0.6;

/// Angle of a pixel in radians for which distances count as they are for the shape of blades: that of a picture of 1,150 pixels
/// across for 60°.
const PIXEL: f32 = 1e-3;

/// How many times as far away as they are blades count at least, and at most: those of a small picture bend too.
const FINEST: f32 = 0.5;
const COARSEST: f32 = 2.0;

/// Places between the eye and a set at which ground may hide it.
const LOOKS: u16 = 5;

/// Metres above the tips of its blades from which a set counts as seen: they sway, and the ground that is drawn is not quite
/// the smooth one.
const SPARE: f32 = 0.1;

uniform! {
    /// What a picture shows of its sets.
    pub struct Choice {
        /// Rows of the blades of each list; the fourth is nothing.
        pub rows: [u32; 4],
        /// 1 where sets out of sight are left out, 0 where all are drawn.
        pub culled: u32,
        /// 1 where sets become fewer and coarser with the distance, 0 where all stand in the first list.
        pub thinned: u32,
        /// 1 where ground may hide sets: all that is culled, but where some of the land has no data and none is drawn.
        pub hides: u32,
    }
}

/// From where and whereto one looks: directions of length 1, and the tangents of half the angles of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewCone {
    /// The eye.
    pub eye: [f32; 3],
    /// Ahead, rightward and upward.
    pub axes: [[f32; 3]; 3],
    /// Tangents of half the angles across and upward.
    pub half: [f32; 2],
    /// The point from which distances count: the eye, but in tests.
    pub detail_from: [f32; 3],
    /// How much of grass is shown.
    pub detail: Detail,
}

/// How much of grass a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// How many times as large pixels are, as [`coarser`] says.
    pub coarser: f32,
    /// How many times as far as in a moving picture blades reach, 1 or more.
    pub reach: f32,
    /// [`whole`] of all grass.
    whole: f32,
}

impl Choice {
    /// What a picture shows: sets in sight, fewer and coarser with the distance.
    pub fn of_a_picture() -> Self {
        Self { rows: [ROWS[0], ROWS[1], ROWS[2], 0], culled: 1, thinned: 1, hides: 1 }
    }

    /// All sets of a level of growth, in sight or not, with as many rows as the source draws.
    pub fn of_all(level: f32) -> Self {
        Self { rows: [rows(level) as u32, 0, 0, 0], culled: 0, thinned: 0, hides: 0 }
    }

    /// The level of detail, and with it the list, in which a set is drawn whose root is there; `None` where it is not.
    pub fn list_of(
        &self,
        sight: &ViewCone,
        (species, tuft): (&Species, &Set),
        root: [f32; 3],
    ) -> Option<usize> {
        let distance = length(minus(root, sight.detail_from));
        let stands = self.height_share(tuft.rank(), distance, &sight.detail) > 0.0;
        let seen = self.culled == 0 || sight.is_in_sight(minus(root, sight.eye), reach_of_blades(species));
        (stands && seen).then(|| self.list(sight.detail.coarser * distance))
    }

    /// Whether ground hides all blades of a set: at a few places on the way from the eye to a point above its root it is higher
    /// than that way. `ground` gives the height of it at a place, east and north; `None` where there is none.
    pub fn is_hidden(
        &self,
        eye: [f32; 3],
        (species, root): (&Species, [f32; 3]),
        ground: impl Fn([f32; 2]) -> Option<f32>,
    ) -> bool {
        let above = tallest(species) + SPARE;
        let away = [root[0] - eye[0], root[1] - eye[1], root[2] + above - eye[2]];
        let is_below_ground = |look: u16| {
            let share = (f32::from(look) + 0.5) / f32::from(LOOKS);
            let [east, north, up] = [0, 1, 2].map(|axis| eye[axis] + share * away[axis]);
            ground([east, north]).is_some_and(|height| height > up)
        };
        self.hides == 1 && (0..LOOKS).any(is_below_ground)
    }

    /// How high a set of a rank stands at a distance, as a share: 0 where it is left out.
    pub fn height_share(&self, rank: f32, distance: f32, detail: &Detail) -> f32 {
        if self.thinned == 0 {
            return 1.0;
        }
        ((detail.share(distance) * (1.0 + SINKING) - rank) / SINKING).clamp(0.0, 1.0)
    }

    /// How far every second row of a list's blades has slid onto the one before it, at a distance as it counts.
    pub fn row_slide(&self, list: usize, distance: f32) -> f32 {
        let Some(end) = [NEAR, MIDDLE].get(list).filter(|_| self.thinned == 1) else { return 0.0 };
        ((distance - SLIDE * end) / ((1.0 - SLIDE) * end)).clamp(0.0, 1.0)
    }

    /// The level of detail at a distance: 0 for the finest blades.
    fn list(&self, distance: f32) -> usize {
        match self.thinned {
            0 => 0,
            _ if distance < NEAR => 0,
            _ if distance < MIDDLE => 1,
            _ => 2,
        }
    }
}

/// How many times as far away as they are blades count for their shape in a picture whose pixels have such an angle in radians;
/// sets become fewer as well where that is more than once.
pub fn coarser(pixel_angle: f32) -> f32 {
    (pixel_angle / PIXEL).clamp(FINEST, COARSEST)
}

/// Metres above its root that no blade of a species exceeds, nor lies aside of it.
fn tallest(species: &Species) -> f32 {
    species.height * species.stalk.max(1.0) + species.spread
}

/// Radius in metres of a ball around the root of a set that holds its blades, wherever they sway.
pub fn reach_of_blades(species: &Species) -> f32 {
    tallest(species) + SPARE
}

/// Distance in metres, where blades reach no farther than in a moving picture, up to which every set stands of grass of which the densest has
/// so many on a square metre: of a denser one no more stand far away than of one with 110, and so many times as many where blades reach so many
/// times as far.
pub fn whole(densest: f64, reach: f32) -> f32 {
    WHOLE * libm::pow((CLOSEST * f64::from(reach) / densest).min(1.0), 1.0 / f64::from(THINNING)) as f32
}

impl Detail {
    /// That of grass of which the densest has so many sets on a square metre.
    pub fn new(coarser: f32, reach: f32, densest: f64) -> Self {
        Self { coarser, reach, whole: whole(densest, reach) }
    }

    /// How many of the sets stand at a distance.
    pub fn share(&self, distance: f32) -> f32 {
        let larger = self.coarser.max(1.0);
        let within = distance / self.reach;
        let thinned = libm::powf(self.whole / (larger * larger.sqrt() * within).max(self.whole), THINNING);
        thinned * ((FARTHEST - within) / (0.35 * FARTHEST)).clamp(0.0, 1.0)
    }
}

impl ViewCone {
    /// Whether a ball of a radius around a point, seen from the eye, may be in the picture.
    pub fn is_in_sight(&self, away: [f32; 3], radius: f32) -> bool {
        let [depth, right, up] = self.axes.map(|axis| dot(away, axis));
        let within =
            |aside: f32, half: f32| aside.abs() <= depth * half + radius * (1.0 + half * half).sqrt();
        depth > -radius && within(right, self.half[0]) && within(up, self.half[1])
    }
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(v: [f32; 3]) -> f32 {
    dot(v, v).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::blade::{BLADES, Blade};
    use super::super::growth::Bend;
    use super::super::species::SPECIES;
    use super::*;

    const AHEAD: ViewCone = ViewCone {
        eye: [0.0; 3],
        axes: [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        half: [1.0, 0.5],
        detail_from: [0.0; 3],
        detail: PLAIN,
    };

    const PLAIN: Detail = Detail { coarser: 1.0, reach: 1.0, whole: WHOLE };

    fn distances() -> impl Iterator<Item = f32> {
        (0..1200_u16).map(|step| 0.1 * f32::from(step))
    }

    #[test]
    fn sets_become_fewer_with_the_distance_and_none_sinks_at_once() {
        let choice = Choice::of_a_picture();
        assert_eq!((PLAIN.share(WHOLE), PLAIN.share(FARTHEST)), (1.0, 0.0));
        assert!(distances().all(|at| PLAIN.share(at + 0.1) <= PLAIN.share(at)));
        for rank in [0.0, 0.3, 0.99] {
            let share = |at| choice.height_share(rank, at, &PLAIN);
            let sunk: Vec<_> = distances().map(|at| share(at) - share(at + 0.1)).collect();
            assert!(sunk.iter().all(|sunk| (0.0..0.06).contains(sunk)), "rank {rank}");
            assert!((sunk.iter().sum::<f32>() - 1.0).abs() < 1e-4, "rank {rank} sinks wholly");
        }
    }

    #[test]
    fn fewer_sets_stand_where_pixels_are_larger() {
        let [large, small] = [2.0, 0.5].map(|coarser| Detail { coarser, ..PLAIN });
        for at in [20.0, 30.0, 50.0] {
            let fewer = large.share(at) / PLAIN.share(at);
            assert!((0.29..0.31).contains(&fewer), "at {at} m: {fewer}");
            assert_eq!(large.share(3.5), 1.0, "near by all stand");
            assert_eq!(small.share(at), PLAIN.share(at), "no more than all");
        }
    }

    #[test]
    fn blades_that_reach_twice_as_far_are_as_many_as_half_as_far_away() {
        let farther = Detail { reach: 2.0, ..PLAIN };
        assert!(distances().all(|at| farther.share(2.0 * at) == PLAIN.share(at)));
    }

    #[test]
    fn as_many_sets_stand_far_away_however_dense_a_meadow_is_and_all_near_by() {
        let dense = Detail::new(1.0, 1.0, 2.0 * CLOSEST);
        assert_eq!(Detail::new(1.0, 1.0, 0.5 * CLOSEST), PLAIN);
        assert_eq!(Detail::new(1.0, 2.5, 2.5 * CLOSEST), Detail { reach: 2.5, ..PLAIN });
        assert!(distances().skip(100).all(|at| (2.0 * dense.share(at) - PLAIN.share(at)).abs() < 1e-6));
        assert_eq!(dense.share(5.0), 1.0);
        let between = 2.0 * dense.share(7.0);
        assert!((1.4..1.6).contains(&between), "{between} times as many at 7 m");
    }

    #[test]
    fn a_list_has_the_shape_of_the_next_where_it_ends_and_its_own_where_it_begins() {
        let choice = Choice::of_a_picture();
        for (list, (begin, end)) in [(0.0, NEAR), (NEAR, MIDDLE)].into_iter().enumerate() {
            assert_eq!((choice.list(begin), choice.list(end)), (list, list + 1));
            assert_eq!((choice.row_slide(list, begin), choice.row_slide(list, end)), (0.0, 1.0));
            assert_eq!(ROWS[list] - 1, 2 * (ROWS[list + 1] - 1), "every second row is one of the next list");
        }
        assert_eq!(choice.row_slide(2, MIDDLE), 0.0);
    }

    #[test]
    fn what_lies_behind_and_beside_is_left_out_and_all_else_is_not() {
        let tuft = Set { soil: 1.0, light: 1.0, level: 4.0, cut: 1.0, trodden: 0.0, seed: 1 };
        let tall = Species { height: 1.2, stalk: 1.0, spread: 0.1, ..SPECIES[0].clone() };
        let short = Species { height: 0.3, ..tall.clone() };
        let (picture, all) = (Choice::of_a_picture(), Choice::of_all(4.0));
        let places = [([0.0, 5.0, 0.0], true), ([4.0, 5.0, 0.0], true), ([0.0, -3.0, 0.0], false)];
        let beside = [([9.0, 5.0, 0.0], false), ([0.0, 5.0, 6.0], false), ([0.0, -1.0, 0.0], true)];
        for (root, seen) in places.into_iter().chain(beside) {
            assert_eq!(picture.list_of(&AHEAD, (&tall, &tuft), root).is_some(), seen, "{root:?}");
            assert_eq!(all.list_of(&AHEAD, (&tall, &tuft), root), Some(0), "{root:?}");
        }
        assert_eq!(
            picture.list_of(&AHEAD, (&short, &tuft), [0.0, -1.0, 0.0]),
            None,
            "it does not reach the eye"
        );
        assert_eq!((all.rows[0], Choice::of_all(1.0).rows[0]), (20, 5), "two vertices a row: 40 at level 4");
    }

    #[test]
    fn a_ball_around_the_root_of_a_set_holds_its_blades_wherever_they_sway() {
        for species in &SPECIES {
            let mut farthest = 0.0_f32;
            for seed in 0..200 {
                let [soil, light] = [seed % 11, seed / 11 % 11].map(|tenths| tenths as f32 / 10.0);
                let tuft = Set { soil, light, level: 4.0, cut: 1.0, trodden: 0.0, seed };
                for number in 0..BLADES {
                    let blade = Blade::of(species, &tuft, number, Bend::Total);
                    let push = [seed as f32 * 0.01 - 1.0, 0.4];
                    for vertex in blade.vertices(rows(4.0)) {
                        let places = [vertex.place, blade.swayed(&vertex, push).place];
                        farthest = places.map(length).into_iter().fold(farthest, f32::max);
                    }
                }
            }
            assert!(farthest <= reach_of_blades(species), "{}: {farthest} m", species.name);
            assert!(3.0 * farthest > reach_of_blades(species), "{}: {farthest} m is far less", species.name);
        }
    }

    #[test]
    fn a_level_ends_where_the_bends_of_the_next_are_two_pixels_off() {
        for (level, end) in [(1, NEAR), (2, MIDDLE)] {
            let pieces = ROWS[level] - 1;
            let mut farthest: Vec<_> = (0..401).map(|seed| farthest_off(seed, pieces)).collect();
            farthest.sort_unstable_by(f32::total_cmp);
            let pixels = farthest[200] / (end * PIXEL);
            assert!((1.7..2.2).contains(&pixels), "level {level}: {} m, {pixels} pixels", farthest[200]);
        }
    }

    /// How far a blade of ryegrass lies off so many straight pieces at most, half-way along one.
    fn farthest_off(seed: u32, pieces: u32) -> f32 {
        let tuft = Set { soil: 0.6, light: 0.8, level: 4.0, cut: 1.0, trodden: 0.0, seed };
        let blade = Blade::of(&SPECIES[0], &tuft, seed % BLADES, Bend::Total);
        let off = |piece: u32| {
            let [begin, middle, end] =
                [0.0, 0.5, 1.0].map(|at| blade.vertex((piece as f32 + at) / pieces as f32, 0.0).place);
            length([0, 1, 2].map(|axis| middle[axis] - 0.5 * (begin[axis] + end[axis])))
        };
        (0..pieces).map(off).fold(0.0, f32::max)
    }

    #[test]
    fn a_ridge_hides_what_lies_behind_it_but_not_what_looks_over_it_nor_what_is_before_it() {
        let ryegrass = &SPECIES[0];
        let eye = [0.0, 0.0, 1.5];
        // 3 m high from 20 m to 30 m ahead, on land that ends at 50 m.
        let ground = |[_, north]: [f32; 2]| {
            (north < 50.0).then(|| if (20.0..30.0).contains(&north) { 3.0 } else { 0.0 })
        };
        let hidden = |choice: Choice, at: [f32; 3]| choice.is_hidden(eye, (ryegrass, at), ground);
        let picture = Choice::of_a_picture();
        for (root, is_hidden) in [
            ([0.0, 40.0, 0.0], true),
            ([9.0, 40.0, 2.0], true),
            ([0.0, 40.0, 4.0], false),
            ([0.0, 25.0, 3.0], false),
            ([0.0, 15.0, 0.0], false),
        ] {
            assert_eq!(hidden(picture, root), is_hidden, "{root:?}");
            assert!(!hidden(Choice::of_all(4.0), root), "{root:?}");
        }
        // Seen from beyond the end of the land, where there is no ground on the way.
        let from_outside = picture.is_hidden([0.0, 90.0, 1.5], (ryegrass, [0.0, 45.0, 0.0]), ground);
        assert!(!from_outside);
    }
}
