//! A range with the keys of a recipe filled in: its grids, and the levels one after the other.

use rayon::prelude::*;

use super::bare_material::BareMaterial;
use super::coarse_landscape::Seen;
use super::fluvial_levels::{self as levels, refined};
use super::fluvial_materials::StartColumn;
use super::fluvial_years::{InYears, Years};
use super::stream_power::{Conditions, Evolution, Mesh};
use super::stream_power_step::{Grids, Lakes, Outlets, StreamPower};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_engine::step::Outcome;
use weald_engine::{Budget, Job, SavedSimulation, SolidBudget, Watcher};

/// Metres in a millimetre.
const MILLIMETRE: f64 = 0.001;

/// Names of what a checkpoint holds.
const HEIGHTS: &str = "heights";
const VOLUMES: &str = "volumes";

impl StreamPower {
    /// Runs on all levels, and leaves in the landscape what has become of it.
    pub(super) fn run_levels(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let grids = self.grids(landscape.domain.cell);
        let given = landscape.clone();
        let seen = Seen { landscape: &given, ground: &self.layer, materials: self.materials };
        let mut reached = Reached::default();
        // Checkpoints are of the finest grid, which begins with all that coarser ones have come to.
        let coarser = if job.resume.is_some() { 1..1 } else { 1..grids.count };
        for level in coarser.rev() {
            let coarse = seen.on_level(level, self.maps())?;
            let finer = |seen: &Landscape| as_seen(&given, seen, (&self.layer.0, level));
            let years = years(self, level, grids);
            let watcher = InYears { watcher: job.watcher, years, coarse: Some(&finer) };
            Level::on(self, &coarse, (level, grids))?.run(&mut reached, &watcher.job(job))?;
            reached.refine();
        }
        let watcher = InYears { watcher: job.watcher, years: years(self, 0, grids), coarse: None };
        let level = Level::on(self, &given, (0, grids))?;
        let evolution = level.run(&mut reached, &watcher.job(job))?;
        let notes = if evolution.has_outlet() { Vec::new() } else { vec![level.no_outlet()] };
        level.store(landscape, evolution, self.duration)?;
        let budget = level.budget(&reached);
        let iterations = self.steps(0, grids);
        Ok(Outcome { iterations, budget: Some(budget), notes, ..Outcome::default() })
    }
}

/// What the levels have come to.
#[derive(Default)]
struct Reached {
    /// Change of the ground in metres.
    change: Option<Field>,
    /// Volumes in m³ that uplift has brought, and that left over the border.
    uplifted: f64,
    outgoing: f64,
}

impl Reached {
    /// The same on cells half as long.
    fn refine(&mut self) {
        self.change = self.change.as_ref().map(refined);
    }
}

fn years(step: &StreamPower, level: u32, grids: Grids) -> Years {
    let before = (level + 1..grids.count).map(|level| grids.share(level)).sum::<f64>() * step.duration;
    let steps = step.steps(level, grids).max(1);
    Years { before, a_step: step.duration * grids.share(level) / steps as f64 }
}

/// The landscape of the start as it looks when a coarser one has become `coarse`.
fn as_seen(start: &Landscape, coarse: &Landscape, (layer, times): (&str, u32)) -> Result<Landscape, Error> {
    let fine = |field: &Field| (0..times).fold(field.clone(), |field, _| refined(&field));
    let mut seen = start.clone();
    for (name, found) in coarse.layers() {
        seen.insert(name, &found.unit, fine(&found.field));
    }
    let height = fine(coarse.field(layer)?);
    seen.insert(layer, "m", height);
    Ok(seen)
}

/// One grid and the time that passes on it.
struct Level<'a> {
    step: &'a StreamPower,
    landscape: &'a Landscape,
    /// Years of a step of time, before this level, and how many steps.
    years: Years,
    steps: u64,
    /// Ground of the start in metres.
    start: &'a Field,
    /// Uplift in m/a.
    uplift: Field,
    column: Option<BareMaterial>,
    /// What makes the seed of this level another one.
    number: u64,
}

