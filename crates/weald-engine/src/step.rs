//! What a step of a recipe is: it declares the layers that it reads and writes, and runs on a landscape.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::path::PathBuf;

use crate::budget::Budget;
use crate::job::Job;
use crate::local::{self, LocalWork, Reach};
use crate::stored::StoredLandscape;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Diagnostics, Fault, Parameter, Parameters};
use weald_core::source::Table;

/// A step with its parameters, checked and ready to run.
pub trait Step: Debug + Send + Sync {
    /// Names of the layers it reads.
    fn reads(&self) -> Vec<String>;

    /// Names of layers that it reads beside these where there are such. A kept result is taken for that of another run by
    /// the layers of both lists.
    fn reads_where_there(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names and units of the layers it writes.
    fn writes(&self) -> Vec<(String, &'static str)>;

    /// Names of the plants that it sets.
    fn plants(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the fractals that these plants are.
    fn fractals(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the grass that it grows.
    fn meadows(&self) -> Vec<String> {
        Vec::new()
    }

    /// What it does with the layers of the materials, whose names only a recipe knows.
    fn layered(&self) -> Layered {
        Layered::Never
    }

    /// Files that it reads.
    fn files(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// Looks at the files that it reads, so that their faults are reported before anything runs; with the materials and
    /// the grid that it will find.
    ///
    /// # Errors
    /// Those of the files.
    fn look_ahead(&self, materials: &[Material], domain: &Domain) -> Result<(), Error> {
        let _ = (materials, domain);
        Ok(())
    }

    /// The same of files of which a landscape on disk or over ranks reads some rows at a time.
    ///
    /// # Errors
    /// Those of the files, also where they would have to be read as a whole.
    fn look_ahead_by_rows(&self, domain: &Domain) -> Result<(), Error> {
        let _ = domain;
        Ok(())
    }

    /// Faults that concern several parameters at once.
    fn faults(&self) -> Vec<Fault> {
        Vec::new()
    }

    /// Faults that only show beside the materials of the recipe.
    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        let _ = materials;
        Vec::new()
    }

    /// Least and greatest value that a layer of [`Step::writes`] can hold, where the method bounds it. Every
    /// layer of an analysis has a range; an infinite end says that there is no bound on that side.
    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        let _ = layer;
        None
    }

    /// What it measures for the report: names, each with what it is.
    fn measures(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Iterations between which its landscape can be looked at, or the years of a step that tells them; 0 where it
    /// cannot.
    fn watched(&self) -> u64 {
        0
    }

    /// How much of [`Step::watched`] has passed after so many iterations, where the step alone tells.
    fn watched_after(&self, iterations: u64) -> Option<u64> {
        Some(iterations)
    }

    /// Columns and rows after the step, where it changes them.
    fn resized(&self) -> Option<(u32, u32)> {
        None
    }

    /// What stands against the step on such a grid: all that its keys and the grid tell before anything runs.
    ///
    /// # Errors
    /// Those that a run on such a grid would end with, whatever its layers hold.
    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        let _ = domain;
        Ok(())
    }

    /// The grid after the step, where it changes it and [`Step::check_on`] has nothing against it.
    fn domain_after(&self, domain: &Domain) -> Option<Domain> {
        let _ = domain;
        None
    }

    /// Bytes of memory for a cell that it takes at its peak, beside the layers that it finds and those that it writes: as
    /// measured, for the estimate that a run starts with.
    fn bytes_per_cell(&self) -> u64 {
        12
    }

    /// What it has to do on such a grid, for the estimate of its time.
    fn work(&self, domain: &Domain) -> Work {
        let _ = domain;
        Work::default()
    }

    /// Whether it is a simulation that runs over ranks: then all of them run the step on the same layers, and the first
    /// alone has the result. Other steps run on the first rank while the others wait.
    fn runs_over_ranks(&self) -> bool {
        false
    }

    /// How far it looks from each cell, where what it writes there depends on the cells so near and on nothing else, neither on
    /// the place nor on the whole, and where it says nothing of the whole: such a step runs on some rows at a time. One that
    /// knows or says something of the whole has a [`Step::run_on_disk`] of its own, which does so [by rows](local::run).
    fn reach(&self) -> Option<Reach> {
        None
    }

    /// Bytes for a cell that it takes on disk at its peak beside the layers that are there before and those of these names
    /// that it writes, where it can run on a landscape that does not fit into memory.
    ///
    /// # Errors
    /// Why it cannot.
    fn scratch_per_cell(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        let _ = wanted;
        self.reach().map(|_| 0).ok_or_else(|| "it works on the whole landscape in memory".to_owned())
    }

    /// Runs on a landscape on disk that has all the layers in [`Step::reads`], to the same bits, within its memory.
    ///
    /// # Errors
    /// As [`Step::run`]; [`Error::Limit`] where the memory is too small; [`Error::Run`] where [`Step::scratch_per_cell`] says
    /// that it cannot, or where the disk is full.
    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        if let Some(reach) = self.reach() {
            let work = LocalWork::of((self.reads(), self.writes()), (reach, self.bytes_per_cell()));
            let done = local::run(&work, landscape, job, &|part| self.run(part, job))?;
            // A rank without rows has done nothing, and reports what the first does.
            let iterations = done.unwrap_or_default().iterations;
            let told = landscape.ranks.tell(iterations.to_le_bytes().to_vec())?;
            let iterations = told.try_into().map_or(iterations, u64::from_le_bytes);
            return Ok(Outcome { iterations, ..Outcome::default() });
        }
        let why = self.scratch_per_cell(&BTreeSet::new()).err().unwrap_or_default();
        Err(Error::Run(format!("the step does not run on a landscape on disk: {why}")))
    }

    /// Runs on a landscape that has all the layers in [`Step::reads`].
    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error>;
}

/// What a step has to do: its time grows with the cells times the passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Which of its methods does it, where they take unlike times; empty where there is one.
    pub method: String,
    /// How often it works on every cell: iterations, directions.
    pub passes: f64,
}

impl Work {
    /// So many passes of the only method.
    pub fn of(passes: impl Into<f64>) -> Self {
        Self { method: String::new(), passes: passes.into() }
    }

