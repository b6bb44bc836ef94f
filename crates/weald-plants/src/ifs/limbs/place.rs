//! From parts to vertices in space, by the habit of the plant.

use super::hull::{AMONG_LEAVES, HULLS};
use super::leaf::{Row, bent, difference, length, lowered, unit};
use super::limb::{Corner, LEVELS, Limb, Limbs};
use super::outline::Outline;
use super::walk::{Branch, Part, Walk};
use crate::ifs::foliage::{Frond, Habit, Shape};
use crate::ifs::map::{Map, Point, cross, dot};
use crate::ifs::system::Ifs;
use weald_core::random::{hash2, unit as unit_of};

/// Rows between foot and tip of leaves by their size, the largest first.
const ROWS: [(f64, usize); 3] = [(0.2, 7), (0.05, 3), (0.0, 1)];

/// Rows of a whole frond as one leaf, of which every other one is so much narrower.
const TEETH: usize = 13;
const BETWEEN_TEETH: f64 = 0.25;

/// Least and greatest factor by which leaves of a level are broader, so that all have the same area.
const BROADER: [f32; 2] = [0.25, 3.0];

/// Share of a frond of a rosette that bears no leaves.
const STIPE: f64 = 0.08;

/// How open to the light a place at the root is, and a stem at least below a crown: the light comes in from all sides there.
const MIN_OPENNESS: f32 = 0.35;
const OF_STEMS: f32 = 0.8;

/// Greatest breadth of a leaf of a crown beside its length, however broad the crown is.
const LEAF_BREADTH: f64 = 0.62;

/// Length of the finest leaves of such a broad crown beside that of the part that each is: one sees through between them.
const LEAF_LENGTH: f64 = 0.66;

/// Last level, with few leaves in all.
const CHEAP: u32 = LEVELS as u32 - 1;

/// Most planes of fronds that are all drawn on the last level.
const FEW: usize = 12;

/// What a plant is made of.
pub(super) struct Builder {
    habit: Habit,
    pub(super) shape: Shape,
    outline: Outline,
    walk: Walk,
    fronds: Vec<Frond>,
    /// Share of a frond below its first leaves.
    pub(super) stipe: f64,
    /// Breadth of a leaf beside that of the outline of the whole.
    narrowed: f64,
}

/// A leaf to be put in space.
#[derive(Clone, Copy)]
pub(super) struct Leaf<'a> {
    pub(super) part: &'a Part,
    pub(super) frond: &'a Frond,
    /// Number of the frond's first limb.
    pub(super) first_limb: u32,
    pub(super) view: usize,
    pub(super) rows: usize,
}

impl Builder {
    pub(super) fn new(ifs: &Ifs, habit: Habit) -> Self {
        let shape = Shape::of(ifs);
        let outline = Outline::of(ifs, &shape);
        let fronds = habit.fronds();
        let stipe = if habit.is_rosette() { STIPE } else { 0.0 };
        let copies = if is_crown(habit, &outline) { 1 } else { fronds.len() * outline.views() };
        let walk = Walk::of(ifs, &shape, (habit, copies));
        let narrowed = if is_crown(habit, &outline) { narrowed(&outline) } else { 1.0 };
        Self { habit, shape, outline, walk, fronds, stipe, narrowed }
    }

    pub(super) fn plant(&self) -> Limbs {
        let mut plant = Limbs::default();
        for (number, frond) in self.fronds.iter().enumerate() {
            let first_limb = plant.limbs.len() as u32;
            plant.limbs.extend(self.walk.branches.iter().map(|branch| self.limb(branch, frond, first_limb)));
            for part in self.walk.parts.iter().filter(|part| !self.is_in_hull(part)) {
                self.part(&mut plant, part, frond, first_limb);
            }
            let are_few = self.fronds.len() * self.outline.views() <= FEW;
            if !self.is_crown() && (are_few || number % 2 == 0) {
                self.cheap(&mut plant, frond, first_limb);
            }
        }
        let leafy = if self.is_crown() { HULLS[0].level } else { LEVELS as u32 };
        even_areas(&mut plant, leafy);
        if self.is_crown() {
            for hull in &HULLS {
                hull.add(&mut plant, &self.outline, |flat| self.on_frond(&self.fronds[0], flat).0);
            }
        }
        bring_to_one_metre(&mut plant);
        open_to_light(&mut plant);
        if self.is_crown() {
            let hulls = plant.corners.iter_mut().filter(|corner| corner.levels[0] >= leafy);
            hulls.for_each(|corner| corner.open *= AMONG_LEAVES);
        }
        plant
    }

