//! What the ground is to a plant at any place on it: how well it suits, how high it is, which way it faces.
//!
//! Ground is where a height lies between heights: in the square between the centres of four cells with data, and in
//! half of the square of three. That is the ground of an exported mesh, so nothing stands beside it. Values there are
//! bilinear between the four, or linear between the three.

use rayon::prelude::*;

use super::pattern::Suitability;
use weald_core::condition::Condition;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

/// Squares that a task looks at; no result depends on it.
const SQUARES_PER_TASK: usize = 1 << 12;

/// The cells around a place, with their weights.
type Corners = [(usize, f64); 4];

/// The ground and the conditions on it.
pub(super) struct Site<'a> {
    domain: &'a Domain,
    height: &'a Field,
    conditions: Vec<(&'a Condition, &'a Field)>,
    /// Depth of water, and the depth that plants bear.
    water: Option<(&'a Field, f64)>,
    /// Bounds on the suitability in each square between four centres, row-major.
    bounds: Vec<[f64; 2]>,
}

impl<'a> Site<'a> {
    /// The ground of a landscape under these conditions, where water is at most so deep.
    ///
    /// # Errors
    /// [`Error::Run`] where a layer is missing.
    pub(super) fn new(
        landscape: &'a Landscape,
        height: &str,
        conditions: impl Iterator<Item = &'a Condition>,
        deepest: f64,
    ) -> Result<Self, Error> {
        let with_field = |condition: &'a Condition| Ok((condition, landscape.field(&condition.layer.0)?));
        let conditions = conditions.map(with_field).collect::<Result<_, Error>>()?;
        let (domain, height) = (&landscape.domain, landscape.field(height)?);
        let water = landscape.field("water").ok().map(|depth| (depth, deepest));
        let mut site = Self { domain, height, conditions, water, bounds: Vec::new() };
        let [across, down] = site.squares();
        let squares = (0..across * down).into_par_iter().with_min_len(SQUARES_PER_TASK);
        site.bounds = squares.map(|square| site.bounds_of(square % across, square / across)).collect();
        Ok(site)
    }

    /// The sum of the suitability over the ground, in square metres.
    pub(super) fn suitable_area(&self) -> f64 {
        const PARTS: usize = 4;
        let [across, down] = self.squares();
        let (part, cell) = (1.0 / PARTS as f64, self.domain.cell);
        let place = |at: usize| (0.5 + (at as f64 + 0.5) * part) * cell;
        let row = |y: usize| -> f64 {
            let bound = |x: usize| self.bounds[y / PARTS * across + x / PARTS];
            let value = |x: usize| match bound(x) {
                [least, most] if least == most => least,
                _ => self.suitability([place(x), place(y)]),
            };
            (0..PARTS * across).map(value).sum()
        };
        // Rows are summed in their order, whichever thread they come from.
        let rows: Vec<f64> = (0..PARTS * down).into_par_iter().map(row).collect();
        rows.into_iter().sum::<f64>() * (part * cell) * (part * cell)
    }

    /// Height of the ground in metres.
    pub(super) fn height(&self, place: [f64; 2]) -> Option<f64> {
        self.corners(place).map(|corners| between(self.height, &corners))
    }

    /// Unit normal of the ground, by differences over a cell: east, south, up.
    pub(super) fn normal(&self, place: [f64; 2]) -> [f64; 3] {
        let half = 0.5 * self.domain.cell;
        let rise = |axis: usize| {
            let at = |offset: f64| {
                let mut there = place;
                there[axis] += offset;
                self.height(there).map(|height| (offset, height))
            };
            let (Some(before), Some(behind)) = (at(-half).or(at(0.0)), at(half).or(at(0.0))) else {
                return 0.0;
            };
            if behind.0 > before.0 { (behind.1 - before.1) / (behind.0 - before.0) } else { 0.0 }
        };
        unit([-rise(0), -rise(1), 1.0])
    }

