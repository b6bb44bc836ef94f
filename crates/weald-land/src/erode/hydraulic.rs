//! The `hydraulic` step: rain carves ground. The models `han`, `mei` and `stava` each have keys of their own beside those in common.
//!
//! Its layers `erosion` and `deposition` are what the ground lost and gained in metres between the start of this step
//! and its end, all materials, regolith and sliding together; of each cell one of them is 0. What was laid down and
//! worn away again is in neither.

mod defaults;
mod faults;
mod keys;
mod models;
mod on_disk;
mod pipe_models;
mod stava;

pub use super::mei::Slope;
pub use keys::{Boundary, HanKeys, Hydraulic, MeiKeys, Model, StavaKeys, Transport, UptakeLaw};
use std::collections::BTreeSet;
use std::path::PathBuf;

use super::advection::Advection;
use super::extent::empty_note;
use super::interactive::{Interactive, InteractiveSimulation, whole};
use super::springs::Forcing;
use super::stack::REGOLITH;
use super::thermal::Slide;
use super::thermal_step::ThermalWithin;
use crate::edit::Script;
use defaults::ResolvedKeys;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, ScriptFile};
use weald_core::source::Value;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};
use weald_engine::stored::StoredLandscape;
use weald_engine::{Engine, Job};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Hydraulic>(
    "hydraulic",
    Stage::Erode,
    "carves ground by rain, rivers and sediment",
    "Han 2015, doi 10.7583/JKGS.2015.15.6.171; Mei, Decaudin, Hu 2007, doi 10.1109/PG.2007.15; \
     Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210",
);

impl Hydraulic {
    /// How sediment travels.
    pub fn transport(&self) -> Transport {
        self.model.transport().0
    }

    fn advection(&self, filled: &ResolvedKeys) -> Option<Advection> {
        match self.model.transport() {
            (Transport::Upwind, _) => None,
            (Transport::SemiLagrangian, _) => Some(Advection::SemiLagrangian),
            (Transport::MacCormack, true) => Some(Advection::FluxCorrected { epsilon: filled.epsilon }),
            (Transport::MacCormack, false) => Some(Advection::MacCormack),
        }
    }

    /// Whether transport loses no sediment.
    fn conserves(&self) -> bool {
        match self.model.transport() {
            (Transport::Upwind, _) => true,
            (Transport::SemiLagrangian, _) => false,
            (Transport::MacCormack, conserve) => conserve,
        }
    }

    fn slide(&self) -> Option<Slide> {
        self.model.thermal().map(ThermalWithin::slide)
    }

    /// Rain and evaporation of a step: first it rains, then the sun shines; `mei` evaporates always, and `stava`
    /// where there is no dry period.
    fn forcing(&self, filled: &ResolvedKeys, step: u64) -> Forcing {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let raining = step % cycle < u64::from(self.rain_period);
        let rain = if raining { filled.rain } else { 0.0 };
        let evaporates = match self.model {
            Model::Han(_) => !raining,
            Model::Mei(_) => true,
            Model::Stava(_) => !raining || filled.dry_period == 0,
        };
        Forcing { rain, evaporation: if evaporates { filled.evaporation } else { 0.0 } }
    }

    /// The steps whose fluxes are averaged: those of the last whole cycle of rain and sun, or all where none was whole.
    fn recorded(&self, cell: f64) -> std::ops::Range<u64> {
        let iterations = u64::from(self.iterations);
        if let Some(steps) = self.mean_over {
            return iterations.saturating_sub(u64::from(steps))..iterations;
        }
        let cycle = u64::from(self.rain_period) + u64::from(self.filled(cell).dry_period);
        let end = iterations / cycle * cycle;
        if end == 0 { 0..iterations } else { end - cycle..end }
    }
}

impl Step for Hydraulic {
    fn reads(&self) -> Vec<String> {
        let painted = self.model.stava().into_iter();
        let painted =
            painted.flat_map(|keys| [&keys.rain_layer, &keys.evaporation_layer, &keys.source_layer]);
        let others = [&self.initial_water, &self.region].into_iter().chain(painted);
        std::iter::once(&self.layer).chain(others.flatten()).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = [
            ("water", "m"),
            ("sediment", "m"),
            ("flux_x", "m³/step"),
            ("flux_y", "m³/step"),
            ("erosion", "m"),
            ("deposition", "m"),
        ];
        let dissolves = self.model.stava().is_some_and(|keys| keys.dissolution.is_some());
        let regolith = dissolves.then_some((REGOLITH, "m"));
        let own = own.into_iter().chain(regolith);
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn layered(&self) -> Layered {
        if self.model.stava().is_some() { Layered::Changes } else { Layered::Never }
    }

    fn files(&self) -> Vec<PathBuf> {
        self.edits.as_ref().map(ScriptFile::path).into_iter().collect()
    }

    fn look_ahead(&self, materials: &[Material], _: &Domain) -> Result<(), Error> {
        self.script(materials).map(drop)
    }

    fn faults(&self) -> Vec<Fault> {
        self.all_faults()
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        self.all_faults_among(materials)
    }

    fn bytes_per_cell(&self) -> u64 {
        match self.model {
            Model::Han(_) => 92,
            Model::Mei(_) => 118,
            Model::Stava(_) => 142,
        }
    }

    fn runs_over_ranks(&self) -> bool {
        true
    }

    fn work(&self, _: &Domain) -> Work {
        Work::of(self.iterations).by(match self.model {
            Model::Han(_) => "han",
            Model::Mei(_) => "mei",
            Model::Stava(_) => "stava",
        })
    }

    fn scratch_per_cell(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        self.scratch_on_disk(wanted)
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        self.run_bands_on_disk(landscape, job)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let told = empty_note(landscape, self.region.as_ref());
        let mut outcome = self.run_model(landscape, job)?;
        outcome.notes.extend(told);
        Ok(outcome)
    }
}

impl Interactive for Hydraulic {
    fn hold(&self, landscape: &Landscape, engine: &Engine) -> Result<InteractiveSimulation, Error> {
        self.held(landscape, engine)
    }

    fn replayed(&self, steps: u64) -> Vec<(&'static str, Value)> {
        vec![("iterations", whole(steps)), ("mean_over", Value::Integer(1))]
    }

    fn written_steps(&self, _: &Landscape) -> u64 {
        u64::from(self.iterations)
    }

    fn recorded(&self, materials: &[Material]) -> Result<Option<(u64, Script)>, Error> {
        Ok(self.script(materials)?.map(|script| (u64::from(self.iterations), script)))
    }
}
