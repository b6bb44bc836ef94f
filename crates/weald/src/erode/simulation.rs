//! Runs a process for many steps: progress, interruption, checkpoints, the watch for NaN, mean fluxes.

use super::sums;
use crate::engine::world::World;
use crate::engine::{Job, SavedSimulation};
use crate::error::Error;
use crate::stencil::chain::{Process, RowSums};
use crate::stencil::rows::Rows;

/// Rain and evaporation of one step, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sky {
    pub(crate) rain: f32,
    pub(crate) evaporation: f32,
}

/// A process and how long it runs.
pub(crate) struct Simulation<'a, P: Process> {
    pub(crate) process: &'a P,
    /// Names of the state planes, for checkpoints and errors.
    pub(crate) plane_names: &'a [String],
    /// Steps to run.
    pub(crate) iterations: u64,
    /// Weather of each step.
    pub(crate) weather: &'a (dyn Fn(u64) -> P::Weather + Sync),
    /// Fluxes to average, and over which steps.
    pub(crate) record: Option<Record<'a>>,
}

/// A wish for mean values.
pub(crate) struct Record<'a> {
    /// Steps over which to average.
    pub(crate) steps: std::ops::Range<u64>,
    /// Parts of each mean.
    pub(crate) means: &'a [&'a [Part]],
}

/// A plane that counts into a mean.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) plane: usize,
    /// Factor that it counts with.
    pub(crate) factor: f32,
    /// Cells east and south of a cell where its value is taken from; beyond the edge it is 0.
    pub(crate) from: [usize; 2],
}

/// How a simulation ended.
pub(crate) struct Finished {
    pub(crate) state: Rows,
    pub(crate) sums: RowSums,
    /// One mean a wish, row-major.
    pub(crate) means: Vec<Vec<f32>>,
}

/// Between two looks for NaN, interruption and checkpoints: about this many cell-steps.
const CELL_STEPS_BETWEEN_LOOKS: usize = 100_000_000;

impl<P: Process> Simulation<'_, P> {
    /// Runs from `start`, or from where `job` resumes.
    pub(crate) fn run(&self, start: Rows, job: &Job<'_>) -> Result<Finished, Error> {
        let mut running = Running::new(self, start, job);
        if let Some(saved) = &job.resume {
            running.resume(saved)?;
        }
        running.watch_start()?;
        while running.done < self.iterations {
            running.stretch()?;
            job.watcher.progress(running.done, self.iterations, running.cells);
            running.heed()?;
        }
        Ok(running.finish())
    }
}

struct Running<'a, P: Process> {
    simulation: &'a Simulation<'a, P>,
    job: &'a Job<'a>,
    world: World<'a, P>,
    done: u64,
    cells: usize,
    means: Vec<Vec<f32>>,
    /// The state at the last look, when all was well.
    good: Good,
}

struct Good {
    done: u64,
    state: Rows,
    row_sums: Vec<f64>,
    means: Vec<Vec<f32>>,
}

impl<'a, P: Process> Running<'a, P> {
    fn new(simulation: &'a Simulation<'a, P>, start: Rows, job: &'a Job<'a>) -> Self {
        let cells = start.count() * start.layout.columns;
        let wishes = simulation.record.as_ref().map_or(0, |record| record.means.len());
        let means = vec![vec![0.0; cells]; wishes];
        let world = World::new(simulation.process, start.clone(), job.engine);
        let good = Good { done: 0, state: start, row_sums: world.row_sums(), means: means.clone() };
        Self { simulation, job, world, done: 0, cells, means, good }
    }

    /// One stretch of steps, and a look at the result.
    fn stretch(&mut self) -> Result<(), Error> {
        let between = (CELL_STEPS_BETWEEN_LOOKS / self.cells).clamp(self.world.block(), 256) as u64;
        let end = (self.done + between).min(self.simulation.iterations);
        self.advance_to(end);
        if self.first_not_finite().is_some() {
            return Err(self.find_the_fault(end));
        }
        self.good.done = self.done;
        self.world.copy_state(&mut self.good.state);
        self.good.row_sums = self.world.row_sums();
        self.good.means.clone_from(&self.means);
        Ok(())
    }

    fn advance_to(&mut self, end: u64) {
        while self.done < end {
            let record = self.simulation.record.as_ref().map_or(end..end, |record| record.steps.clone());
            let stop = if record.contains(&self.done) {
                self.done + 1
            } else if self.done < record.start {
                end.min(record.start)
            } else {
                end
            };
            let weather: Vec<_> = (self.done..stop).map(self.simulation.weather).collect();
            self.world.advance(&weather);
            if record.contains(&self.done) {
                self.add_to_means();
            }
            self.done = stop;
        }
    }

    fn add_to_means(&mut self) {
        let Some(record) = &self.simulation.record else { return };
        for (mean, parts) in self.means.iter_mut().zip(record.means) {
            for part in *parts {
                self.world.add_plane_to(part.plane, part.from, part.factor, mean);
            }
        }
    }

    fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
        self.world.first_not_finite(self.simulation.process.state_planes())
    }

    fn watch_start(&self) -> Result<(), Error> {
        let Some((x, y, plane)) = self.first_not_finite() else { return Ok(()) };
        let name = &self.simulation.plane_names[plane];
        Err(Error::Run(format!(
            "the simulation starts with a value of `{name}` at column {x}, row {y} that is no number"
        )))
    }

    /// Goes back to the last good state, steps one by one to the fault, and keeps the state before it.
    fn find_the_fault(&mut self, end: u64) -> Error {
        self.go_back();
        while self.done < end {
            let before = self.saved();
            self.advance_to(self.done + 1);
            let Some((x, y, plane)) = self.first_not_finite() else { continue };
            let name = &self.simulation.plane_names[plane];
            let kept = match self.job.watcher.checkpoint(&before) {
                Ok(()) => "the last good state was kept".to_owned(),
                Err(error) => format!("the last good state could not be kept: {error}"),
            };
            return Error::Run(format!(
                "step {}: `{name}` at column {x}, row {y} is no longer a finite number; {kept}; a lower \
                 `flow_rate` or `erosion`, or `limiter = true`, makes the scheme stable",
                self.done
            ));
        }
        Error::Run(format!("a value that is not finite appeared before step {end} and did not appear again"))
    }

    fn go_back(&mut self) {
        self.world.set_state(&self.good.state);
        self.world.set_row_sums(&self.good.row_sums);
        self.means.clone_from(&self.good.means);
        self.done = self.good.done;
    }

    /// Ends when the user wants it, and keeps a checkpoint then and when one is due.
    fn heed(&self) -> Result<(), Error> {
        let watcher = self.job.watcher;
        let stop = watcher.cancelled() && self.done < self.simulation.iterations;
        if stop || watcher.checkpoint_due() {
            watcher.checkpoint(&self.saved())?;
        }
        if stop {
            let all = self.simulation.iterations;
            return Err(Error::Interrupted(format!("interrupted after {} of {all} steps", self.done)));
        }
        Ok(())
    }

    fn saved(&self) -> SavedSimulation {
        let state = self.world.state();
        let names = self.simulation.plane_names.iter().enumerate();
        let mut planes: Vec<_> = names.map(|(plane, name)| (name.clone(), state.gather(plane))).collect();
        planes.extend(self.means.iter().enumerate().map(|(at, mean)| (format!("mean_{at}"), mean.clone())));
        let sums = vec![("rows".to_owned(), self.world.row_sums())];
        SavedSimulation { iteration: self.done, planes, sums }
    }

    fn resume(&mut self, saved: &SavedSimulation) -> Result<(), Error> {
        let plane = |name: &str| {
            let found = saved.planes.iter().find(|(known, _)| known == name);
            let values = found.map(|(_, values)| values).filter(|values| values.len() == self.cells);
            values.ok_or_else(|| {
                Error::Run(format!("the checkpoint has no plane `{name}` of {} cells", self.cells))
            })
        };
        let mut state = self.world.state();
        for (at, name) in self.simulation.plane_names.iter().enumerate() {
            state.scatter(at, plane(name)?);
        }
        let means: Result<Vec<_>, _> =
            (0..self.means.len()).map(|at| plane(&format!("mean_{at}")).cloned()).collect();
        self.means = means?;
        let row_sums = saved.sums.iter().find(|(name, _)| name == "rows").map(|(_, sums)| sums);
        let expected = self.world.row_sums().len();
        let row_sums = row_sums
            .filter(|sums| sums.len() == expected)
            .ok_or_else(|| Error::Run(format!("the checkpoint has no sums of {expected} numbers")))?;
        self.world.set_state(&state);
        self.world.set_row_sums(row_sums);
        self.done = saved.iteration;
        self.good = Good { done: self.done, state, row_sums: row_sums.clone(), means: self.means.clone() };
        Ok(())
    }

    fn finish(self) -> Finished {
        let steps = self.simulation.record.as_ref().map_or(1, |record| record.steps.end - record.steps.start);
        let scale = 1.0 / steps.max(1) as f32;
        let means =
            self.means.into_iter().map(|mean| mean.into_iter().map(|sum| sum * scale).collect()).collect();
        Finished { state: self.world.state(), sums: self.world.sums(), means }
    }
}

/// The sums of a run as water in and out and solid out, in cells³.
pub(crate) struct Flows {
    pub(crate) rained: f64,
    pub(crate) water_out: f64,
    pub(crate) solid_out: f64,
}

impl From<RowSums> for Flows {
    fn from(row: RowSums) -> Self {
        Self {
            rained: row[sums::RAINED],
            water_out: row[sums::WATER_OUT] - row[sums::EVAPORATED],
            solid_out: row[sums::SEDIMENT_OUT] + row[sums::SHRUNK],
        }
    }
}
