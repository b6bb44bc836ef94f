//! From a fractal to the parts that become leaves and stems: down the digits, the coarsest first.

use std::collections::VecDeque;

use super::limb::LEVELS;
use crate::ifs::foliage::{Habit, Shape};
use crate::ifs::map::Map;
use crate::ifs::system::{Ifs, Role};
use weald_core::random::{hash2, unit};

/// Size, as a share of the plant, up to which a part is a leaf of each level but the last, which has no sizes: of fronds,
/// whose leaves are slim, and of crowns.
const OF_FRONDS: [f64; LEVELS - 1] = [0.028, 0.07, 0.36, 1.0];
const OF_CROWNS: [f64; LEVELS - 1] = [0.028, 0.07, 0.2, 1.0];

/// Share of the plant below which no stem is seen.
const MIN_STEM: f64 = 0.08;

/// How much larger than it is a part counts that goes on along an axis: a tip as one leaf would be seen among the leaves
/// below it. That of a crown is its top, which stands before the sky.
const AXIS: f64 = 2.0;
const AXIS_OF_CROWNS: f64 = 5.0;

/// Most leaves of the finest level, over all fronds, and of a crown.
const MAX_LEAVES: usize = 16_384;
const MAX_OF_CROWNS: usize = 32_000;

/// Factor by which leaves become larger until they are few enough.
const COARSER: f64 = 1.2;

/// Least factor between the sizes of leaves of neighbouring levels.
const APART: f64 = 1.5;

/// A part that begins with a branch, or the whole.
pub(super) struct Branch {
    /// From the whole to the part.
    pub(super) map: Map,
    /// Number of the branch on which it hangs.
    pub(super) parent: Option<usize>,
    /// How far along it.
    pub(super) along: f64,
    /// Branchings below it.
    pub(super) order: u32,
    /// A number of its own.
    pub(super) key: u64,
}

/// A leaf or a stem.
pub(super) struct Part {
    /// From the whole to the part.
    pub(super) map: Map,
    /// From the whole to where the part is in its branch.
    pub(super) within: Map,
    /// Number of its branch.
    pub(super) branch: usize,
    /// Size as a share of the whole.
    pub(super) size: f64,
    /// First and last level that has it.
    pub(super) levels: [u32; 2],
    /// Whether it is a stem.
    pub(super) is_stem: bool,
    /// A number of its own.
    pub(super) key: u64,
}

/// All parts of one frond.
pub(super) struct Walk {
    pub(super) branches: Vec<Branch>,
    pub(super) parts: Vec<Part>,
}

/// The maps of a fractal.
struct Maps<'a> {
    ifs: &'a Ifs,
    /// Whether branches of a flat shape stand off to all sides.
    spreads: bool,
    /// How much larger than it is a part counts that goes on along an axis.
    axis: f64,
    /// Size up to which a part moves with the branch that bears it: the leaves of crowns would be too many limbs.
    still: f64,
}

impl Maps<'_> {
    /// The map of a digit, for the part with such a key: a branch that spreads is turned about the axis that bears it.
    fn of(&self, digit: usize, key: u64) -> Map {
        let weighted = &self.ifs.maps()[digit];
        if !self.spreads {
            return weighted.map;
        }
        // As much deep as wide.
        let mut map = weighted.map;
        map.linear[2][2] = map.ratio();
        if weighted.role != Role::Branch {
            return map;
        }
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit(hash2(key, 0, 13)));
        let turn = Map::spatial([[cosine, 0.0, sine, 0.0], [0.0, 1.0, 0.0, 0.0], [-sine, 0.0, cosine, 0.0]]);
        turn.conjugate(1.0, self.ifs.root()).after(&map)
    }
}

/// A part on the way down.
struct Open {
    map: Map,
    within: Map,
    branch: usize,
    size: f64,
    /// Size that it counts as, and that of what it is a part of.
    counts: f64,
    before: f64,
    key: u64,
}

