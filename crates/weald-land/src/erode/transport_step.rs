//! The `transport` step: water that flows steadily carries a layer along.

mod program;

use std::path::PathBuf;
use std::sync::Arc;

use pulp::Arch;

use super::advection::{Advection, AdvectionScratch};
use super::finished::Finished;
use super::links::{Links, mask_planes};
use super::loose::{self, Loose};
use super::scripted::Numbers;
use super::started::{StartedSimulation, Store};
use super::sweep::Sweep;
use crate::edit::Setting;
use crate::erode::advection_rows::AdvectionRows;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Length, ScriptFile};
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;
use weald_engine::stencil::rows::{Layout, Rows};
use weald_engine::step::{Entry, Outcome, Stage, Step, Work};

choices! {
    /// How a layer travels.
    pub enum Scheme {
        /// Back along the velocity, bilinear; conserves nothing.
        SemiLagrangian = "semi-lagrangian",
        /// Corrected to second order; with `conserve` nothing is lost.
        MacCormack = "maccormack",
    }
}

parameters! {
    /// Transport along the rivers of an earlier `hydraulic` step, whose water stays as it is.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::transport_step::Carry;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(24, 3)?, 1.0)); // columns, rows, metres
    /// for (layer, value) in [("water", 1.0), ("flux_x", 0.2), ("flux_y", 0.0)] {
    ///     landscape.insert(layer, "m", Field::filled(landscape.domain.size, value));
    /// }
    /// let line = |x, _| if x == 4 { 1.0 } else { 0.0 };
    /// landscape.insert("dye", "m", Field::from_function(landscape.domain.size, line));
    /// let carry = Carry { layer: LayerName::of("dye"), iterations: 40, ..Carry::default() };
    /// carry.run(&mut landscape, &Job::unwatched(0))?;
    /// let dye = landscape.field("dye")?;
    /// assert!(dye.at(12, 1) > dye.at(4, 1) && (dye.sum() - 3.0).abs() < 1.0e-4, "all of it, downstream");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Carry {
        /// Layer to carry, as an amount in each cell: what leaves a cell enters its neighbours.
        layer: LayerName = LayerName::needed();
        /// Iterations to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// How it travels.
        scheme: Scheme = Scheme::MacCormack;
        /// Whether it takes the form that conserves the layer's sum.
        conserve: bool = true, when scheme = "maccormack";
        /// Layer with the depth of water.
        water: LayerName = LayerName::of("water");
        /// Layer with the flow through the eastern edge of each cell, in m³ per iteration.
        flux_x: LayerName = LayerName::of("flux_x");
        /// Layer with the flow through the southern edge of each cell, in m³ per iteration.
        flux_y: LayerName = LayerName::of("flux_y");
        /// Depth added where amounts and flows are divided by depth.
        epsilon: Length = Length::Cells(0.001), range 0.000_000_1..=100.0, unit "m";
        /// Script of edits, in JSON lines (.jsonl) or TOML: keys that change between iterations. Its path starts at the
        /// folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Carry>(
    "transport",
    Stage::Erode,
    "carries a layer along with water that flows steadily",
    "Zalesak 1979, doi 10.1016/0021-9991(79)90051-2; Selle et al. 2008, doi 10.1007/s10915-007-9166-4",
);

impl Carry {
    fn epsilon_in_cells(&self, cell: f64) -> f32 {
        self.epsilon.in_cells(cell) as f32
    }

    fn advection(&self, cell: f64) -> Advection {
        match self.scheme {
            Scheme::SemiLagrangian => Advection::SemiLagrangian,
            Scheme::MacCormack if !self.conserve => Advection::MacCormack,
            Scheme::MacCormack => Advection::FluxCorrected { epsilon: self.epsilon_in_cells(cell) },
        }
    }

    /// The layer, and behind it what does not change: water, links, and flows or velocities to the east and
    /// the south; lengths in cells.
    fn state(&self, landscape: &Landscape, advection: Advection) -> Result<Rows, Error> {
        let domain = &landscape.domain;
        let water = scaled(landscape.field(&self.water.0)?, 1.0 / domain.cell);
        let volume = domain.cell * domain.cell * domain.cell;
        let x = inner(domain, scaled(landscape.field(&self.flux_x.0)?, 1.0 / volume), [1, 0]);
        let y = inner(domain, scaled(landscape.field(&self.flux_y.0)?, 1.0 / volume), [0, 1]);
        let flows = if matches!(advection, Advection::FluxCorrected { .. }) {
            [x, y]
        } else {
            let epsilon = self.epsilon_in_cells(domain.cell);
            [velocity(&x, &water, epsilon, 1), velocity(&y, &water, epsilon, domain.size.columns)]
        };
        let masks = domain.valid.as_ref().map(|mask| mask_planes(mask, false));
        let load = landscape.field(&self.layer.0)?.values().to_vec();
        let planes: Vec<_> =
            [load, water].into_iter().chain(masks.into_iter().flatten()).chain(flows).collect();
        let layout = Layout { columns: domain.size.columns, planes: planes.len() };
        let mut rows = Rows::new(layout, domain.size.rows);
        planes.iter().enumerate().for_each(|(at, plane)| rows.scatter(at, plane));
        Ok(rows)
    }
}

fn scaled(field: &Field, factor: f64) -> Vec<f32> {
    field.values().iter().map(|&value| (f64::from(value) * factor) as f32).collect()
}

