//! A vertical cut through the ground: where each material and the water end, cell by cell and in between.

use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::strata::stack;

/// Ranges of ground behind the cut, near to far, each as its share of the way to the edge.
const RANGES: [[f64; 2]; 3] = [[0.0, 0.2], [0.2, 0.5], [0.5, 1.0]];

/// Water shallower than this, in metres, is not drawn.
const FILM: f32 = 1.0e-3;

/// The cells of a row or a column.
pub(super) struct Cut {
    /// Height of the top of the bedrock and of each material, and where they have data.
    tops: Vec<Vec<f32>>,
    water: Vec<f32>,
    /// Height of the ground as it was, where that is asked for.
    before: Option<Vec<f32>>,
    land: Vec<bool>,
    /// Skylines of the ground behind, near to far; minus infinity where there is none.
    skylines: [Vec<f32>; RANGES.len()],
}

/// The cut at one place.
#[derive(Clone, Debug, Default)]
pub(super) struct Slice {
    /// Heights of the tops of the bedrock and of each material; empty where there is no data.
    pub(super) tops: Vec<f32>,
    /// Height of the water, where there is any.
    pub level: Option<f32>,
    /// Height of the ground as it was, where that is asked for.
    pub(super) before: Option<f32>,
    /// Skylines behind, near to far.
    pub(super) skylines: [f32; RANGES.len()],
}

/// The cells of a field along a line of cells.
#[derive(Clone, Copy)]
pub(super) struct Line {
    /// Whether the line is a column.
    pub(super) down: bool,
    /// Its row or column.
    pub(super) place: usize,
}

impl Line {
    fn values(self, field: &Field) -> Vec<f32> {
        if self.down {
            return (0..field.size().rows).map(|y| field.at(self.place, y)).collect();
        }
        field.row(self.place).to_vec()
    }

    /// The line so many cells behind, seen from the south, or from the west for a column.
    fn behind(self, cells: usize) -> Self {
        Self { place: if self.down { self.place + cells } else { self.place - cells }, ..self }
    }

    /// Lines between this one and the edge behind it.
    fn room(self, field: &Field) -> usize {
        if self.down { field.size().columns - 1 - self.place } else { self.place }
    }
}

impl Cut {
    /// Cuts the landscape, whose surface is `ground`, along a line.
    pub(super) fn new(landscape: &Landscape, ground: &Field, line: Line, water: bool) -> Result<Self, Error> {
        let mut roof = line.values(ground);
        let mut tops = vec![roof.clone()];
        for thickness in stack(landscape, ground)?.iter().rev().map(|layer| line.values(layer)) {
            roof.iter_mut().zip(thickness).for_each(|(roof, thickness)| *roof -= thickness);
            tops.push(roof.clone());
        }
        tops.reverse();
        let dry = || vec![0.0; roof.len()];
        let water =
            landscape.field("water").ok().filter(|_| water).map_or_else(dry, |water| line.values(water));
        let mut bare = ground.clone();
        let mut land = vec![true; roof.len()];
        if let Some(mask) = &landscape.domain.valid {
            let flags = mask.flags().iter();
            bare.values_mut().iter_mut().zip(flags.clone()).for_each(|(height, &land)| {
                *height = if land { *height } else { f32::NEG_INFINITY };
            });
            land = line.values(&bare).iter().map(|height| height.is_finite()).collect();
        }
        let skylines = RANGES.map(|range| skyline(&bare, line, range));
        Ok(Self { tops, water, before: None, land, skylines })
    }

