//! The parts of a plant that become ribbons and cards.

use crate::ifs::map::{Map, Point};
use crate::ifs::system::{Ifs, Role};
use weald_core::random::hash2;

/// What goes on along the axis becomes a leaf below this share of the plant.
const TIP: f64 = 0.07;

/// Most parts of a plant.
const MAX_PARTS: usize = 4096;

/// A part that becomes a ribbon or a card.
pub(super) struct Piece {
    /// From the whole to the part.
    pub(super) map: Map,
    /// Its size as a share of the whole.
    pub(super) size: f64,
    /// Branchings below it.
    pub level: u32,
    /// Whether it is a card.
    pub(super) is_leaf: bool,
    /// A number of its own.
    pub(super) key: u64,
}

/// All pieces of a plant, whose branches become leaves below the size of `leaf`.
pub(super) fn pieces(ifs: &Ifs, leaf: f64) -> Vec<Piece> {
    let whole = Piece { map: Map::IDENTITY, size: 1.0, level: 0, is_leaf: false, key: 0 };
    let (mut open, mut pieces) = (std::collections::VecDeque::from([whole]), Vec::new());
    while let Some(piece) = open.pop_front() {
        for (digit, weighted) in ifs.maps().iter().enumerate().filter(|(_, map)| map.role != Role::Stem) {
            let child = child(&piece, digit, weighted.role, &weighted.map);
            let least = if weighted.role == Role::Trunk { TIP } else { leaf };
            if child.size <= least || open.len() + pieces.len() >= MAX_PARTS {
                pieces.push(Piece { is_leaf: true, ..child });
            } else {
                open.push_back(child);
            }
        }
        pieces.push(piece);
    }
    pieces
}

fn child(piece: &Piece, digit: usize, role: Role, map: &Map) -> Piece {
    let map = piece.map.after(map);
    Piece {
        map,
        // Maps that contract in a row but not one by one may lengthen at first.
        size: map.ratio().min(piece.size),
        level: piece.level + u32::from(role == Role::Branch),
        is_leaf: false,
        key: hash2(piece.key, digit as i64, 1),
    }
}

/// The shape in its own units and how it comes to a height of one.
pub(in crate::ifs) struct Shape {
    root: Point,
    height: f64,
    /// Foot and top of the stem, where it has one.
    pub(in crate::ifs) stem: Option<[Point; 2]>,
    /// Half the width of the stem at its foot, for a height of one.
    pub(in crate::ifs) stem_half_width: f64,
    /// Width at the top of a stem beside that at its foot.
    pub(in crate::ifs) taper: f64,
}

impl Shape {
    pub(in crate::ifs) fn of(ifs: &Ifs) -> Self {
        const SLIMMEST: f64 = 0.005;
        let (root, [low, high]) = (ifs.root(), ifs.bounds());
        let (first, height) = (&ifs.maps()[0], (high[1] - root[1]).max(1e-3 * (high[1] - low[1])));
        let has_stem = first.role == Role::Stem;
        let trunk = ifs.maps().iter().find(|weighted| weighted.role == Role::Trunk);
        let wide = 0.5 * first.map.linear[0][0].abs() * (high[0] - low[0]) / height;
        Self {
            root,
            height,
            stem: has_stem.then(|| [root, first.map.at([root[0], high[1], root[2]])]),
            stem_half_width: wide.clamp(SLIMMEST, 4.0 * SLIMMEST),
            taper: trunk.map_or(0.6, |trunk| trunk.map.ratio().clamp(0.4, 1.0)),
        }
    }

    /// A point with the root as origin and a height of one.
    pub(in crate::ifs) fn flat(&self, point: Point) -> Point {
        std::array::from_fn(|axis| (point[axis] - self.root[axis]) / self.height)
    }

    /// The point of the shape that is there when its root is the origin and its height one.
    pub(in crate::ifs) fn point(&self, flat: Point) -> Point {
        std::array::from_fn(|axis| self.root[axis] + self.height * flat[axis])
    }

    /// 0 at the root and below it, 1 at the top.
    pub(in crate::ifs) fn share_above_root(&self, point: Point) -> f64 {
        self.flat(point)[1].clamp(0.0, 1.0)
    }
}