/// Flows through edges that join two cells with data; no others let anything through.
fn inner(domain: &Domain, mut flow: Vec<f32>, towards: [usize; 2]) -> Vec<f32> {
    let Size { columns, rows } = domain.size;
    let valid = |x: usize, y: usize| {
        x < columns && y < rows && domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y))
    };
    for (at, flow) in flow.iter_mut().enumerate() {
        let (x, y) = (at % columns, at / columns);
        if !(valid(x, y) && valid(x + towards[0], y + towards[1])) {
            *flow = 0.0;
        }
    }
    flow
}

/// Mean of the flows through both faces of each cell over its depth; `before` cells back lies the face behind.
fn velocity(flow: &[f32], water: &[f32], epsilon: f32, before: usize) -> Vec<f32> {
    let behind = |at: usize| at.checked_sub(before).map_or(0.0, |at| flow[at]);
    let mean = |at: usize| (behind(at) + flow[at]) * 0.5 / (water[at].max(0.0) + epsilon);
    (0..flow.len()).map(mean).collect()
}

impl Step for Carry {
    fn reads(&self) -> Vec<String> {
        [&self.layer, &self.water, &self.flux_x, &self.flux_y].map(|name| name.0.clone()).to_vec()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.layer.0.clone(), "m")]
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

impl Loose for Carry {
    type Process = Carrying;

    const FIXED: &'static [&'static str] = &["layer", "water", "flux_x", "flux_y"];

    fn begin(&self, landscape: &Landscape, _: bool) -> Result<StartedSimulation<Carrying>, Error> {
        let (size, masked, cell) =
            (landscape.domain.size, landscape.domain.valid.is_some(), landscape.domain.cell);
        let carrying = move |step: &Self| Carrying {
            advection: step.advection(cell),
            links: Links::new(size, masked),
            arch: Arch::new(),
        };
        let step = self.clone();
        let remade = move |settings: &[Setting]| {
            let changed = loose::after(&step, settings)?;
            // The planes hold flows or velocities, whichever the scheme takes.
            let in_flux_form = |step: &Self| matches!(step.advection(cell), Advection::FluxCorrected { .. });
            if in_flux_form(&changed) != in_flux_form(&step) || changed.epsilon != step.epsilon {
                return Err(Error::Run("the form of the transport cannot change while it runs".to_owned()));
            }
            Ok(Numbers::new(carrying(&changed), |_| ()))
        };
        let start = self.state(landscape, self.advection(cell))?;
        Ok(StartedSimulation {
            plane_names: vec!["load".to_owned()],
            start: Box::new(move || start),
            numbers: Numbers::new(carrying(self), |_| ()),
            remake: Arc::new(remade),
            means: &[],
            place: None,
            store: self.store(),
            working: None,
        })
    }

    fn iterations(&self) -> u32 {
        self.iterations
    }

    fn edits(&self) -> Option<&ScriptFile> {
        self.edits.as_ref()
    }
}

impl Carry {
    /// Writes the layer that was carried.
    fn store(&self) -> Store {
        let LayerName(layer) = self.layer.clone();
        Arc::new(move |landscape: &mut Landscape, finished: &Finished, iterations| {
            let unit = landscape.layer(&layer)?.unit.clone();
            let carried = Field::from_values(landscape.domain.size, finished.state.gather(0));
            landscape.insert(&layer, &unit, carried);
            Ok(Outcome { iterations, notes: finished.notes.clone(), ..Outcome::default() })
        })
    }
}

/// Transport alone as a stream of rows. Planes: the load; then water, links, and flows or velocities.
pub(crate) struct Carrying {
    pub(crate) advection: Advection,
    pub(crate) links: Links,
    pub(crate) arch: Arch,
}

/// Rows in flight.
pub(crate) struct CarryingScratch {
    load: Ring,
    depth: Ring,
    eastward: Ring,
    southward: Ring,
    advection: AdvectionScratch,
}

impl Process for Carrying {
    type Weather = ();
    type Scratch = CarryingScratch;

    fn state_planes(&self) -> usize {
        1
    }

    fn constant_planes(&self) -> usize {
        3 + self.links.planes()
    }

    fn lag(&self) -> usize {
        self.advection.lag()
    }

    fn scratch(&self, columns: usize) -> CarryingScratch {
        let ring = |depth| Ring::new(columns, depth);
        CarryingScratch {
            load: ring(4),
            depth: ring(1),
            eastward: ring(3),
            southward: ring(3),
            advection: AdvectionScratch::new(columns),
        }
    }

    fn sized(&self, size: Size) -> Self {
        Self { links: self.links.sized(size), ..*self }
    }

    fn program(&self) -> Program {
        self.passes()
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        let sweep = Sweep::of(flow, &self.links, self.arch, Some(flow.y));
        let scratch = &mut *flow.scratch;
        let flows = 1 + self.links.planes();
        if flow.span.contains(&flow.y) {
            let y = flow.y;
            scratch.load.here_mut(y).copy_from_slice(flow.input[0].here(y));
            scratch.depth.here_mut(y).copy_from_slice(flow.constants[0].here(y));
            scratch.eastward.here_mut(y).copy_from_slice(flow.constants[flows].here(y));
            scratch.southward.here_mut(y).copy_from_slice(flow.constants[flows + 1].here(y));
        }
        let rows = AdvectionRows {
            sediment: &scratch.load,
            depth: &scratch.depth,
            eastward: &scratch.eastward,
            southward: &scratch.southward,
            sweep,
        };
        self.advection.advance(&rows, &mut scratch.advection, &mut flow.output[0]);
    }
}
