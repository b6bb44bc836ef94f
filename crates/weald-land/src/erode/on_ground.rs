//! Runs a pipeline on the ground of a landscape, for steps that are one.
//!
//! Its first constant plane is `base`, the ground of the start; its first state plane is the change of the ground
//! since then, both in cells.

use std::sync::Arc;

use super::edits::{PaintedPlanes, Place};
use super::finished::Finished;
use super::material_planes::Planes;
use super::pipeline::{Pipeline, Stepped};
use super::scripted::{Numbers, Remake};
use super::stack::Column;
use super::started::{Course, StartedSimulation, Store};
use super::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::step::Outcome;

/// What a step is called, which layer it changes and how long it runs.
pub(crate) struct OnGround<'a> {
    pub(crate) name: &'static str,
    pub(crate) layer: &'a str,
    pub(crate) iterations: u32,
}

/// Makes a pipeline anew after keys were set.
pub(crate) type Piped = Box<dyn Fn(&[crate::edit::Setting]) -> Result<Arc<Pipeline>, Error> + Send + Sync>;

impl OnGround<'_> {
    /// Runs the pipeline of a step whose keys do not change while it runs.
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "the shortest form of a step, of which none is built in")
    )]
    pub(crate) fn run(
        &self,
        pipeline: &Arc<Pipeline>,
        landscape: &mut Landscape,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let pipeline = Arc::clone(pipeline);
        let begun = self.begin(Box::new(move |_| Ok(Arc::clone(&pipeline))), landscape, false)?;
        begun.run(Course::of(self.iterations, None), landscape, job)
    }

    /// The pipeline of the keys, on the ground; such that strokes can change it where it is `editable`.
    pub(crate) fn begin(
        &self,
        piped: Piped,
        landscape: &Landscape,
        editable: bool,
    ) -> Result<StartedSimulation<Stepped>, Error> {
        let mut working = WorkingGrid::new(landscape, self.layer, false)?;
        if editable {
            working.set_changing_mask();
        }
        let (name, working) = (self.name, Arc::new(working));
        let grid = (working.size, working.mask.is_some());
        let process: Stepped = Stepped::new(name, &piped(&[])?, grid);
        let (place, remake) = (self.place(&process, landscape, &working), remake(name, piped, grid));
        let (planes, ground) = (process.state_names().len(), Arc::clone(&working));
        Ok(StartedSimulation {
            plane_names: process.state_names(),
            start: Box::new(move || ground.state(planes, &[])),
            numbers: Numbers::new(process, |_| ()),
            remake,
            means: &[],
            place: Some(Arc::new(place)),
            store: store_ground(&working, self.layer),
            working: Some(working),
        })
    }

    fn place(&self, process: &Stepped, landscape: &Landscape, working: &WorkingGrid) -> Place {
        let first_layer = process.state_names().len();
        let column = Column { planes: Planes { first_layer, materials: 1 }, regolith: None };
        let materials = landscape.materials.iter().take(1).map(|material| material.name.clone()).collect();
        Place::of(self.name, working, materials, PaintedPlanes::of(process, column, working))
    }
}

fn remake(name: &'static str, piped: Piped, grid: (Size, bool)) -> Remake<Stepped> {
    Arc::new(move |settings| Ok(Numbers::new(Stepped::new(name, &piped(settings)?, grid), |_| ())))
}

/// Writes the ground, for steps without water.
pub(crate) fn store_ground(working: &Arc<WorkingGrid>, layer: &str) -> Store {
    let (working, layer) = (Arc::clone(working), layer.to_owned());
    Arc::new(move |landscape: &mut Landscape, finished: &Finished, iterations| {
        Ok(working.store_ground(landscape, &layer, finished, iterations))
    })
}