    /// The cut with the line of the ground as it was.
    pub(super) fn with_before(mut self, before: &Field, line: Line) -> Self {
        self.before = Some(line.values(before));
        self
    }

    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.land.len()
    }

    /// Lowest bedrock, and highest ground, water or skyline; `None` without a cell with data.
    pub(super) fn range(&self) -> Option<[f32; 2]> {
        let cells = || (0..self.cells()).filter(|&cell| self.land[cell]);
        let low = cells().map(|cell| self.tops[0][cell]).reduce(f32::min)?;
        let surface = cells().map(|cell| self.surface(cell) + self.water[cell].max(0.0));
        let before = self.before.iter().flat_map(|before| cells().map(|cell| before[cell]));
        let high = surface.chain(before).chain(self.skylines.iter().flatten().copied()).reduce(f32::max)?;
        Some([low, high])
    }

    fn surface(&self, cell: usize) -> f32 {
        self.tops[self.tops.len() - 1][cell]
    }

    /// The cut at a place in cells from the middle of the first one.
    pub(super) fn at(&self, place: f64) -> Slice {
        let place = place.clamp(0.0, (self.cells() - 1) as f64);
        let cell = (place as usize).min(self.cells().saturating_sub(2));
        let next = (cell + 1).min(self.cells() - 1);
        let share = (place - cell as f64) as f32;
        let nearer = if share < 0.5 { cell } else { next };
        // A skyline of no height must not be mixed with one of some.
        let skylines = std::array::from_fn(|range| {
            let ends = [self.skylines[range][cell], self.skylines[range][next]];
            if ends.iter().all(|end| end.is_finite()) { lerp(ends, share) } else { ends[0].min(ends[1]) }
        });
        if !self.land[nearer] {
            return Slice { skylines, ..Slice::default() };
        }
        let [left, right] = [cell, next].map(|cell| if self.land[cell] { cell } else { nearer });
        let tops = self.tops.iter().map(|tops| lerp([tops[left], tops[right]], share)).collect();
        let before = self.before.as_ref().map(|before| lerp([before[left], before[right]], share));
        Slice { tops, level: self.level([left, right], share), before, skylines }
    }

    /// Height of the water between two cells: level up to a bank, falling to ground that lies lower.
    fn level(&self, cells: [usize; 2], share: f32) -> Option<f32> {
        let ground = cells.map(|cell| self.surface(cell));
        let wet = cells.map(|cell| self.water[cell] > FILM);
        let levels = [0, 1].map(|side| ground[side] + self.water[cells[side]]);
        match wet {
            [true, true] => Some(lerp(levels, share)),
            [true, false] => Some(lerp([levels[0], levels[0].min(ground[1])], share)),
            [false, true] => Some(lerp([levels[1].min(ground[0]), levels[1]], share)),
            [false, false] => None,
        }
    }
}

fn lerp([from, to]: [f32; 2], share: f32) -> f32 {
    from * (1.0 - share) + to * share
}

/// Greatest height of each column of sight over a range of lines behind.
fn skyline(ground: &Field, line: Line, [near, far]: [f64; 2]) -> Vec<f32> {
    let room = line.room(ground) as f64;
    let lines = ((near * room) as usize + 1)..=((far * room) as usize);
    let mut skyline = vec![f32::NEG_INFINITY; line.values(ground).len()];
    for cells in lines {
        let heights = line.behind(cells).values(ground);
        skyline.iter_mut().zip(heights).for_each(|(skyline, height)| *skyline = skyline.max(height));
    }
    skyline
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Mask, Size};

    fn cut(water: [f32; 4], land: Option<Mask>) -> Cut {
        let size = Size::new(4, 1).expect("small");
        let mut landscape = Landscape::new(Domain { valid: land, ..Domain::new(size, 1.0) });
        let ground = Field::from_values(size, vec![10.0, 4.0, 4.0, 0.0]);
        landscape.insert("water", "m", Field::from_values(size, water.to_vec()));
        landscape.insert("soil", "m", Field::filled(size, 1.0));
        Cut::new(&landscape, &ground, Line { down: false, place: 0 }, true).expect("cuts")
    }

    #[test]
    fn water_is_level_up_to_its_bank_and_falls_to_lower_ground() {
        let cut = cut([0.0, 2.0, 2.0, 0.0], None);
        let level = |place: f64| cut.at(place).level;
        assert_eq!([level(0.25), level(0.9), level(1.5)], [Some(6.0); 3]);
        assert_eq!(level(2.5), Some(3.0), "half way from the water at 6 m to the dry ground at 0 m");
    }

    #[test]
    fn tops_are_those_of_the_layers_and_end_at_no_data() {
        let mask = Mask::new(Size::new(4, 1).expect("small"), vec![true, true, true, false]);
        let cut = cut([0.0; 4], mask);
        assert_eq!(cut.at(1.0).tops, [3.0, 4.0]);
        assert_eq!(cut.at(0.5).tops, [6.0, 7.0]);
        assert_eq!(cut.at(2.4).tops, [3.0, 4.0], "ground goes on to the edge of its last cell");
        assert!(cut.at(2.6).tops.is_empty());
        assert_eq!(cut.range(), Some([3.0, 10.0]));
    }
}
