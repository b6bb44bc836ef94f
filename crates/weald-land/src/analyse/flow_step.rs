//! The step `flow`.

mod on_disk;

use std::collections::BTreeSet;

use super::stages::Stages;
use crate::analyse::{ensure_finite, scaled};
use crate::flow::{
    Depressions, DirectionRule, MultipleFlow, Routed, Routing, STAGES, accumulate, accumulate_multiple,
    route_watched,
};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::stored::StoredLandscape;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<FlowStep>(
    "flow",
    Stage::Analyse,
    "leads water over the ground: directions of flow and upslope (drainage) areas",
    "O'Callaghan and Mark 1984; Orlandini et al. 2003; Freeman 1991; Barnes et al. 2014; Lindsay 2016",
);

/// Seconds of a year of 365.25 days, and millimetres of a metre: mm/year × m² in m³/s.
pub(in crate::analyse) const MILLIMETRES_PER_YEAR: f64 = 1.0e-3 / 31_557_600.0;

choices! {
    /// How upslope areas add up.
    pub enum Method {
        /// Each cell gives all to the neighbour that it drains to.
        D8 = "d8",
        /// Each cell shares among all lower neighbours.
        Multiple = "mfd",
    }
}

parameters! {
    /// Flow over the ground.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::flow_step::FlowStep;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// let southward = |_, y| 100.0 - y as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, southward));
    /// FlowStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("flow_direction")?.at(4, 2), 3.0, "3 is south");
    /// assert_eq!(landscape.field("accumulation")?.at(4, 5), 600.0, "six cells of 100 m² drain through the last");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct FlowStep {
        /// Layer of heights.
        of: LayerName = LayerName::of("height");
        /// Which neighbour a cell drains to: the steepest, by which paths favour multiples of 45°, or the one that keeps the
        /// whole path nearest to the fall line.
        directions: DirectionRule = DirectionRule::LeastDeviation;
        /// How upslope areas add up: along the directions, or shared among all lower neighbours.
        method: Method = Method::D8;
        /// Shares are in proportion to slope to this power. 1.1 spreads water over a cone evenly, 4 and
        /// more come near `d8`.
        exponent: f64 = 1.1, range 0.0..=20.0, when method = "mfd";
        /// What becomes of depressions: they fill to their lowest rims, or a channel drains them.
        depressions: Depressions = Depressions::Fill;
        /// Deepest cut of a breach; depressions that need a deeper one are filled. Without it, all are breached.
        deepest_breach: Option<f64> = None, range 0.0..=1.0e6, unit "m", when depressions = "breach";
        /// Height of the sea. Ground no higher that is connected to the border by such ground is sea, in which
        /// flow ends. Default: that of the landscape.
        sea_level: Option<f64> = None, range -1.0e6..=1.0e6, unit "m";
        /// Layer of the runoff of each cell in mm/year, whatever unit it says. With it, the layer `discharge` is
        /// written.
        weight: Option<LayerName> = None;
        /// Layer for the heights of the ground after filling or breaching. Without it they are not kept.
        filled: Option<LayerName> = None;
    }
}

impl Step for FlowStep {
    fn reads(&self) -> Vec<String> {
        [Some(&self.of), self.weight.as_ref()].into_iter().flatten().map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let mut writes = vec![("flow_direction".to_owned(), "1"), ("accumulation".to_owned(), "m²")];
        writes.extend(self.weight.as_ref().map(|_| ("discharge".to_owned(), "m³/s")));
        writes.extend(self.filled.as_ref().map(|name| (name.0.clone(), "m")));
        writes
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        match layer {
            "flow_direction" => Some((0.0, 9.0)),
            "accumulation" => Some((0.0, f64::INFINITY)),
            _ => Some((f64::NEG_INFINITY, f64::INFINITY)),
        }
    }

    fn bytes_per_cell(&self) -> u64 {
        28
    }