    /// Squares between four centres, across and down.
    fn squares(&self) -> [usize; 2] {
        [self.domain.size.columns - 1, self.domain.size.rows - 1]
    }

    /// Steps from the first centre to a place.
    fn steps(&self, place: f64) -> f64 {
        place / self.domain.cell - 0.5
    }

    fn is_valid(&self, cell: usize) -> bool {
        self.domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell))
    }

    /// Those of the four cells around a place that bear it, with their weights.
    fn corners(&self, place: [f64; 2]) -> Option<Corners> {
        let steps = place.map(|along| self.steps(along));
        self.corners_in(self.square_of(steps)?, steps)
    }

    /// The square between centres in which a place lies, given in steps.
    #[inline]
    fn square_of(&self, [u, v]: [f64; 2]) -> Option<[usize; 2]> {
        let [across, down] = self.squares();
        if across * down == 0 || u < 0.0 || v < 0.0 || u > across as f64 || v > down as f64 {
            return None;
        }
        Some([(u as usize).min(across - 1), (v as usize).min(down - 1)])
    }

    /// Whether all four cells around a square have data.
    #[inline]
    fn is_all_ground(&self, [x, y]: [usize; 2]) -> bool {
        self.domain.valid.is_none() || self.around(x, y).into_iter().all(|cell| self.is_valid(cell))
    }

    /// The suitability of a place, in steps, in a square of ground.
    fn suitability_in(&self, [x, y]: [usize; 2], [u, v]: [f64; 2]) -> f64 {
        let (cells, share) = (self.around(x, y), [u - x as f64, v - y as f64]);
        let at = |field| bilinear(&values(field, cells), share);
        if self.water.is_some_and(|(depth, deepest)| at(depth) > deepest) {
            return 0.0;
        }
        let mut suitability = 1.0;
        for (condition, field) in &self.conditions {
            suitability *= condition.mask(at(field));
            if suitability == 0.0 {
                break;
            }
        }
        suitability
    }

    /// The same of a place in a given square or on its edge, in steps.
    fn corners_in(&self, [x, y]: [usize; 2], [u, v]: [f64; 2]) -> Option<Corners> {
        let (u, v) = ((u - x as f64).clamp(0.0, 1.0), (v - y as f64).clamp(0.0, 1.0));
        let cells = self.around(x, y);
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let mut void = (0..4).filter(|&corner| !self.is_valid(cells[corner]));
        match (void.next(), void.next()) {
            (None, _) => Some(std::array::from_fn(|corner| (cells[corner], weights[corner]))),
            (Some(missing), None) => half_square(missing, [u, v])
                .map(|weights| std::array::from_fn(|corner| (cells[corner], weights[corner]))),
            _ => None,
        }
    }

    /// The cells around a square: north-west, north-east, south-west, south-east.
    fn around(&self, x: usize, y: usize) -> [usize; 4] {
        let first = self.domain.size.index(x, y);
        [first, first + 1, first + self.domain.size.columns, first + self.domain.size.columns + 1]
    }

    /// Bounds on the suitability of the square between four centres, from its corners.
    fn bounds_of(&self, x: usize, y: usize) -> [f64; 2] {
        let cells = self.around(x, y);
        let valid = cells.map(|cell| self.is_valid(cell));
        let count = valid.into_iter().filter(|&valid| valid).count();
        if count < 3 {
            return [0.0; 2];
        }
        self.product(count == 4, |field| {
            let cells = cells.into_iter().zip(valid).filter(|(_, valid)| *valid);
            Range::of(cells.map(|(cell, _)| f64::from(field.values()[cell])))
        })
    }

    /// Bounds on the suitability of the part of a rectangle, in steps, that lies in such a square: what is bilinear is
    /// greatest and least in corners.
    fn bounds_within(&self, [x, y]: [usize; 2], [low, high]: [[f64; 2]; 2]) -> [f64; 2] {
        let whole = self.bounds[y * self.squares()[0] + x];
        if whole[0] == whole[1] {
            return whole;
        }
        if self.is_all_ground([x, y]) {
            let share = |[u, v]: [f64; 2]| [u - x as f64, v - y as f64].map(|share| share.clamp(0.0, 1.0));
            let (cells, low, high) = (self.around(x, y), share(low), share(high));
            return self.bounds_on_ground(cells, [low, high]);
        }
        let corners = [low, [high[0], low[1]], [low[0], high[1]], high];
        match corners.map(|place| self.corners_in([x, y], place)) {
            [Some(a), Some(b), Some(c), Some(d)] => self.product(true, |field| {
                Range::of([&a, &b, &c, &d].map(|corners| between(field, corners)).into_iter())
            }),
            [None, None, None, None] => [0.0; 2],
            // The ground ends between the corners.
            _ => [0.0, whole[1]],
        }
    }

    /// The same where all four cells have data, in shares of the way between them.
    #[inline]
    fn bounds_on_ground(&self, cells: [usize; 4], corners: [[f64; 2]; 2]) -> [f64; 2] {
        let range = |field| bilinear_range(&values(field, cells), corners);
        let mut bounds = match self.water.map(|(depth, deepest)| (range(depth), deepest)) {
            Some(([least, _], deepest)) if least > deepest => return [0.0; 2],
            Some(([_, most], deepest)) if most > deepest => [0.0, 1.0],
            _ => [1.0; 2],
        };
        for (condition, field) in &self.conditions {
            let [low, high] = condition.between(range(field));
            bounds = [bounds[0] * low, bounds[1] * high];
            if bounds[1] == 0.0 {
                return [0.0; 2];
            }
        }
        bounds
    }

    /// The product of the bounds of all conditions.
    fn product(&self, is_all_ground: bool, range: impl Fn(&Field) -> Range) -> [f64; 2] {
        let mut bounds = [if is_all_ground { 1.0 } else { 0.0 }, 1.0];
        for (condition, field) in &self.conditions {
            let Range { least, most } = range(field);
            let [low, high] = condition.between([least, most]);
            bounds = [bounds[0] * low, bounds[1] * high];
        }
        match self.water.map(|(depth, deepest)| (range(depth), deepest)) {
            Some((depth, deepest)) if depth.least > deepest => [0.0; 2],
            Some((depth, deepest)) if depth.most > deepest => [0.0, bounds[1]],
            _ => bounds,
        }
    }
}

