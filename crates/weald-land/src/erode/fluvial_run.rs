//! A flood with the keys of a recipe filled in: its grids, and the levels one after the other.

use super::coarse_landscape::Seen;
use super::extent::Extent;
use super::finished::Finished;
use super::fluvial::{self, Numbers};
use super::fluvial_levels::{self as levels, HandedDown};
use super::fluvial_materials::{StartColumn, strata_of};
use super::fluvial_numbers::Steps;
use super::fluvial_step::Fluvial;
use super::fluvial_years::{InYears, Years, as_seen};
use super::hydraulic::Boundary;
use super::over_ranks::Beginning;
use super::pipeline::Stepped;
use super::scripted::{Edits, Numbers as Running};
use super::simulation::{Record, Simulation};
use super::springs::Forcing;
use super::stored::MeanFluxes;
use super::water_planes as plane;
use super::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{LayerName, Nested};
use weald_engine::stencil::rows::Rows;
use weald_engine::step::Outcome;
use weald_engine::{Budget, Job};

/// Steps of the end over which fluxes are averaged: one in so many.
const RECORDED: u64 = 10;

/// The first of the planes of fluxes.
const FLUXES: usize = 3;

/// Plane of the rock's top, where the ground is of several materials.
const ROCK: usize = fluvial::PLANES;

impl Fluvial {
    /// The same for the time that passes on a level.
    pub(super) fn for_level(&self, level: u32, grids: u32) -> Self {
        let share = levels::Shares::FLOOD.of(level, grids);
        let (duration, flow_time) = (self.duration * share, self.flow_time * share);
        // Those that are said are of the finest grid.
        let steps = self.steps.filter(|_| level == 0);
        Self { duration, flow_time, steps, ..self.clone() }
    }

    /// Runs on all levels, and leaves in the landscape what has become of it; over ranks in that of the first, which
    /// alone has what a level hands down.
    pub(super) fn run_levels(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let (mut before, mut handed) = (Vec::new(), None);
        let grids = self.grids(landscape.domain.cell);
        let given = landscape.clone();
        let mut years = 0.0;
        let seen = Seen { landscape: &given, ground: &self.layer, materials: self.materials };
        for level in (1..grids).rev() {
            let maps = self.initial_water.iter().chain(self.maps().into_iter().flatten());
            let coarse = seen.on_level(level, maps)?;
            let mut flood = Flood::on(self.for_level(level, grids), &coarse, false)?;
            let finer = |coarse: &Landscape| as_seen(&given, coarse, (&self.layer.0, level));
            let watcher = InYears { watcher: job.watcher, years: flood.years(years), coarse: Some(&finer) };
            let finished = flood.run(handed.as_ref(), &watcher.job(job), None)?;
            years += flood.step.duration;
            let Some(finished) = finished else { continue };
            let (budget, down) = flood.handed_down(&finished);
            before.push(budget);
            handed = Some(down.refined());
        }
        let mut flood = Flood::on(self.for_level(0, grids), &given, self.edits.is_some())?;
        let watcher = InYears { watcher: job.watcher, years: flood.years(years), coarse: None };
        let script = self.script(&given.materials)?;
        let edits = script.map(|script| self.edits_of(script, &flood));
        let Some(finished) = flood.run(handed.as_ref(), &watcher.job(job), edits.as_ref())? else {
            return Ok(Outcome::default());
        };
        let budget = before.iter().fold(flood.store(landscape, &finished), levels::joined);
        let iterations = flood.step.count(given.domain.cell);
        Ok(Outcome { iterations, budget: Some(budget), notes: finished.notes, ..Outcome::default() })
    }
}

/// A flood over a landscape.
pub(super) struct Flood {
    pub(super) step: Fluvial,
    pub(super) landscape: Landscape,
    pub(super) working: WorkingGrid,
    pub(super) column: Option<StartColumn>,
    pub(super) numbers: Numbers,
}