    fn scratch_per_cell(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        self.scratch(wanted)
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        self.run_by_tiles(landscape, job)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let (area, size) = (domain.cell_area(), domain.size);
        ensure_finite(landscape, &self.of.0)?;
        let mut stages = Stages::of(job, STAGES + 1 + u64::from(self.weight.is_some()), size.cells());
        let ground = landscape.field(&self.of.0)?;
        let routed =
            route_watched(ground, domain.valid.as_ref(), &self.routing(domain), &mut || stages.passed())?;
        let areas = match (&routed.upslope_cells, self.method) {
            (Some(cells), Method::D8) => scaled(size, cells, area),
            _ => scaled(size, &self.sums(landscape, &routed, None), area),
        };
        stages.passed()?;
        let weight = self.weight.as_ref().map(|name| landscape.field(&name.0)).transpose()?;
        let discharge = weight.map(|runoff| {
            scaled(size, &self.sums(landscape, &routed, Some(runoff)), area * MILLIMETRES_PER_YEAR)
        });
        if discharge.is_some() {
            stages.passed()?;
        }
        let is_valid = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let is_all_sea = (0..size.cells()).all(|cell| !is_valid(cell) || routed.directions.is_sea(cell));
        let note = self.sea_level(domain).filter(|_| is_all_sea);
        landscape.insert("flow_direction", "1", routed.directions.layer());
        landscape.insert("accumulation", "m²", areas);
        if let Some(discharge) = discharge {
            landscape.insert("discharge", "m³/s", discharge);
        }
        if let Some(name) = &self.filled {
            landscape.insert(&name.0, "m", routed.surface);
        }
        Ok(Outcome { iterations: 1, notes: note.map(all_sea).into_iter().collect(), ..Outcome::default() })
    }
}

fn all_sea(level: f64) -> String {
    format!("all ground is sea: none is above `sea_level`, which is {level} m")
}

impl FlowStep {
    fn sea_level(&self, domain: &Domain) -> Option<f64> {
        self.sea_level.or(domain.sea_level)
    }

    fn routing(&self, domain: &Domain) -> Routing {
        Routing {
            depressions: self.depressions,
            deepest_breach: self.deepest_breach.unwrap_or(f64::INFINITY),
            sea_level: self.sea_level(domain),
            directions: self.directions,
        }
    }

    fn sums(&self, landscape: &Landscape, routed: &Routed, weight: Option<&Field>) -> Vec<f64> {
        let land = landscape.domain.valid.as_ref();
        match self.method {
            Method::D8 => accumulate(&routed.directions, land, weight),
            Method::Multiple => {
                accumulate_multiple(&MultipleFlow { routed, valid: land, exponent: self.exponent }, weight)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::Size;
    use weald_engine::Watcher;

    /// Keeps what it is told, and wants the end after so many calls.
    struct Impatient {
        told: Mutex<Vec<(u64, u64)>>,
        until: usize,
    }

    impl Watcher for Impatient {
        fn progress(&self, done: u64, total: u64, _: usize) {
            self.told.lock().expect("one thread").push((done, total));
        }

        fn cancelled(&self) -> bool {
            self.told.lock().expect("one thread").len() >= self.until
        }
    }

    #[test]
    fn every_stage_is_told_and_an_interruption_stops_it_between_two() {
        let run = |weight: Option<&str>, until: usize| {
            let mut landscape = Landscape::new(Domain::new(Size { columns: 9, rows: 7 }, 10.0));
            let size = landscape.domain.size;
            landscape.insert("height", "m", Field::from_function(size, |x, y| (x * y) as f32));
            landscape.insert("rain", "mm/year", Field::filled(size, 500.0));
            let watcher = Impatient { told: Mutex::default(), until };
            let job = Job { watcher: &watcher, ..Job::unwatched(0) };
            let weight = weight.map(LayerName::of);
            let done = FlowStep { weight, ..FlowStep::default() }.run(&mut landscape, &job).map(|_| ());
            (done, watcher.told.into_inner().expect("one thread"))
        };
        let (done, told) = run(Some("rain"), usize::MAX);
        assert!(done.is_ok());
        assert_eq!(told, (1..=8).map(|stage| (stage, 8)).collect::<Vec<_>>());
        assert_eq!(run(None, usize::MAX).1.last(), Some(&(7, 7)));
        let (stopped, told) = run(None, 3);
        assert!(matches!(stopped, Err(Error::Interrupted(_))), "{stopped:?}");
        assert_eq!(told.len(), 3, "nothing is done after it");
    }
}
