//! Watersheds: the land that drains to the same outlet.
//!
//! An outlet is a cell from which water leaves the grid or the data, or flows into the sea. Along a border there
//! are many; those that drain little are merged, the smallest first, with the neighbour with which they share
//! the longest boundary, or left out.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::CELLS_PER_TASK;
use crate::flow::directions::{Directions, OUTLET};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Watersheds>(
    "watersheds",
    Stage::Analyse,
    "labels watersheds: the cells that drain to the same outlet",
    "common practice",
);

choices! {
    /// What becomes of watersheds that are too small.
    pub enum Small {
        /// They become part of the neighbour with which they share the longest boundary.
        Merge = "merge",
        /// They have no number.
        Drop = "drop",
    }
}

parameters! {
    /// Watersheds, from the directions that the step `flow` writes.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::{flow_step::FlowStep, watersheds::Watersheds};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(16, 12)?, 10.0)); // columns, rows, metres
    /// let valleys = |x, y| 5.0 * ((x % 8) as f32 - 4.0).abs() - 0.1 * y as f32; // two, side by side
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valleys));
    /// FlowStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// Watersheds::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let watershed = landscape.field("watershed")?;
    /// assert_eq!(watershed.at(3, 2), watershed.at(5, 9), "one valley");
    /// assert_ne!(watershed.at(4, 6), watershed.at(12, 6), "the other");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Watersheds {
        /// Least area of a watershed. Without it, a hundredth of the land.
        area: Option<f64> = None, range 0.0..=1.0e15, unit "m²";
        /// What becomes of smaller ones: they merge with a neighbour, or have no number, so that the watersheds of
        /// the main rivers are left.
        small: Small = Small::Merge;
    }
}

/// Without `area`, a watershed has at least this share of the land.
const SHARE_OF_THE_LAND: f64 = 0.01;

impl Step for Watersheds {
    fn reads(&self) -> Vec<String> {
        vec!["flow_direction".to_owned()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![("watershed".to_owned(), "1")]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, f64::INFINITY))
    }

    fn measures(&self) -> &'static [(&'static str, &'static str)] {
        &[("watersheds", "number of watersheds")]
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let directions = Directions::of(landscape.field("flow_direction")?, domain.valid.as_ref())?;
        let least = self
            .area
            .map_or(SHARE_OF_THE_LAND * domain.valid_cells() as f64, |area| area / domain.cell_area());
        let labels = watersheds(&directions, domain.valid.as_ref(), self.small, least);
        let count = labels.iter().copied().max().unwrap_or(0);
        let layer = labels.into_iter().map(|label| label as f32).collect();
        landscape.insert("watershed", "1", Field::from_values(domain.size, layer));
        let measures = BTreeMap::from([("watersheds", f64::from(count))]);
        Ok(Outcome { iterations: 1, measures, ..Outcome::default() })
    }
}

/// The number of the watershed of each cell, the largest first from 1; 0 in the sea, without data, and where
/// small ones are dropped. Those of fewer than `least_cells` are small.
pub fn watersheds(directions: &Directions, valid: Option<&Mask>, small: Small, least_cells: f64) -> Vec<u32> {
    let mut labels = by_outlet(directions, valid);
    let sizes = sizes(&labels);
    let is_small = |label: u32| (sizes[label as usize] as f64) < least_cells;
    match small {
        Small::Drop => {
            for label in labels.iter_mut().filter(|label| is_small(**label)) {
                *label = 0;
            }
        }
        Small::Merge => {
            let target = Merging::of(directions.size(), &labels, sizes).merged(least_cells);
            for label in &mut labels {
                *label = root(&target, *label);
            }
        }
    }
    largest_first(&labels)
}

/// A number for each outlet and all cells above it.
fn by_outlet(directions: &Directions, valid: Option<&Mask>) -> Vec<u32> {
    let cells = 0..directions.codes().len();
    let has_data = |cell: usize| valid.is_none_or(|valid| valid.is_valid_at(cell));
    let at_the_border = cells.clone().filter(|&cell| directions.codes()[cell] == OUTLET && has_data(cell));
    let sea = cells.clone().filter(|&cell| directions.is_sea(cell));
    let at_the_sea = sea.flat_map(|cell| directions.upstream(cell));
    let mut numbers = vec![0; cells.len()];
    for (outlet, number) in at_the_border.chain(at_the_sea).zip(1..) {
        numbers[outlet] = number;
    }
    let label = directions.first_on_path(|cell| Some(numbers[cell]).filter(|&number| number > 0));
    cells.into_par_iter().with_min_len(CELLS_PER_TASK).map(|cell| label(cell).unwrap_or(0)).collect()
}

