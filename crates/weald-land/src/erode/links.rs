//! Which cells exist and which edges join two of them.
//!
//! Without a no-data mask a few still rows serve all cells. With one, constant planes say it cell by
//! cell. An open border is a ring of cells without data around the domain, into which water falls.

use weald_core::grid::{Mask, Size};
use weald_engine::stencil::ring::Ring;

/// Constant planes behind the start height in a grid with a mask: land, eastern link, southern link,
/// reciprocal of the number of neighbours, northern link, yielding ground.
pub(crate) const MASK_PLANES: usize = 6;

/// Places of the two from which all others follow, behind the last state plane.
pub(crate) mod plane {
    /// 1 for data, else 0.
    pub(crate) const VALID: usize = 1;
    /// 1 where water may change the ground.
    pub(crate) const ERODIBLE: usize = 6;
}

/// The links of one row.
#[derive(Clone, Copy)]
pub(crate) struct LinkRow<'a> {
    /// 1 where the cell holds data, else 0.
    pub(crate) valid: &'a [f32],
    /// 1 where the cell and its eastern neighbour hold data, else 0.
    pub(crate) east: &'a [f32],
    /// The same for its southern neighbour.
    pub(crate) south: &'a [f32],
    /// The same for its western neighbour.
    pub(crate) west: &'a [f32],
    /// The same for its northern neighbour.
    pub(crate) north: &'a [f32],
    /// Reciprocal of the number of neighbours that hold data; 0 where there are none.
    pub(crate) neighbour_share: &'a [f32],
    /// 1 where water may change the ground: on cells with data that do not lie at an open edge. Those hold
    /// the base level of their rivers, or rivers would cut ever deeper there.
    pub(crate) erodible: &'a [f32],
}

/// Links of all rows.
pub(crate) enum Links {
    /// Every cell holds data: rows of ones, zeros and shares.
    Whole(Box<WholeLinks>),
    /// The constant planes from number 1 on say it.
    Masked,
}

/// The still rows of a grid without a mask.
pub(crate) struct WholeLinks {
    rows: usize,
    ones: Vec<f32>,
    zeros: Vec<f32>,
    east: Vec<f32>,
    west: Vec<f32>,
    shares: [Vec<f32>; 3],
}

impl Links {
    /// Links of a world of that size.
    pub(crate) fn new(size: Size, masked: bool) -> Self {
        if masked {
            return Self::Masked;
        }
        let Size { columns, rows } = size;
        let (mut east, mut west) = (vec![1.0; columns], vec![1.0; columns]);
        east[columns - 1] = 0.0;
        west[0] = 0.0;
        let vertical = |neighbours: usize| {
            let horizontal = |x: usize| usize::from(x > 0) + usize::from(x + 1 < columns);
            (0..columns).map(|x| reciprocal(horizontal(x) + neighbours)).collect()
        };
        let shares = [vertical(0), vertical(1), vertical(2)];
        let (ones, zeros) = (vec![1.0; columns], vec![0.0; columns]);
        Self::Whole(Box::new(WholeLinks { rows, ones, zeros, east, west, shares }))
    }

    /// Links of a part of that size, as if its edges were walls.
    pub(crate) fn sized(&self, size: Size) -> Self {
        Self::new(size, matches!(self, Self::Masked))
    }

    /// Number of constant planes that the links need.
    pub(crate) fn planes(&self) -> usize {
        if matches!(self, Self::Masked) { MASK_PLANES } else { 0 }
    }

    /// Which cells of row `y`, or of their neighbours to the east (1) or west (-1), hold data.
    #[inline]
    pub(crate) fn valid<'a>(&'a self, constants: &'a [Ring], y: usize, east: isize) -> &'a [f32] {
        match (self, east) {
            (Self::Whole(whole), 0) => &whole.ones,
            (Self::Whole(whole), 1) => &whole.east,
            (Self::Whole(whole), _) => &whole.west,
            (Self::Masked, 0) => constants[plane::VALID].here(y),
            (Self::Masked, 1) => constants[plane::VALID].east(y),
            (Self::Masked, _) => constants[plane::VALID].west(y),
        }
    }

    /// The links of row `y`; `constants` are the rings of the constant planes, start height first.
    pub(crate) fn row<'a>(&'a self, constants: &'a [Ring], y: usize) -> LinkRow<'a> {
        match self {
            Self::Whole(whole) => whole.row(y),
            Self::Masked => LinkRow {
                valid: constants[1].here(y),
                east: constants[2].here(y),
                south: constants[3].here(y),
                west: constants[2].west(y),
                north: constants[5].here(y),
                neighbour_share: constants[4].here(y),
                erodible: constants[6].here(y),
            },
        }
    }
}

impl WholeLinks {
    fn row(&self, y: usize) -> LinkRow<'_> {
        let below = y + 1 < self.rows;
        LinkRow {
            valid: &self.ones,
            east: &self.east,
            south: if below { &self.ones } else { &self.zeros },
            west: &self.west,
            north: if y > 0 { &self.ones } else { &self.zeros },
            neighbour_share: &self.shares[usize::from(y > 0) + usize::from(below)],
            erodible: &self.ones,
        }
    }
}

fn reciprocal(neighbours: usize) -> f32 {
    if neighbours == 0 { 0.0 } else { 1.0 / neighbours as f32 }
}

/// The [`MASK_PLANES`] of a mask, row-major. `open` says that water leaves over its edges.
pub(crate) fn mask_planes(mask: &Mask, open: bool) -> [Vec<f32>; MASK_PLANES] {
    let Size { columns, rows } = mask.size();
    let valid = |x: usize, y: usize| x < columns && y < rows && mask.is_valid(x, y);
    let plane = |value: &dyn Fn(usize, usize) -> f32| -> Vec<f32> {
        (0..rows * columns).map(|at| value(at % columns, at / columns)).collect()
    };
    let flag = |yes: bool| f32::from(u8::from(yes));
    let neighbours = |x: usize, y: usize| {
        usize::from(x > 0 && valid(x - 1, y))
            + usize::from(valid(x + 1, y))
            + usize::from(y > 0 && valid(x, y - 1))
            + usize::from(valid(x, y + 1))
    };
    [
        plane(&|x, y| flag(valid(x, y))),
        plane(&|x, y| flag(valid(x, y) && valid(x + 1, y))),
        plane(&|x, y| flag(valid(x, y) && valid(x, y + 1))),
        plane(&|x, y| if valid(x, y) { reciprocal(neighbours(x, y)) } else { 0.0 }),
        plane(&|x, y| flag(y > 0 && valid(x, y) && valid(x, y - 1))),
        plane(&|x, y| flag(valid(x, y) && (!open || neighbours(x, y) == 4))),
    ]
}