    /// The same by that method.
    #[must_use]
    pub fn by(self, method: impl Into<String>) -> Self {
        Self { method: method.into(), ..self }
    }
}

impl Default for Work {
    /// One pass.
    fn default() -> Self {
        Self::of(1.0)
    }
}

/// What a step does with the layers of the materials: `bedrock`, and the thickness of each material on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layered {
    /// Nothing.
    #[default]
    Never,
    /// It reads them, where they exist, by [`strata::stack`](weald_core::strata::stack).
    Reads,
    /// It reads them and writes all of them, beside the layers in [`Step::writes`].
    Changes,
}

/// What a step has to report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Iterations, faults, octaves: what the step counts.
    pub iterations: u64,
    /// Where water and solid went, for simulations.
    pub budget: Option<Budget>,
    /// What was measured, by name.
    pub measures: BTreeMap<&'static str, f64>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Part of the pipeline that a step belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Takes a layer from a file.
    Load,
    /// Makes ground from nothing.
    Generate,
    /// Makes a layer from layers.
    Combine,
    /// Changes ground by water and gravity.
    Erode,
    /// Reads the land: makes layers and measures from layers.
    Analyse,
    /// Sets plants on the land.
    Grow,
}

impl Stage {
    /// All stages, in the order of `weald steps`.
    pub const ALL: [Self; 6] =
        [Self::Load, Self::Generate, Self::Combine, Self::Erode, Self::Analyse, Self::Grow];

    /// The stage's heading in `weald steps`.
    pub fn title(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Generate => "generate",
            Self::Combine => "combine",
            Self::Erode => "erode",
            Self::Analyse => "analyse",
            Self::Grow => "grow",
        }
    }
}

/// A step's declaration in the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Word after `do =`.
    pub name: &'static str,
    /// Part of the pipeline.
    pub stage: Stage,
    /// What it does, in one sentence.
    pub summary: &'static str,
    /// The publication, or "Weald" for what is common practice.
    pub source: &'static str,
    /// Declares the parameters.
    pub parameters: fn() -> Vec<Parameter>,
    /// Reads them from a recipe.
    pub read: fn(&Table, &mut Diagnostics) -> Box<dyn Step>,
}

impl Entry {
    /// The declaration of step type `T`.
    pub const fn of<T: Step + Parameters + 'static>(
        name: &'static str,
        stage: Stage,
        summary: &'static str,
        source: &'static str,
    ) -> Self {
        let read = |table: &Table, diagnostics: &mut Diagnostics| -> Box<dyn Step> {
            Box::new(T::read(table, diagnostics))
        };
        Self { name, stage, summary, source, parameters: T::parameters, read }
    }
}
