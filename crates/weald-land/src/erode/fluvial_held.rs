//! A flood that a person holds, and its script: on one grid, step by step, of the length that the recipe's numbers give.

use std::sync::Arc;

use super::edits::{PaintedPlanes, Place};
use super::finished::Finished;
use super::fluvial;
use super::fluvial_run::Flood;
use super::fluvial_step::Fluvial;
use super::hydraulic::Boundary;
use super::interactive::{Interactive, InteractiveSimulation, whole};
use super::material_planes::Planes;
use super::pipeline::Stepped;
use super::scripted::{self, Edits, Remake};
use super::settings;
use super::springs::Forcing;
use super::stack::Column;
use super::started::{StartedSimulation, Store};
use super::water_planes as plane;
use crate::edit::{Script, Setting};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::source::Value;
use weald_engine::Engine;
use weald_engine::stencil::chain::Process;
use weald_engine::step::Outcome;

/// Keys of what a flood begins with.
const FIXED: &[&str] = &[
    "duration",
    "flow_time",
    "rain_map",
    "sources",
    "erodibility_map",
    "materials",
    "levels",
    "coarsest",
    "steps",
    "mean_over",
    "boundary",
    "layer",
    "initial_water",
    "region",
    "edits",
];

impl Fluvial {
    /// How many steps it has.
    pub(super) fn count(&self, cell: f64) -> u64 {
        self.steps.map_or_else(|| self.steps(cell).count, u64::from)
    }

    fn after(&self, settings: &[Setting]) -> Result<Self, Error> {
        settings::after(self, (&[], FIXED), settings)
    }

    /// The script of edits, which is read here.
    pub(super) fn script(&self, materials: &[Material]) -> Result<Option<Script>, Error> {
        let try_keys = |settings: &[Setting]| settings::no_faults(&self.after(settings)?, materials);
        scripted::load(self.edits.as_ref(), self.boundary == Boundary::Open, materials, try_keys)
    }

    /// A script with what it works on.
    pub(super) fn edits_of(&self, script: Script, flood: &Flood) -> Edits<Stepped<Forcing>> {
        Edits { script, place: Some(Arc::new(flood.place())), remake: self.remake(flood) }
    }

    /// Reads the keys anew for a flood that runs, whose steps keep their length.
    fn remake(&self, flood: &Flood) -> Remake<Stepped<Forcing>> {
        let (step, landscape, seconds) = (self.clone(), flood.landscape.clone(), flood.steps().seconds);
        let baked = flood.numbers.rain_map;
        Arc::new(move |keys| {
            let changed = step.after(keys)?;
            settings::no_faults(&changed, &landscape.materials)?;
            if baked && changed.rain != step.rain {
                let message = "`rain` cannot change while the simulation runs with `rain_map` or `sources`: it is part of \
                               what it begins with";
                return Err(Error::Run(message.to_owned()));
            }
            let changed = Flood::on(changed, &landscape, true)?;
            if changed.steps().seconds != seconds {
                let message = format!(
                    "this value would make steps {} s long instead of {seconds} s, which cannot change while the \
                     simulation runs",
                    changed.steps().seconds
                );
                return Err(Error::Run(message));
            }
            Ok(changed.running())
        })
    }
}

impl Flood {
    /// Where strokes fall. The ground is one thing to them: what is laid on it settles as the last material.
    fn place(&self) -> Place {
        let process = self.running().process;
        let column =
            Column { planes: Planes { first_layer: process.state_planes(), materials: 1 }, regolith: None };
        let planes = PaintedPlanes {
            water: Some(plane::DEPTH),
            ..PaintedPlanes::of(&*process, column, &self.working)
        };
        let materials =
            self.landscape.materials.iter().take(1).map(|material| material.name.clone()).collect();
        Place::of("fluvial", &self.working, materials, planes)
    }
}

impl Interactive for Fluvial {
    fn hold(&self, landscape: &Landscape, engine: &Engine) -> Result<InteractiveSimulation, Error> {
        let mut flood = Flood::on(self.clone(), landscape, true)?;
        let (numbers, start) = (flood.running(), flood.start(None)?);
        let (place, remake) = (Some(Arc::new(flood.place())), self.remake(&flood));
        flood.working.show(engine)?;
        let begun: StartedSimulation<Stepped<Forcing>> = StartedSimulation {
            plane_names: numbers.process.state_names(),
            numbers,
            remake,
            means: fluvial::MEAN_FLUXES,
            start: Box::new(move || start),
            place,
            store: store(flood),
            working: None,
        };
        InteractiveSimulation::new(begun, landscape, engine)
    }

    fn replayed(&self, steps: u64) -> Vec<(&'static str, Value)> {
        vec![("levels", Value::Integer(1)), ("steps", whole(steps)), ("mean_over", Value::Integer(1))]
    }

    fn written_steps(&self, landscape: &Landscape) -> u64 {
        self.count(landscape.domain.cell)
    }

    fn recorded(&self, materials: &[Material]) -> Result<Option<(u64, Script)>, Error> {
        let steps = self.steps.map(u64::from);
        Ok(self
            .script(materials)?
            .map(|script| (steps.unwrap_or(script.edits().last().map_or(0, |edit| edit.step)), script)))
    }
}

/// Writes what a flood leaves.
fn store(flood: Flood) -> Store {
    Arc::new(move |landscape: &mut Landscape, finished: &Finished, iterations| {
        let budget = Some(flood.store(landscape, finished));
        Ok(Outcome { iterations, budget, notes: finished.notes.clone(), ..Outcome::default() })
    })
}