impl Flood {
    /// A flood over a landscape, such that strokes can change it where it is `editable`.
    pub(super) fn on(step: Fluvial, landscape: &Landscape, editable: bool) -> Result<Self, Error> {
        let open = step.boundary == Boundary::Open;
        let region = step.region.as_ref().map(|region| region.0.as_str());
        let extent = Extent { open, region, cropped: !editable };
        let mut working = WorkingGrid::within(landscape, &step.layer.0, &extent)?;
        if let Some(water) = &step.initial_water {
            working.set_water(landscape, &water.0)?;
        }
        let column = step.materials.then(|| StartColumn::of(landscape, &working.start)).transpose()?;
        let strata = column.as_ref().and_then(|_| {
            let half = (step.cover / landscape.domain.cell) as f32;
            strata_of(&landscape.materials, half)
        });
        if editable {
            working.set_changing_mask();
        }
        let numbers = step.numbers(working.cell, strata);
        Ok(Self { step, landscape: landscape.clone(), working, column, numbers })
    }

    pub(super) fn steps(&self) -> Steps {
        self.step.steps(self.working.cell)
    }

    /// The years that pass, after those of coarser levels.
    fn years(&self, before: f64) -> Years {
        Years { before, a_step: self.step.duration / self.steps().count as f64 }
    }

    /// What a rate in mm/h gives in a step, in cells.
    fn in_a_step(&self, rate: f64) -> f32 {
        (rate / 3.6e6 * self.steps().seconds / self.working.cell) as f32
    }

    /// Constant planes behind those of every process.
    fn constants(&self) -> Result<Vec<Vec<f32>>, Error> {
        let mut planes = Vec::new();
        if self.numbers.rain_map {
            planes.push(self.inflow()?);
        }
        if let Some(LayerName(name)) = &self.step.erodibility_map {
            let map = self.landscape.field(name)?;
            planes.push(self.working.ringed(|x, y| map.at(x, y).max(0.0)));
        }
        if let Some(column) = &self.column {
            planes.extend(column.bottoms().iter().map(|bottom| self.working.lengths(bottom)));
        }
        Ok(planes)
    }

    /// Rain by its map, and what springs, in cells per step.
    fn inflow(&self) -> Result<Vec<f32>, Error> {
        let domain = &self.landscape.domain;
        let map =
            self.step.rain_map.as_ref().map(|LayerName(name)| self.landscape.field(name)).transpose()?;
        let mut springs = Field::filled(domain.size, 0.0);
        for Nested(source) in &self.step.sources {
            source.spring(domain).add_to(&mut springs, domain, self.steps().seconds / self.working.cell);
        }
        let rain = self.in_a_step(self.step.rain);
        let share = |x, y| map.map_or(1.0, |map| map.at(x, y).max(0.0));
        Ok(self.working.ringed(|x, y| rain * share(x, y) + springs.at(x, y)))
    }

    /// The state before the first step, with what a coarser level hands down.
    pub(super) fn start(&mut self, handed: Option<&HandedDown>) -> Result<Rows, Error> {
        if let Some(HandedDown { water, .. }) = handed {
            self.working.set_standing(water.clone());
        }
        let mut rows = self.working.water_state(self.numbers.planes(), &self.constants()?);
        let working = &self.working;
        let cell = working.cell as f32;
        let plane_of = |field: &Field| working.ringed(|x, y| field.at(x, y) / cell);
        if let Some(HandedDown { change, sediment, discharge, .. }) = handed {
            let worn = levels::worn_by_deposits(&working.start, change);
            let change = Field::from_function(change.size(), |x, y| change.at(x, y) + worn.at(x, y));
            rows.scatter(plane::CHANGE, &plane_of(&change));
            rows.scatter(plane::SEDIMENT, &working.lengths(sediment));
            let factor = (self.steps().seconds / (working.cell * working.cell)) as f32;
            let discharge = discharge.each_ref().map(|along| working.ringed(|x, y| along.at(x, y) * factor));
            let fluxes = fluvial::fluxes_of(discharge.each_ref().map(Vec::as_slice), working.size.columns);
            fluxes.iter().zip(FLUXES..).for_each(|(flux, plane)| rows.scatter(plane, flux));
        }
        if let Some(column) = &self.column {
            let mut rock = column.rock(&working.start);
            if let Some(worn) = handed.and_then(|handed| handed.worn.as_ref()) {
                rock = Field::from_function(rock.size(), |x, y| rock.at(x, y) + worn.at(x, y));
            }
            rows.scatter(ROCK, &plane_of(&rock));
        }
        Ok(rows)
    }

