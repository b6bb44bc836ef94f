//! The `thermal` step: gravity lays steep ground to rest.

use std::path::PathBuf;

use super::loose::{self, Loose};
use super::on_ground::OnGround;
use super::pipeline::Stepped;
use super::started::StartedSimulation;
use super::thermal::{Scheme, Slide, SlideConstants};
use crate::edit::Setting;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, ScriptFile};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step, Work};

parameters! {
    /// Thermal weathering as a step of its own.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::thermal_step::Thermal;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// let spike = |x, y| if (x, y) == (4, 4) { 100.0 } else { 0.0 };
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, spike));
    /// Thermal::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert!(height.at(4, 4) < 50.0 && (height.sum() - 100.0).abs() < 0.01, "it has slid, and nothing is lost");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Thermal {
        /// How slopes are compared with the talus.
        scheme: Scheme = Scheme::Isotropic;
        /// Steepest slope that rests, as a tangent (rise over run); 0.8 is 39°.
        talus: f64 = 0.8, range 0.0..=10.0, unit "(a tangent: 35° is 0.7)";
        /// Share of the excess that slides in an iteration. Unstable above 0.25.
        strength: f64 = 0.05, range 0.0..=0.25;
        /// Iterations to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer to weather.
        layer: LayerName = LayerName::of("height");
        /// Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations.
        /// Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

parameters! {
    /// Thermal weathering within every iteration of `hydraulic`.
    pub struct ThermalWithin {
        /// How slopes are compared with the talus.
        scheme: Scheme = Scheme::Isotropic;
        /// Steepest slope that rests, as a tangent (rise over run); 0.8 is 39°.
        talus: f64 = 0.8, range 0.0..=10.0, unit "(a tangent: 35° is 0.7)";
        /// Share of the excess that slides in an iteration. Unstable above 0.25.
        strength: f64 = 0.05, range 0.0..=0.25;
    }
}

impl ThermalWithin {
    /// The method's constants.
    pub(crate) fn slide(&self) -> Slide {
        let constants = SlideConstants { talus: self.talus as f32, strength: self.strength as f32 };
        Slide::new(self.scheme, constants)
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Thermal>(
    "thermal",
    Stage::Erode,
    "lets ground steeper than its talus slide until it rests (dry mass wasting)",
    "Han 2015, eq. 17–21, doi 10.7583/JKGS.2015.15.6.171",
);

impl Step for Thermal {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.layer.0.clone(), "m")]
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn bytes_per_cell(&self) -> u64 {
        32
    }

    fn runs_over_ranks(&self) -> bool {
        true
    }

    fn work(&self, _: &Domain) -> Work {
        Work::of(self.iterations).by(format!("{:?}", self.scheme))
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        loose::run(self, landscape, job)
    }

    fn files(&self) -> Vec<PathBuf> {
        loose::files(self)
    }

    fn look_ahead(&self, materials: &[Material], _: &Domain) -> Result<(), Error> {
        loose::script(self, materials).map(drop)
    }
}

impl Loose for Thermal {
    type Process = Stepped;

    const FIXED: &'static [&'static str] = &["layer"];

    fn begin(&self, landscape: &Landscape, editable: bool) -> Result<StartedSimulation<Stepped>, Error> {
        let step = self.clone();
        let piped = Box::new(move |settings: &[Setting]| Ok(loose::after(&step, settings)?.slide().pipeline));
        let alone = OnGround { name: "thermal", layer: &self.layer.0, iterations: self.iterations };
        alone.begin(piped, landscape, editable)
    }

    fn iterations(&self) -> u32 {
        self.iterations
    }

    fn edits(&self) -> Option<&ScriptFile> {
        self.edits.as_ref()
    }
}

impl Thermal {
    fn slide(&self) -> Slide {
        ThermalWithin { scheme: self.scheme, talus: self.talus, strength: self.strength }.slide()
    }
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    let schemes = [Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric];
    let sliding =
        |scheme| Thermal { scheme, talus: 0.3, strength: 0.2, iterations: 21, ..Thermal::default() };
    schemes.map(|scheme| -> Box<dyn Step> { Box::new(sliding(scheme)) }).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_talus_in_degrees_is_refused_and_told_that_it_is_a_tangent() {
        use weald_core::parameter::{Diagnostics, Parameters};
        use weald_core::source::{Node, Table, Value};

        let talus = Node { line: 1, value: Value::Integer(35) };
        let table = Table { line: 1, entries: vec![("talus".to_owned(), talus)] };
        let (mut alone, mut within) = (Diagnostics::default(), Diagnostics::default());
        let _ = (Thermal::read(&table, &mut alone), ThermalWithin::read(&table, &mut within));
        for diagnostics in [alone, within] {
            let message = format!("{:?}", diagnostics.found);
            assert!(message.contains("35, outside its range: 0 to 10 (a tangent: 35° is 0.7)"), "{message}");
        }
    }
}
