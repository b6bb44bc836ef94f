//! The `stream-power` step: ground rises for millions of years, and rivers cut it into ranges.

use super::fluvial_levels as levels;
use weald_core::choices;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};

choices! {
    /// What becomes of lakes.
    pub enum Lakes {
        /// Sediment passes through them.
        Kept = "kept",
        /// Rivers fill them from where they enter.
        Silted = "filled",
    }
}

choices! {
    /// Where rivers leave the grid.
    pub enum Outlets {
        /// Over all borders.
        Border = "border",
        /// Where the border lies in the sea.
        Sea = "sea",
        /// Over the northern border.
        North = "north",
        /// Over the eastern border.
        East = "east",
        /// Over the southern border.
        South = "south",
        /// Over the western border.
        West = "west",
    }
}

parameters! {
    /// Ground that rises while rivers cut down and slopes creep, over millions of years: what gives a range its trunk
    /// rivers and ridges. Rivers end at the border of the grid or of the data, whose height stays, and cut no deeper than the sea.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::stream_power_step::StreamPower;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(64, 48)?, 200.0)); // columns, rows, metres
    /// let rough = |x, y| ((7 * x + 13 * y) % 11) as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, rough));
    /// let outcome = StreamPower::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let (_, highest) = landscape.field("height")?.range(None).expect("there are cells");
    /// assert!(highest > 100.0, "a range of {highest} m");
    /// assert!(outcome.budget.expect("is kept").solid.error().abs() < 1.0e-6, "nothing is lost");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct StreamPower {
        /// Years that pass.
        duration: f64 = 5_000_000.0, range 0.0..=10_000_000_000.0, unit "a";
        /// How fast ground rises (U), but at the border.
        uplift: f64 = 0.5, range 0.0..=100.0, unit "mm/a";
        /// Layer that multiplies the uplift: 0 where ground stays, below 0 where it sinks. Default: 1 everywhere.
        uplift_map: Option<LayerName> = None;
        /// How fast rivers cut down where the upslope area is 1 m² and the slope 1 (K).
        erodibility: f64 = 0.000_005, range 0.0..=1000.0, unit "m^(1-2m)/a";
        /// Layer that multiplies the erodibility: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        erodibility_map: Option<LayerName> = None;
        /// Whether each material wears in its own way: `erodibility` is then that of the bedrock, and those of the others
        /// stand to it as theirs do, and slopes of each stand at its talus at most: hard beds as cliffs above soft ones. What
        /// rivers lay down counts as the last material.
        materials: bool = false;
        /// Exponent of the upslope area (m). Over that of the slope it is how much flatter rivers become downstream.
        area_exponent: f64 = 0.5, range 0.0..=2.0;
        /// Upslope area from which on there is a river. With less, slopes stand as steep as with so much, as those of mountains
        /// do (Stock and Dietrich 2003, doi 10.1029/2001WR001057), and what creeps stays on them; a river carries it off.
        hillslope_area: f64 = 50_000.0, range 0.0..=1.0e9, unit "m²";
        /// Exponent of the slope (n).
        slope_exponent: f64 = 1.0, range 0.1..=5.0;
        /// Of what rivers carry, the share that they lay down (G): 0 for bare rock, 1 and more for rivers in their gravel.
        deposition: f64 = 0.0, range 0.0..=10.0;
        /// Creep of soil (D), which rounds ridges.
        creep: f64 = 0.01, range 0.0..=1000.0, unit "m²/a";
        /// Steepest slope that stands, of whatever material; what is steeper slides down to it.
        critical_slope_deg: f64 = 40.0, range 1.0..=89.0, unit "deg";
        /// Years of one step of time. Default: a two-hundredth of the duration.
        time_step: Option<f64> = None, range 0.001..=10_000_000_000.0, unit "a";
        /// Where rivers leave the grid or the data: ground keeps its height there, and rises and wears at other borders as it
        /// does inside.
        outlets: Outlets = Outlets::Border;
        /// What becomes of lakes.
        lakes: Lakes = Lakes::Silted;
        /// Distance under water in which 63 % of what a river carries settles, in the sea and in lakes that are filled.
        settling_length: f64 = 1000.0, range 0.0..=1.0e6, unit "m";
        /// How far the points between which rivers run lie off the middles of their cells: 0 for a regular grid, whose
        /// eight directions show, up to 1 for all over the cell.
        irregularity: f64 = 0.7, range 0.0..=1.0;
        /// Grids that it runs on at most, each with cells twice as long as those of the next, up to `coarsest`: an eighth
        /// of the time passes on each but the coarsest, which has the rest. The numbers of cells must divide, and none may
        /// be without data.
        levels: u32 = 1, range 1..=8;
        /// Longest cells of these grids. On the coarsest it is decided where rivers run: a landscape of any size that
        /// begins on the same one has the same rivers.
        coarsest: f64 = 100.0, range 0.001..=100_000.0, unit "m";
        /// Length of the cells on which the landscape takes its form, so that it is the same at every size: grids of such and
        /// of longer cells share the time as if there were no finer ones, and each finer one adds detail in a hundredth of the
        /// time. Default: the shares that `levels` names.
        settled: Option<f64> = None, range 0.001..=100_000.0, unit "m";
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<StreamPower>(
    "stream-power",
    Stage::Erode,
    "lets ground rise and rivers cut it into ranges, over millions of years",
    "Braun and Willett 2013, doi 10.1016/j.geomorph.2012.10.008; Yuan et al. 2019, doi 10.1029/2018JF004867",
);

/// The grids of a landscape, each with cells twice as long as those of the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grids {
    pub(super) count: u32,
    /// Those with shorter cells than the landscape is settled on.
    finer: u32,
}