impl<'a> Level<'a> {
    fn on(
        step: &'a StreamPower,
        landscape: &'a Landscape,
        (level, grids): (u32, Grids),
    ) -> Result<Self, Error> {
        let start = landscape.field(&step.layer.0)?;
        let rate = step.uplift * MILLIMETRE;
        let uplift = match &step.uplift_map {
            Some(LayerName(map)) => {
                let map = landscape.field(map)?;
                Field::from_function(map.size(), |x, y| (rate * f64::from(map.at(x, y))) as f32)
            }
            None => Field::filled(start.size(), rate as f32),
        };
        let column = step.materials.then(|| BareMaterial::of(landscape, start)).transpose()?;
        let (years, steps) = (years(step, level, grids), step.steps(level, grids));
        Ok(Self { step, landscape, years, steps, start, uplift, column, number: grids.seed(level) })
    }

    /// Lets all the time pass, from what coarser levels have reached.
    fn run(&self, reached: &mut Reached, job: &Job<'_>) -> Result<Evolution, Error> {
        let area = self.landscape.domain.cell_area();
        let heights = self.heights_after(reached.change.as_ref());
        let seed = job.seed ^ weald_core::random::splitmix64(self.number);
        let mesh = Mesh::new(&self.landscape.domain, self.step.irregularity, seed);
        let leave = |x, y| self.is_outlet(&heights, x, y);
        let mut evolution = Evolution::new(&self.landscape.domain, &heights, mesh, leave);
        let mut done = self.resume(&mut evolution, reached, job)?;
        let mut conditions = self.conditions()?;
        self.look(&evolution, done, job.watcher)?;
        while done < self.steps {
            self.stop_or_checkpoint(&evolution, reached, (done, job.watcher))?;
            if let Some(column) = &self.column {
                self.lay_bare((column, &evolution, done), &mut conditions)?;
            }
            let volumes = evolution.step(&conditions);
            reached.uplifted += volumes.uplifted * area;
            reached.outgoing += volumes.outgoing * area;
            done += 1;
            job.watcher.progress(done, self.steps, self.start.size().cells());
            self.look(&evolution, done, job.watcher)?;
        }
        let change = self.start.values().iter().zip(evolution.heights());
        let change = change.map(
            |(&start, height)| if height.is_finite() { (height - f64::from(start)) as f32 } else { 0.0 },
        );
        reached.change = Some(Field::from_values(self.start.size(), change.collect()));
        Ok(evolution)
    }

    /// Whether rivers may leave over a cell of the border.
    fn is_outlet(&self, heights: &[f64], x: usize, y: usize) -> bool {
        let domain = &self.landscape.domain;
        match self.step.outlets {
            Outlets::Border => true,
            Outlets::Sea => domain.sea_level.is_some_and(|level| heights[domain.size.index(x, y)] <= level),
            Outlets::North => y == 0,
            Outlets::East => x + 1 == domain.size.columns,
            Outlets::South => y + 1 == domain.size.rows,
            Outlets::West => x == 0,
        }
    }

    fn no_outlet(&self) -> String {
        let place = match (self.step.outlets, self.landscape.domain.sea_level) {
            (Outlets::Sea, Some(level)) => format!("no ground at the border is below the sea, at {level} m"),
            (side, _) => format!("no cell of the {} border holds data", side.word()),
        };
        format!(
            "{place}: no river leaves, and all of them end in hollows; `outlets` says where they may leave"
        )
    }

    /// Heights of the start with the change that a coarser level hands down.
    fn heights_after(&self, change: Option<&Field>) -> Vec<f64> {
        let start = self.start.values().iter().map(|&start| f64::from(start));
        let Some(change) = change else { return start.collect() };
        let worn = levels::worn_by_change(self.start, change);
        let changes = change.values().iter().zip(worn.values());
        start
            .zip(changes)
            .map(|(start, (&change, &worn))| start + f64::from(change) + f64::from(worn))
            .collect()
    }

