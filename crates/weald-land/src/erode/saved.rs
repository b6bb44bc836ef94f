//! The state of a simulation as a checkpoint holds it, and back.

use weald_core::error::Error;
use weald_engine::SavedSimulation;
use weald_engine::machine::Snapshot;
use weald_engine::stencil::chain::{RowSums, SUMS};

/// A state and the steps that led to it.
#[derive(Clone)]
pub(crate) struct Saved {
    pub(crate) done: u64,
    pub(crate) snapshot: Snapshot,
}

impl Saved {
    /// With the names of its planes.
    pub(crate) fn named(&self, plane_names: &[String]) -> SavedSimulation {
        let Snapshot { state, row_sums, means } = &self.snapshot;
        let names = plane_names.iter().enumerate();
        let mut planes: Vec<_> = names.map(|(plane, name)| (name.clone(), state.gather(plane))).collect();
        planes.extend(means.iter().enumerate().map(|(at, mean)| (format!("mean_{at}"), mean.clone())));
        let sums = vec![("rows".to_owned(), row_sums.as_flattened().to_vec())];
        SavedSimulation { iteration: self.done, planes, sums }
    }

    /// This start with the planes, sums and means of a checkpoint.
    pub(crate) fn resumed(mut self, saved: &SavedSimulation, plane_names: &[String]) -> Result<Self, Error> {
        let cells = self.snapshot.size().cells();
        let plane = |name: &str| {
            let found = saved.planes.iter().find(|(known, _)| known == name);
            let values = found.map(|(_, values)| values).filter(|values| values.len() == cells);
            values.ok_or_else(|| Error::Run(format!("the checkpoint has no plane `{name}` of {cells} cells")))
        };
        for (at, name) in plane_names.iter().enumerate() {
            self.snapshot.state.scatter(at, plane(name)?);
        }
        for (at, mean) in self.snapshot.means.iter_mut().enumerate() {
            mean.clone_from(plane(&format!("mean_{at}"))?);
        }
        let expected = self.snapshot.row_sums.len();
        let sums = saved.sums.iter().find(|(name, _)| name == "rows").map(|(_, sums)| rows_of(sums));
        self.snapshot.row_sums = sums.filter(|rows| rows.len() == expected).ok_or_else(|| {
            Error::Run(format!("the checkpoint has no sums of {} numbers", expected * SUMS))
        })?;
        self.done = saved.iteration;
        Ok(self)
    }
}

fn rows_of(sums: &[f64]) -> Vec<RowSums> {
    sums.as_chunks::<SUMS>().0.to_vec()
}