/// Least and greatest of some values.
struct Range {
    least: f64,
    most: f64,
}

impl Range {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let none = Self { least: f64::INFINITY, most: f64::NEG_INFINITY };
        values.fold(none, |range, value| Self { least: range.least.min(value), most: range.most.max(value) })
    }
}

impl Suitability for Site<'_> {
    fn extent(&self) -> [f64; 2] {
        self.domain.extent()
    }

    fn suitability(&self, place: [f64; 2]) -> f64 {
        let steps = place.map(|along| self.steps(along));
        let Some(square) = self.square_of(steps) else { return 0.0 };
        if self.is_all_ground(square) {
            return self.suitability_in(square, steps);
        }
        let Some(corners) = self.corners_in(square, steps) else { return 0.0 };
        if self.water.is_some_and(|(depth, deepest)| between(depth, &corners) > deepest) {
            return 0.0;
        }
        self.conditions.iter().map(|(condition, field)| condition.mask(between(field, &corners))).product()
    }

    fn bounds(&self, corners: [[f64; 2]; 2]) -> [f64; 2] {
        self.bounds_of_rectangle(corners, true)
    }

    fn rough_bounds(&self, corners: [[f64; 2]; 2]) -> [f64; 2] {
        self.bounds_of_rectangle(corners, false)
    }
}