    /// The process, and what comes and goes in each step.
    pub(super) fn running(&self) -> Running<Stepped<Forcing>> {
        let pipeline = self.numbers.pipeline();
        let masked = self.working.mask.is_some();
        let program = fluvial::program(&self.numbers, masked, pipeline.reach());
        let process = Stepped::with_program(&pipeline, (self.working.size, masked), program);
        // Where a plane says what comes to each cell, it counts once.
        let rain = if self.numbers.rain_map { 1.0 } else { self.in_a_step(self.step.rain) };
        let evaporation = self.in_a_step(self.step.evaporation);
        Running::new(process, move |_| Forcing { rain, evaporation })
    }

    /// Runs all steps.
    fn run(
        &mut self,
        handed: Option<&HandedDown>,
        job: &Job<'_>,
        edits: Option<&Edits<Stepped<Forcing>>>,
    ) -> Result<Option<Finished>, Error> {
        let beginning = Beginning::of(&job.engine, || self.start(handed))?;
        let numbers = self.running();
        let count = self.step.count(self.working.cell);
        let recorded = self.step.mean_over.map_or_else(|| count.div_ceil(RECORDED), u64::from).min(count);
        let seen = |finished: &Finished| {
            let mut seen = self.landscape.clone();
            self.store(&mut seen, finished);
            Ok(seen)
        };
        let simulation = Simulation {
            numbers: &numbers,
            plane_names: &numbers.process.state_names(),
            iterations: count,
            record: Some(Record { steps: count - recorded..count, means: fluvial::MEAN_FLUXES }),
            edits,
            seen: Some(&seen),
        };
        self.working.show(&job.engine)?;
        simulation.run(beginning, job)
    }

    /// Writes what has become of the landscape.
    pub(super) fn store(&self, landscape: &mut Landscape, finished: &Finished) -> Budget {
        let working = &self.working;
        let planes = fluvial::through_sides(&finished.means, working.size.columns);
        let factor = (working.cell.powi(3) / self.steps().seconds) as f32;
        let fluxes = MeanFluxes { planes, unit: "m³/s", factor };
        let budget = working.store_with(landscape, &self.step.layer.0, finished, &fluxes);
        if let Some(column) = &self.column {
            let [change, rock] = [plane::CHANGE, ROCK].map(|at| self.metres(finished, at));
            column.store(landscape, &working.start, [&change, &rock]);
        }
        budget
    }

    /// Mean discharge to the east and south, in m²/s.
    fn discharge(&self, finished: &Finished) -> [Field; 2] {
        let columns = self.working.size.columns;
        let [east, south] = fluvial::through_sides(&finished.means, columns);
        let middle = |sides: Vec<f32>, back: usize| -> Vec<f32> {
            let before = |cell: usize| cell.checked_sub(back).map_or(0.0, |before| sides[before]);
            (0..sides.len()).map(|cell| 0.5 * (sides[cell] + before(cell))).collect()
        };
        let factor = (self.working.cell * self.working.cell / self.steps().seconds) as f32;
        [middle(east, 1), middle(south, columns)]
            .map(|plane| self.working.field(&plane, |flux| flux * factor))
    }

    fn metres(&self, finished: &Finished, plane: usize) -> Field {
        let cell = self.working.cell as f32;
        self.working.field(&finished.state.gather(plane), |value| value * cell)
    }

    /// What a finer level begins with, and the budget until there.
    fn handed_down(&self, finished: &Finished) -> (Budget, HandedDown) {
        let [change, water, sediment] =
            [plane::CHANGE, plane::DEPTH, plane::SEDIMENT].map(|at| self.metres(finished, at));
        let worn = self.column.as_ref().map(|column| {
            let (start, rock) = (column.rock(&self.working.start), self.metres(finished, ROCK));
            Field::from_function(rock.size(), |x, y| rock.at(x, y).min(change.at(x, y)) - start.at(x, y))
        });
        let discharge = self.discharge(finished);
        let [depth, load] = [plane::DEPTH, plane::SEDIMENT].map(|at| finished.state.gather(at));
        let budget = self.working.budget(&depth, &load, finished);
        (budget, HandedDown { change, water, sediment, discharge, worn })
    }
}