    fn conditions(&self) -> Result<Conditions, Error> {
        let step = self.step;
        let years = self.years.a_step;
        let uplift = self.uplift.values().iter().map(|&rate| (f64::from(rate) * years) as f32).collect();
        Ok(Conditions {
            uplift: Field::from_values(self.uplift.size(), uplift),
            erodibility: self.erodibility()?,
            area_exponent: step.area_exponent,
            hillslope_area: step.hillslope_area,
            slope_exponent: step.slope_exponent,
            deposition: step.deposition,
            creep: step.creep * years,
            critical: libm::tan(step.critical_slope_deg.to_radians()),
            taluses: None,
            sea_level: self.landscape.domain.sea_level,
            lakes_fill: step.lakes == Lakes::Silted,
            settling: step.settling_length,
        })
    }

    /// K dt of each cell, were it all of bedrock.
    fn erodibility(&self) -> Result<Field, Error> {
        let rate = (self.step.erodibility * self.years.a_step) as f32;
        let map = self.step.erodibility_map.as_ref();
        let map = map.map(|LayerName(name)| self.landscape.field(name)).transpose()?;
        let mut field = Field::filled(self.start.size(), rate);
        if let Some(map) = map {
            field.values_mut().iter_mut().zip(map.values()).for_each(|(rate, &map)| *rate *= map.max(0.0));
        }
        Ok(field)
    }

    /// Conditions by the material that lies bare in each cell after so many steps.
    fn lay_bare(
        &self,
        (column, evolution, done): (&BareMaterial, &Evolution, u64),
        conditions: &mut Conditions,
    ) -> Result<(), Error> {
        let worn = self.worn(&evolution.heights(), self.years.before + done as f64 * self.years.a_step);
        let mut erodibility = self.erodibility()?;
        let mut taluses = Field::filled(self.start.size(), 0.0);
        let cells = erodibility.values_mut().par_iter_mut().zip(taluses.values_mut()).zip(&worn);
        cells.enumerate().for_each(|(cell, ((rate, talus), &worn))| {
            let bare = column.at(cell, worn);
            *rate *= bare.softness;
            *talus = bare.talus;
        });
        conditions.erodibility = erodibility;
        conditions.taluses = Some(taluses);
        Ok(())
    }

    /// Metres that the ground has lost of what it was and rose to in so many years; below 0 what it has gained.
    fn worn(&self, heights: &[f64], years: f64) -> Vec<f32> {
        let ground = self.start.values().iter().zip(self.uplift.values()).zip(heights);
        let worn = |((&start, &uplift), &height): ((&f32, &f32), &f64)| {
            let worn = f64::from(start) + f64::from(uplift) * years - height;
            if worn.is_finite() { worn as f32 } else { 0.0 }
        };
        ground.map(worn).collect()
    }

    fn resume(&self, evolution: &mut Evolution, reached: &mut Reached, job: &Job<'_>) -> Result<u64, Error> {
        let Some(saved) = &job.resume else { return Ok(0) };
        let found = |name: &str, length: usize| {
            let sums = saved.sums.iter().find(|(known, _)| known == name).map(|(_, sums)| sums);
            sums.filter(|sums| sums.len() == length)
                .ok_or_else(|| Error::Run(format!("the checkpoint has no `{name}` of {length} numbers")))
        };
        evolution.resume(found(HEIGHTS, self.start.size().cells())?);
        let volumes = found(VOLUMES, 2)?;
        (reached.uplifted, reached.outgoing) = (volumes[0], volumes[1]);
        Ok(saved.iteration)
    }