    /// Whether coarse levels are hulls: of a crown that is a body and not a few planes.
    pub(super) fn is_crown(&self) -> bool {
        is_crown(self.habit, &self.outline)
    }

    /// Whether a part is a leaf of those levels alone.
    fn is_in_hull(&self, part: &Part) -> bool {
        self.is_crown() && !part.is_stem && part.levels[0] >= HULLS[0].level
    }

    /// Length of a leaf beside that of its part.
    fn long(&self, part: &Part) -> f64 {
        if self.narrowed < 1.0 && part.levels[0] == 0 { LEAF_LENGTH } else { 1.0 }
    }

    /// The levels of a part, of which those of hulls have no leaves.
    pub(super) fn levels_of(&self, part: &Part) -> [u32; 2] {
        let [first, last] = part.levels;
        [first, if self.is_crown() { last.min(HULLS[0].level - 1) } else { last }]
    }

    fn placed(&self, frond: &Frond, map: &Map, flat: Point) -> (Point, Point) {
        self.on_frond(frond, self.shape.flat(map.at(self.shape.point(flat))))
    }

    pub(super) fn on_frond(&self, frond: &Frond, flat: Point) -> (Point, Point) {
        self.habit.placed(frond, self.lifted(flat))
    }

    /// Where a point of the shape is on a frond, which begins above a bare stipe.
    fn lifted(&self, [x, y, z]: Point) -> Point {
        let rest = 1.0 - self.stipe;
        [rest * x, self.stipe + rest * y, rest * z]
    }

    /// How far along a branch a place is, the first of which begins with the stipe.
    fn along(&self, branch: usize, along: f64) -> f64 {
        if branch == 0 { self.lifted([0.0, along, 0.0])[1] } else { along }
    }

    fn tip(&self) -> Point {
        let [left, right] = self.outline.at(0, 1.0);
        [0.5 * (left + right), 1.0, 0.0]
    }

    fn limb(&self, branch: &Branch, frond: &Frond, first: u32) -> Limb {
        let joint = match branch.parent {
            Some(_) => self.placed(frond, &branch.map, [0.0; 3]).0,
            None => self.habit.placed(frond, [0.0; 3]).0,
        };
        let tip = self.placed(frond, &branch.map, self.tip()).0;
        let phase = match branch.parent {
            Some(_) => unit_of(hash2(branch.key, frond.number, 0)),
            None if self.habit.is_rosette() => frond.phase,
            // Planes that cross in one stem sway as one.
            None => 0.0,
        };
        Limb {
            joint: joint.map(|x| x as f32),
            direction: unit(difference(tip, joint)).map(|x| x as f32),
            parent: branch.parent.map(|parent| first + parent as u32),
            along: branch.parent.map_or(0.0, |parent| self.along(parent, branch.along)) as f32,
            order: branch.order.min(3),
            // As ten bits hold it.
            phase: ((1024.0 * phase) as u32) as f32 / 1024.0,
        }
    }

    fn part(&self, plant: &mut Limbs, part: &Part, frond: &Frond, first_limb: u32) {
        let rows = ROWS.iter().find(|(size, _)| part.size > *size).map_or(1, |(_, rows)| *rows);
        let rows = if self.is_serrated(part) { TEETH } else { rows };
        // A crown has so many leaves that each needs no more than one blade, which looks to the front or aside by chance.
        let only = (self.is_crown() && !part.is_stem).then_some((part.key >> 7) as usize % 2);
        for view in (0..self.outline.views()).filter(|view| only.is_none_or(|only| only == *view)) {
            let leaf = Leaf { part, frond, first_limb, view, rows };
            if part.is_stem { self.stem(plant, &leaf) } else { self.leaf(plant, &leaf) }
        }
    }