impl Walk {
    /// The parts of a fractal that stands so many times in a plant, with leaves as fine as that allows.
    pub(super) fn of(ifs: &Ifs, shape: &Shape, (habit, copies): (Habit, usize)) -> Self {
        let axis = if habit == Habit::Single { AXIS_OF_CROWNS } else { AXIS };
        let spreads = matches!(habit, Habit::Crossed(_));
        let most = if habit == Habit::Single { MAX_OF_CROWNS } else { MAX_LEAVES };
        let mut sizes = if habit.is_rosette() { OF_FRONDS } else { OF_CROWNS };
        loop {
            let still = if habit == Habit::Single { sizes[0] } else { 0.0 };
            let maps = Maps { ifs, spreads, axis, still };
            if let Some(walk) = Self::down_to(&maps, shape, sizes, most / copies) {
                return walk;
            }
            sizes[0] *= COARSER;
            for level in 1..sizes.len() {
                sizes[level] = sizes[level].max(APART * sizes[level - 1]);
            }
        }
    }

    /// The same with leaves of such sizes; `None` if there are more than so many.
    fn down_to(maps: &Maps<'_>, shape: &Shape, sizes: [f64; LEVELS - 1], most: usize) -> Option<Self> {
        let whole = Branch { map: Map::IDENTITY, parent: None, along: 0.0, order: 0, key: 0 };
        let mut walk = Self { branches: vec![whole], parts: Vec::new() };
        let mut open = VecDeque::from([Open {
            map: Map::IDENTITY,
            within: Map::IDENTITY,
            branch: 0,
            size: 1.0,
            counts: 1.0,
            before: f64::INFINITY,
            key: 0,
        }]);
        while let Some(part) = open.pop_front() {
            walk.leaf(&part, sizes);
            if part.counts > sizes[0] {
                walk.stem(&part, sizes);
                for digit in 0..maps.ifs.maps().len() {
                    open.extend(walk.child(maps, shape, &part, digit));
                }
            }
            if walk.parts.len() > most {
                return None;
            }
        }
        Some(walk)
    }

    fn leaf(&mut self, part: &Open, sizes: [f64; LEVELS - 1]) {
        let mut levels = (0..).zip(sizes).filter(|&(_, size)| part.counts <= size && size < part.before);
        if let Some((first, _)) = levels.next() {
            let last = levels.last().map_or(first, |(last, _)| last);
            self.part(part, [first, last], false);
        }
    }

    fn stem(&mut self, part: &Open, sizes: [f64; LEVELS - 1]) {
        let levels = (0..).zip(sizes).filter(|&(_, size)| size < part.counts);
        if let Some((last, _)) = levels.last().filter(|_| part.size >= MIN_STEM) {
            self.part(part, [0, last], true);
        }
    }

    fn part(&mut self, part: &Open, levels: [u32; 2], is_stem: bool) {
        let Open { map, within, branch, size, key, .. } = *part;
        self.parts.push(Part { map, within, branch, size, levels, is_stem, key });
    }

    fn child(&mut self, maps: &Maps<'_>, shape: &Shape, part: &Open, digit: usize) -> Option<Open> {
        let weighted = &maps.ifs.maps()[digit];
        let key = hash2(part.key, digit as i64, 1);
        let own = maps.of(digit, key);
        let map = part.map.after(&own);
        let ratio = map.ratio();
        let (within, branch) = match weighted.role {
            Role::Stem => return None,
            Role::Trunk => (part.within.after(&own), part.branch),
            Role::Branch if ratio <= maps.still => (part.within.after(&own), part.branch),
            Role::Branch => {
                let along = shape.share_above_root(part.within.at(own.at(maps.ifs.root())));
                let order = self.branches[part.branch].order + 1;
                self.branches.push(Branch { map, parent: Some(part.branch), along, order, key });
                (Map::IDENTITY, self.branches.len() - 1)
            }
        };
        // Maps that contract in a row but not one by one may lengthen at first.
        let size = ratio.min(part.size);
        let counts = if weighted.role == Role::Trunk { maps.axis * size } else { size };
        Some(Open { map, within, branch, size, counts: counts.min(part.counts), before: part.counts, key })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::shapes;

    #[test]
    fn as_many_parts_as_are_allowed_are_taken_and_not_one_more() {
        let ifs = shapes::find("fern").expect("built in").ifs();
        let (shape, maps) = (Shape::of(&ifs), Maps { ifs: &ifs, spreads: false, axis: AXIS, still: 0.0 });
        let parts = |most| Walk::down_to(&maps, &shape, OF_FRONDS, most).map(|walk| walk.parts.len());
        let all = parts(usize::MAX).expect("not endless");
        assert_eq!(parts(all), Some(all));
        assert!((1..20).all(|fewer| parts(all - fewer).is_none()));
    }
}