    fn stop_or_checkpoint(
        &self,
        evolution: &Evolution,
        reached: &Reached,
        (done, watcher): (u64, &dyn Watcher),
    ) -> Result<(), Error> {
        let stop = watcher.cancelled();
        if stop || watcher.checkpoint_due() {
            let volumes = vec![reached.uplifted, reached.outgoing];
            let sums = vec![(HEIGHTS.to_owned(), evolution.heights()), (VOLUMES.to_owned(), volumes)];
            watcher.checkpoint(&SavedSimulation { iteration: done, planes: Vec::new(), sums })?;
        }
        if stop {
            return Err(Error::Interrupted(format!("interrupted after {done} of {} steps", self.steps)));
        }
        Ok(())
    }

    fn look(&self, evolution: &Evolution, done: u64, watcher: &dyn Watcher) -> Result<(), Error> {
        if watcher.next_look(done) != Some(done) {
            return Ok(());
        }
        let mut seen = self.landscape.clone();
        let years = self.years.before + done as f64 * self.years.a_step;
        self.store_ground(&mut seen, &evolution.heights(), years)?;
        watcher.look(done, &seen)
    }

    /// Writes what has become of the landscape.
    fn store(&self, landscape: &mut Landscape, mut evolution: Evolution, years: f64) -> Result<(), Error> {
        self.store_ground(landscape, &evolution.heights(), years)?;
        let depths = evolution.lake_depths(self.landscape.domain.sea_level);
        let depths = depths.into_iter().map(|depth| depth as f32).collect();
        landscape.insert("lake_depth", "m", Field::from_values(self.start.size(), depths));
        Ok(())
    }

    fn store_ground(&self, landscape: &mut Landscape, heights: &[f64], years: f64) -> Result<(), Error> {
        let size = self.start.size();
        let worn = self.worn(heights, years);
        let field = |value: &dyn Fn(f32) -> f32| {
            Field::from_values(size, worn.iter().map(|&worn| value(worn)).collect())
        };
        let ground = self.start.values().iter().zip(heights);
        let ground =
            ground.map(|(&start, &height)| if height.is_finite() { height as f32 } else { start }).collect();
        let ground = Field::from_values(size, ground);
        if self.step.materials {
            let column = StartColumn::of(landscape, self.start)?;
            // The column rises whole: what is worn counts from its top, and what lies above it has settled there.
            let (change, rock) = (field(&|worn| -worn), field(&|worn| -worn.max(0.0)));
            let last = column.rock(self.start);
            let rock = Field::from_function(size, |x, y| rock.at(x, y).min(last.at(x, y)));
            let risen = Field::from_function(size, |x, y| ground.at(x, y) - change.at(x, y));
            column.store(landscape, &risen, [&change, &rock]);
        }
        landscape.insert("erosion", "m", field(&|worn| worn.max(0.0)));
        landscape.insert("deposition", "m", field(&|worn| (-worn).max(0.0)));
        landscape.insert(&self.step.layer.0, "m", ground);
        Ok(())
    }

    /// Where all solid went, from the lowest ground of the start.
    fn budget(&self, reached: &Reached) -> Budget {
        let domain = &self.landscape.domain;
        let valid = domain.valid.as_ref();
        let area = domain.cell_area();
        let (lowest, _) = self.start.range(valid).unwrap_or_default();
        let mut solid =
            SolidBudget { uplifted: reached.uplifted, outgoing: reached.outgoing, ..SolidBudget::default() };
        let change = reached.change.iter().flat_map(Field::values);
        for (cell, (&start, &change)) in self.start.values().iter().zip(change).enumerate() {
            if valid.is_none_or(|valid| valid.is_valid_at(cell)) {
                let start = f64::from(start) - f64::from(lowest);
                solid.start += start * area;
                solid.ground += (start + f64::from(change)) * area;
                solid.moved += f64::from(change).abs() * area;
            }
        }
        solid.moved += reached.outgoing.abs();
        Budget { solid, ..Budget::default() }
    }
}