    /// Whether a part is a whole frond as one leaf, whose edge shows that it is feathery.
    fn is_serrated(&self, part: &Part) -> bool {
        self.habit.is_rosette() && part.levels[0] < CHEAP && part.size >= 1.0
    }

    /// The whole as one leaf.
    fn cheap(&self, plant: &mut Limbs, frond: &Frond, first_limb: u32) {
        let (map, within) = (Map::IDENTITY, Map::IDENTITY);
        let levels = [CHEAP; 2];
        let part = &Part { map, within, branch: 0, size: 1.0, levels, is_stem: false, key: 0 };
        for view in 0..self.outline.views() {
            self.leaf(plant, &Leaf { part, frond, first_limb, view, rows: 1 });
        }
    }

    /// A foot, pairs of corners, and a tip.
    fn leaf(&self, plant: &mut Limbs, leaf: &Leaf<'_>) {
        let rows: Vec<_> = (0..=leaf.rows + 1).map(|row| self.row(leaf, row)).collect();
        let ends = difference(rows[leaf.rows + 1].axis, rows[0].axis);
        let length = dot(ends, ends).sqrt();
        let chance = unit_of(hash2(leaf.part.key, leaf.frond.number, 11));
        let first = plant.corners.len() as u32;
        for (number, row) in rows.iter().enumerate() {
            let axis = lowered(row.axis, row, length);
            if number == 0 || number == leaf.rows + 1 {
                plant.corners.push(self.corner(leaf, row, [axis, axis, row.normal]));
                continue;
            }
            for side in 0..2 {
                let (rest, normal) = bent(row, side, length, chance);
                let corner = self.corner(leaf, row, [rest, axis, normal]);
                plant.corners.push(Corner { side: [-1, 1][side], ..corner });
            }
        }
        plant.triangles.extend(leaf_triangles(first, leaf.rows as u32));
    }

    /// A row of a leaf, flat, where it is in space.
    fn row(&self, leaf: &Leaf<'_>, number: usize) -> Row {
        let along = self.along_of(leaf, number);
        let is_end = number == 0 || number == leaf.rows + 1;
        let front = self.outline.at(0, along);
        let middle = |[left, right]: [f64; 2]| if number == 0 { 0.0 } else { 0.5 * (left + right) };
        let mut axis = [middle(front), along, 0.0];
        let mut sides = [axis; 2];
        let across = if leaf.view == 0 { 0 } else { 2 };
        let found = self.outline.at(leaf.view, along);
        axis[across] = middle(found);
        let tooth = if self.is_serrated(leaf.part) && number.is_multiple_of(2) { BETWEEN_TEETH } else { 1.0 };
        let tooth = self.narrowed * tooth;
        for (side, x) in sides.iter_mut().zip(found) {
            side[across] = if is_end { axis[across] } else { axis[across] + tooth * (x - axis[across]) };
        }
        let long = self.long(leaf.part);
        let (axis, sides) = (axis.map(|x| long * x), sides.map(|side| side.map(|x| long * x)));
        let (place, normal) = self.placed(leaf.frond, &leaf.part.map, axis);
        let sides = sides.map(|side| self.placed(leaf.frond, &leaf.part.map, side).0);
        Row { axis: place, sides, normal: facing(sides, self.ahead(leaf, axis), normal), along }
    }

    /// The way a leaf grows at a point of its axis.
    fn ahead(&self, leaf: &Leaf<'_>, axis: Point) -> Point {
        let [before, after] = [-0.02, 0.02]
            .map(|step| self.placed(leaf.frond, &leaf.part.map, [axis[0], axis[1] + step, axis[2]]).0);
        difference(after, before)
    }

    fn along_of(&self, leaf: &Leaf<'_>, row: usize) -> f64 {
        // A leaf of one row is broadest there.
        if leaf.rows == 1 {
            [0.0, self.outline.broadest(), 1.0][row]
        } else {
            row as f64 / (leaf.rows + 1) as f64
        }
    }