fn sizes(labels: &[u32]) -> Vec<usize> {
    let mut sizes = vec![0; labels.iter().max().map_or(0, |&most| most as usize) + 1];
    for &label in labels {
        sizes[label as usize] += 1;
    }
    sizes
}

fn root(target: &[u32], mut label: u32) -> u32 {
    while target[label as usize] != label {
        label = target[label as usize];
    }
    label
}

/// Watersheds that become one, the smallest first.
struct Merging {
    sizes: Vec<usize>,
    /// Cells along the boundary with each neighbour.
    boundaries: Vec<BTreeMap<u32, u32>>,
}

impl Merging {
    fn of(size: Size, labels: &[u32], sizes: Vec<usize>) -> Self {
        let mut boundaries = vec![BTreeMap::new(); sizes.len()];
        for cell in 0..labels.len() {
            let east = ((cell + 1) % size.columns != 0).then_some(cell + 1);
            let south = Some(cell + size.columns).filter(|&south| south < labels.len());
            for other in [east, south].into_iter().flatten() {
                let (a, b) = (labels[cell], labels[other]);
                if a != b && a != 0 && b != 0 {
                    *boundaries[a as usize].entry(b).or_insert(0) += 1;
                    *boundaries[b as usize].entry(a).or_insert(0) += 1;
                }
            }
        }
        Self { sizes, boundaries }
    }

    /// What each watershed becomes part of; itself where it stays. One without neighbours stays small.
    fn merged(mut self, least_cells: f64) -> Vec<u32> {
        let count = self.sizes.len() as u32;
        let mut target: Vec<u32> = (0..count).collect();
        let mut small: BTreeSet<(usize, u32)> =
            (1..count).map(|label| (self.sizes[label as usize], label)).collect();
        while let Some((size, label)) = small.pop_first().filter(|&(size, _)| (size as f64) < least_cells) {
            let longest = self.boundaries[label as usize]
                .iter()
                .max_by_key(|&(&other, &cells)| (cells, std::cmp::Reverse(other)));
            let Some((&into, _)) = longest else { continue };
            target[label as usize] = into;
            small.remove(&(self.sizes[into as usize], into));
            self.sizes[into as usize] += size;
            small.insert((self.sizes[into as usize], into));
            self.move_boundaries(label, into);
        }
        target
    }

    fn move_boundaries(&mut self, from: u32, into: u32) {
        for (other, cells) in std::mem::take(&mut self.boundaries[from as usize]) {
            self.boundaries[other as usize].remove(&from);
            if other != into {
                *self.boundaries[other as usize].entry(into).or_insert(0) += cells;
                *self.boundaries[into as usize].entry(other).or_insert(0) += cells;
            }
        }
    }
}

/// Numbers from 1 in the order of area, of two of the same area the one further north and west first.
fn largest_first(labels: &[u32]) -> Vec<u32> {
    let sizes = sizes(labels);
    let mut first = vec![usize::MAX; sizes.len()];
    for (cell, &label) in labels.iter().enumerate().rev() {
        first[label as usize] = cell;
    }
    let mut order: Vec<usize> = (1..sizes.len()).filter(|&label| sizes[label] > 0).collect();
    order.sort_unstable_by_key(|&label| (std::cmp::Reverse(sizes[label]), first[label]));
    let mut number = vec![0; sizes.len()];
    for (at, label) in order.into_iter().enumerate() {
        number[label] = at as u32 + 1;
    }
    labels.iter().map(|&label| number[label as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three rows that drain west, of 2, 6 and 4 cells; the rest of the first row has no data.
    fn rows() -> (Directions, Option<Mask>) {
        let size = Size::new(6, 3).expect("legal");
        let codes = vec![0, 5, 0, 0, 0, 0, 0, 5, 5, 5, 5, 5, 0, 5, 5, 5, 9, 9];
        let valid = Mask::new(size, (0..18).map(|cell| !(2..6).contains(&cell)).collect());
        (Directions::new(size, codes), valid)
    }

    #[test]
    fn watersheds_are_numbered_by_area_and_the_sea_has_none() {
        let (directions, valid) = rows();
        let labels = watersheds(&directions, valid.as_ref(), Small::Merge, 0.0);
        assert_eq!(labels, [3, 3, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 0, 0]);
    }

    #[test]
    fn small_ones_merge_with_the_neighbour_they_touch_most_or_are_dropped() {
        let (directions, valid) = rows();
        let merged = watersheds(&directions, valid.as_ref(), Small::Merge, 3.0);
        assert_eq!(merged, [1, 1, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 0, 0]);
        let dropped = watersheds(&directions, valid.as_ref(), Small::Drop, 5.0);
        assert_eq!(dropped, [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0]);
        let one = watersheds(&directions, valid.as_ref(), Small::Merge, 100.0);
        assert_eq!(one.iter().filter(|&&label| label == 1).count(), 12);
    }
}