impl Site<'_> {
    /// Bounds on the suitability between two corners, close or from whole squares alone.
    fn bounds_of_rectangle(&self, [low, high]: [[f64; 2]; 2], is_close: bool) -> [f64; 2] {
        let [across, down] = self.squares();
        // Beside the outermost centres there is no ground.
        let is_beside =
            |axis: usize, count: usize| self.steps(high[axis]) < 0.0 || self.steps(low[axis]) > count as f64;
        if across * down == 0 || is_beside(0, across) || is_beside(1, down) {
            return [0.0; 2];
        }
        let steps = [low, high].map(|corner| corner.map(|along| self.steps(along)));
        let square = |corner: [f64; 2]| {
            let at = |axis: usize, count: usize| (corner[axis].max(0.0) as usize).min(count - 1);
            [at(0, across), at(1, down)]
        };
        let (first, last) = (square(steps[0]), square(steps[1]));
        let is_small = is_close && last[0] - first[0] < 2 && last[1] - first[1] < 2;
        let mut bounds = [f64::INFINITY, 0.0_f64];
        for y in first[1]..=last[1] {
            for x in first[0]..=last[0] {
                let [least, most] =
                    if is_small { self.bounds_within([x, y], steps) } else { self.bounds[y * across + x] };
                bounds = [bounds[0].min(least), bounds[1].max(most)];
            }
        }
        let outside = |axis: usize, count: usize| steps[0][axis] < 0.0 || steps[1][axis] > count as f64;
        if outside(0, across) || outside(1, down) { [0.0, bounds[1]] } else { bounds }
    }
}

/// The values of four cells.
#[inline]
fn values(field: &Field, cells: [usize; 4]) -> [f64; 4] {
    cells.map(|cell| f64::from(field.values()[cell]))
}

/// The value at a share of the way across and down between four corners, never beyond them by rounding.
#[inline]
fn bilinear([nw, ne, sw, se]: &[f64; 4], [u, v]: [f64; 2]) -> f64 {
    let north = (nw + u * (ne - nw)).max(nw.min(*ne)).min(nw.max(*ne));
    let south = (sw + u * (se - sw)).max(sw.min(*se)).min(sw.max(*se));
    (north + v * (south - north)).max(north.min(south)).min(north.max(south))
}

/// Least and greatest of what is bilinear in a rectangle: they are at its corners.
#[inline]
fn bilinear_range(values: &[f64; 4], [low, high]: [[f64; 2]; 2]) -> [f64; 2] {
    let at = |u, v| bilinear(values, [u, v]);
    let [nw, ne, sw, se] =
        [at(low[0], low[1]), at(high[0], low[1]), at(low[0], high[1]), at(high[0], high[1])];
    [nw.min(ne).min(sw.min(se)), nw.max(ne).max(sw.max(se))]
}

/// Weights of three corners of a square, where the place lies between them.
fn half_square(missing: usize, [u, v]: [f64; 2]) -> Option<[f64; 4]> {
    let weights = match missing {
        0 => [0.0, 1.0 - v, 1.0 - u, u + v - 1.0],
        1 => [1.0 - v, 0.0, v - u, u],
        2 => [1.0 - u, u - v, 0.0, v],
        _ => [1.0 - u - v, u, v, 0.0],
    };
    weights.iter().all(|weight| *weight >= 0.0).then_some(weights)
}

/// The value between the corners, and never beyond them by rounding; those without weight take no part, whatever they
/// hold.
fn between(field: &Field, corners: &Corners) -> f64 {
    let (mut sum, mut least, mut most) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
    for &(cell, weight) in corners.iter().filter(|(_, weight)| *weight != 0.0) {
        let value = f64::from(field.values()[cell]);
        sum += value * weight;
        (least, most) = (least.min(value), most.max(value));
    }
    sum.clamp(least, most)
}

/// The vector at length 1.
pub(super) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|number| number * number).sum::<f64>().sqrt();
    vector.map(|number| number / length)
}
