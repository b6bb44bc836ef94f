//! Materials in working units: from layers into the state, and back into layers.

use super::stack::{Column, REGOLITH, Stack};
use crate::erode::finished::Finished;
use crate::erode::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::BEDROCK;

impl WorkingGrid {
    /// Takes the thickness of each material above the bedrock as [`material::stack`] says. Regolith of an earlier step goes on as regolith, or settles as material `deposit`.
    pub(crate) fn set_stack(
        &mut self,
        landscape: &Landscape,
        column: Column,
        deposit: usize,
    ) -> Result<(), Error> {
        let size = self.start.size();
        let mut metres = weald_core::strata::stack(landscape, &self.start)?;
        let not_negative = |field: &Field| Field::from_function(size, |x, y| field.at(x, y).max(0.0));
        let before = landscape.field(REGOLITH).ok().map(not_negative);
        let had_regolith = before.is_some();
        if column.regolith.is_some() {
            metres.push(before.unwrap_or_else(|| Field::filled(size, 0.0)));
        } else if let (Some(before), Some(layer)) = (before, deposit.checked_sub(1)) {
            let layer = &mut metres[layer];
            *layer = Field::from_function(size, |x, y| layer.at(x, y) + before.at(x, y));
        }
        let start = metres.iter().map(|layer| self.lengths(layer)).collect();
        let names = landscape.materials[1..].iter().map(|material| material.name.clone()).collect();
        let stack = Stack { column, names, metres, start, had_regolith };
        self.base = self.ringed(|x, y| {
            let bedrock = f64::from(self.start.at(x, y)) - stack.loose_at(x, y);
            ((bedrock - self.lowest) / self.cell) as f32
        });
        self.stack = Some(stack);
        Ok(())
    }

    /// Change of the ground in cells: of the bedrock and of all that lies on it.
    pub(super) fn ground_change(&self, finished: &Finished) -> Vec<f32> {
        let mut change = finished.state.gather(0);
        let Some(stack) = &self.stack else { return change };
        let layers: Vec<_> = stack.planes().map(|plane| finished.state.gather(plane)).collect();
        for (at, change) in change.iter_mut().enumerate() {
            let gained =
                layers.iter().zip(&stack.start).map(|(now, start)| f64::from(now[at]) - f64::from(start[at]));
            *change = (f64::from(*change) + gained.sum::<f64>()) as f32;
        }
        change
    }

    /// All that lies on the bedrock before and after, in cells³.
    pub(super) fn loose(&self, finished: &Finished) -> [f64; 2] {
        let Some(stack) = &self.stack else { return [0.0; 2] };
        let before = stack.start.iter().map(|layer| self.total(layer)).sum();
        let after = stack.planes().map(|plane| self.total(&finished.state.gather(plane))).sum();
        [before, after]
    }

    /// Writes the layers of the bedrock, of each material and of the regolith.
    pub(super) fn store_stack(&self, landscape: &mut Landscape, finished: &Finished) {
        let Some(stack) = &self.stack else { return };
        let change = finished.state.gather(0);
        let moved = self.field(&change, |change| change);
        let bedrock = |x, y| {
            let start = f64::from(self.start.at(x, y)) - stack.loose_at(x, y);
            (start + f64::from(moved.at(x, y)) * self.cell) as f32
        };
        landscape.insert(BEDROCK, "m", Field::from_function(self.start.size(), bedrock));
        let regolith = stack.column.regolith.map(|_| REGOLITH);
        let names = stack.names.iter().map(String::as_str).chain(regolith);
        for ((name, plane), (metres, start)) in
            names.zip(stack.planes()).zip(stack.metres.iter().zip(&stack.start))
        {
            let now = finished.state.gather(plane);
            landscape.insert(name, "m", self.thickness(&now, start, metres));
        }
        if regolith.is_none() && stack.had_regolith {
            landscape.insert(REGOLITH, "m", Field::filled(self.start.size(), 0.0));
        }
    }

    /// A thickness in metres, which stays to the bit where nothing changed.
    fn thickness(&self, now: &[f32], start: &[f32], metres: &Field) -> Field {
        let cell = self.cell as f32;
        Field::from_function(metres.size(), |x, y| {
            let changed = self.place(x, y).filter(|&at| now[at] != start[at]);
            changed.map_or_else(|| metres.at(x, y), |at| now[at] * cell)
        })
    }
}