impl Grids {
    /// Share of the time on a grid that adds detail: its rivers have not yet moved, but have cut down.
    const DETAIL: f64 = 0.01;

    /// Share of the time on one of them, counted from the finest, 0.
    pub(super) fn share(self, level: u32) -> f64 {
        let Some(settled) = level.checked_sub(self.finer) else { return Self::DETAIL };
        let alone = levels::Shares::UPLIFT.of(settled, self.count - self.finer);
        if settled == 0 { alone - f64::from(self.finer) * Self::DETAIL } else { alone }
    }

    /// What tells the seed of one of them from others: the same for the same cells.
    pub(super) fn seed(self, level: u32) -> u64 {
        (i64::from(level) - i64::from(self.finer)).cast_unsigned()
    }
}

impl StreamPower {
    /// The layers that it reads beside the ground.
    pub(super) fn maps(&self) -> impl Iterator<Item = &LayerName> {
        [&self.uplift_map, &self.erodibility_map].into_iter().flatten()
    }

    /// The grids on which it runs over cells of that many metres.
    pub(super) fn grids(&self, cell: f64) -> Grids {
        let count = levels::grids(self.levels, self.coarsest, cell);
        let is_finer = |level: &u32| {
            let long = cell * f64::from(1 << level);
            self.settled.is_some_and(|settled| long < settled * (1.0 - 1e-9))
        };
        Grids { count, finer: (0..count - 1).take_while(is_finer).count() as u32 }
    }

    /// Years of a step of time, before the last of a level is cut to what is left.
    pub(super) fn step_years(&self) -> f64 {
        /// Steps of time in the duration where nothing is said: ground changes by little in each.
        const STEPS: f64 = 200.0;
        self.time_step.unwrap_or(self.duration / STEPS)
    }

    /// Steps of time on one of the grids, counted from the finest, 0.
    pub(super) fn steps(&self, level: u32, grids: Grids) -> u64 {
        let years = self.duration * grids.share(level);
        if years > 0.0 { (years / self.step_years() - 1e-9).ceil().max(1.0) as u64 } else { 0 }
    }
}

impl Step for StreamPower {
    fn reads(&self) -> Vec<String> {
        std::iter::once(&self.layer).chain(self.maps()).map(|name| name.0.clone()).collect()
    }

    fn layered(&self) -> Layered {
        if self.materials { Layered::Changes } else { Layered::Never }
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        let hard = materials.first().is_some_and(|bedrock| bedrock.erodibility > 0.0);
        let message = "`materials` is true, but the `erodibility` of the bedrock is 0: those of the others are \
                       measured by it";
        let fault = || Fault::of("materials", message.to_owned());
        (self.materials && !hard).then(fault).into_iter().collect()
    }

    fn faults(&self) -> Vec<Fault> {
        /// Most steps of time, beyond which a key is more likely wrong than meant.
        const MOST_STEPS: f64 = 1e7;
        let fault = || {
            let message = format!(
                "`time_step` is {} a, but must be at least {} a: one step in {MOST_STEPS} of the duration",
                self.step_years(),
                self.duration / MOST_STEPS
            );
            Fault::of("time_step", message)
        };
        (self.duration / self.step_years() > MOST_STEPS).then(fault).into_iter().collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = ["erosion", "deposition", "lake_depth"].map(|name| (name.to_owned(), "m"));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    /// Years.
    fn watched(&self) -> u64 {
        self.duration as u64
    }

    fn watched_after(&self, _: u64) -> Option<u64> {
        None
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        if self.outlets == Outlets::Sea && domain.sea_level.is_none() {
            let message =
                "`outlets` is \"sea\", but there is none: give `sea_level` in [landscape], in metres";
            return Err(Error::Run(message.to_owned()));
        }
        levels::check(domain, self.grids(domain.cell).count)
    }

    fn bytes_per_cell(&self) -> u64 {
        120
    }

    /// The steps on each grid, as many cells as that has.
    fn work(&self, domain: &Domain) -> Work {
        let grids = self.grids(domain.cell);
        let on = |level: u32| self.steps(level, grids) as f64 / f64::from(1 << (2 * level));
        let method = if self.deposition > 0.0 { "deposition" } else { "" };
        Work::of((0..grids.count).map(on).sum::<f64>()).by(method)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        self.check_on(&landscape.domain)?;
        self.run_levels(landscape, job)
    }
}
