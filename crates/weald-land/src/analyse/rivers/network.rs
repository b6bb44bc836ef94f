//! The cells of rivers: which they are, their orders, and how high their water stands.

use crate::flow::directions::Directions;
use weald_core::grid::{Field, Mask};

/// Cells through which rivers flow.
#[derive(Debug)]
pub(super) struct Network {
    /// Whether each cell is of a river, or of a lake or the sea that one flows through or into.
    pub(super) member: Vec<bool>,
    /// The members, each after the one it drains to.
    pub(super) upward: Vec<usize>,
}

impl Network {
    /// All cells above which the land is at least `area`, and all below them. The latter matter where flow
    /// divides, since areas then also shrink downstream.
    pub(super) fn of(directions: &Directions, upslope: &Field, valid: Option<&Mask>, area: f64) -> Self {
        let mut member = vec![false; upslope.values().len()];
        for (cell, &above) in upslope.values().iter().enumerate() {
            if f64::from(above) < area || valid.is_some_and(|valid| !valid.is_valid_at(cell)) {
                continue;
            }
            let mut next = Some(cell);
            while let Some(cell) = next.filter(|&cell| !member[cell]) {
                member[cell] = true;
                next = directions.downstream(cell);
            }
        }
        let upward = directions.upward(|cell| member[cell]);
        Self { member, upward }
    }

    /// Strahler's order of each member; 0 elsewhere. A lake passes on the orders of the rivers that flow into it; no
    /// river has its head in one.
    pub(super) fn orders(&self, directions: &Directions, is_lake: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut order = vec![0; self.member.len()];
        for &cell in self.upward.iter().rev() {
            let donors = || directions.upstream(cell).map(|other| order[other]).filter(|&order| order > 0);
            let highest = donors().max().unwrap_or(u32::from(!is_lake(cell)));
            let meeting = donors().filter(|&order| order == highest).count() > 1;
            order[cell] = highest + u32::from(meeting);
        }
        order
    }

    /// Height of the water: no lower than the ground, and no lower than downstream.
    pub(super) fn levels(&self, directions: &Directions, ground: &Field) -> Vec<f32> {
        let mut level = ground.values().to_vec();
        for &cell in &self.upward {
            if let Some(next) = directions.downstream(cell) {
                level[cell] = level[cell].max(level[next]);
            }
        }
        level
    }
}