    pub(super) fn corner(&self, leaf: &Leaf<'_>, row: &Row, [rest, axis, normal]: [Point; 3]) -> Corner {
        let within = leaf.part.within.at(self.shape.point([0.0, row.along, 0.0]));
        Corner {
            rest: rest.map(|x| x as f32),
            axis: axis.map(|x| x as f32),
            normal: normal.map(|x| x as f32),
            along: self.along(leaf.part.branch, self.shape.share_above_root(within)) as f32,
            limb: leaf.first_limb + leaf.part.branch as u32,
            levels: self.levels_of(leaf.part),
            is_stem: leaf.part.is_stem,
            up: row.along as f32,
            side: 0,
            tone: unit_of(hash2(leaf.part.key, leaf.frond.number, 12)) as f32,
            open: 1.0,
        }
    }
}

/// Whether a plant is a crown that is a body, and not a few planes.
fn is_crown(habit: Habit, outline: &Outline) -> bool {
    habit == Habit::Single && outline.views() == 2
}

/// Breadth of a leaf of a crown of such an outline beside that of the outline.
fn narrowed(outline: &Outline) -> f64 {
    let [left, right] = outline.at(0, outline.broadest());
    (LEAF_BREADTH / (right - left).max(1e-9)).min(1.0)
}

/// The normal of a row, on the side of that of its shape.
fn facing(sides: [Point; 2], ahead: Point, above: Point) -> Point {
    let normal = unit(cross(difference(sides[1], sides[0]), ahead));
    let upright = dot(normal, above);
    if upright.abs() < 1e-3 { above } else { normal.map(|x| x * upright.signum()) }
}

/// The triangles of a foot, so many pairs, and a tip: none has any area where the pairs lie on the axis.
fn leaf_triangles(first: u32, rows: u32) -> Vec<[u32; 3]> {
    let (foot, tip) = (first, first + 2 * rows + 1);
    let pair = |row: u32| [first + 2 * row + 1, first + 2 * row + 2];
    let [left, right] = pair(0);
    let mut triangles = vec![[foot, left, right]];
    for row in 1..rows {
        let ([a, b], [c, d]) = (pair(row - 1), pair(row));
        triangles.extend([[a, c, b], [b, c, d]]);
    }
    let [left, right] = pair(rows - 1);
    triangles.push([left, tip, right]);
    triangles
}

/// Makes leaves of each of so many levels broader or narrower, so that its area is that of the finest.
fn even_areas(plant: &mut Limbs, levels: u32) {
    let whole = plant.area(0);
    for level in 1..levels {
        let shared = plant.area_where(|corner| corner.levels[0] < level && level <= corner.levels[1]);
        let own = plant.area_where(|corner| corner.levels[0] == level);
        let factor = ((whole - shared) / own.max(1e-9)).clamp(BROADER[0], BROADER[1]);
        let leaves = plant.corners.iter_mut().filter(|corner| !corner.is_stem && corner.levels[0] == level);
        for corner in leaves {
            corner.rest =
                std::array::from_fn(|i| corner.axis[i] + factor * (corner.rest[i] - corner.axis[i]));
        }
    }
}

/// Brings the highest vertex of the finest level to a height of 1.
fn bring_to_one_metre(plant: &mut Limbs) {
    let finest = plant.corners.iter().filter(|corner| corner.levels[0] == 0);
    let scale = 1.0 / finest.map(|corner| corner.rest[1]).fold(f32::MIN_POSITIVE, f32::max);
    let joints = plant.limbs.iter_mut().map(|limb| &mut limb.joint);
    let corners = plant.corners.iter_mut().flat_map(|corner| [&mut corner.rest, &mut corner.axis]);
    for number in joints.chain(corners).flatten() {
        *number *= scale;
    }
}

/// Leaves far from the root see much of the sky, those within little.
fn open_to_light(plant: &mut Limbs) {
    let radius = plant.radius();
    for corner in &mut plant.corners {
        let share = length(corner.rest) / radius;
        corner.open = MIN_OPENNESS + (1.0 - MIN_OPENNESS) * share * (2.0 - share);
        if corner.is_stem {
            corner.open = corner.open.max(OF_STEMS);
        }
    }
}

impl Limbs {
    /// The plant of a fractal, of this habit.
    pub fn of(ifs: &Ifs, habit: Habit) -> Self {
        Builder::new(ifs, habit).plant()
    }
}
