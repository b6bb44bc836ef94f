//! The processes of Šťava et al. as compute passes. The shaders stand beside the kernels that they repeat.
//!
//! All materials of a cell stand in one buffer, `column`, plane after plane; `levels` has the height of all that is
//! solid and the depth of the water before it flows.

use super::dissolution::Dissolution;
use super::slippage::Slippage;
use super::{Stava, WEATHER_PLANES};
use crate::erode::advection::Advection;
use crate::erode::advection_rows::Advected;
use crate::erode::links::plane as links_plane;
use crate::erode::material_planes::Planes;
use crate::erode::springs::Forcing;
use crate::erode::water_planes as plane;
use weald_core::material::MAX_MATERIALS;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};
use weald_engine::stencil::chain::Process;
use weald_engine::uniform;

const FORCING: &str = include_str!("../forcing.wgsl");
const SUMS: &str = include_str!("../sums.wgsl");
const PIPES: &str = include_str!("../pipes.wgsl");
const CONSTANTS: &str = include_str!("../stava.wgsl");
const LAYER: &str = include_str!("layer.wgsl");
const COLUMN: &str = include_str!("column.wgsl");
const FLOWS: &str = include_str!("../mei/flows.wgsl");
const INFLOW: &str = include_str!("../mei/inflow.wgsl");
const CARRY: &str = include_str!("../mei/carry.wgsl");
const SETTLED: &str = include_str!("../mei/settled.wgsl");
const VELOCITY_OF_SEDIMENT: &str = include_str!("../mei/velocity.wgsl");
const FACES_OF_FLUX: &str = include_str!("../mei/faces_of_flux.wgsl");
const ARRIVE: &str = include_str!("../mei/arrive.wgsl");
const RECORD: &str = include_str!("../mei/record.wgsl");
const MOVED: &str = include_str!("moved.wgsl");
const DIGGING: &str = include_str!("digging.wgsl");

uniform! {
    /// Numbers of the method, in cells and steps.
    pub(crate) struct StavaNumbers {
        /// For each material, bedrock first: share of the room that erosion takes, share that dissolution takes,
        /// talus.
        pub(crate) materials: [[f32; 4]; MAX_MATERIALS],
        pub(crate) flow_rate: f32,
        pub(crate) capacity: f32,
        pub(crate) epsilon: f32,
        pub(crate) velocity_epsilon: f32,
        /// Share of the surplus that settles.
        pub(crate) deposition: f32,
        /// What each neighbour counts in a sweep of the viscosity.
        pub(crate) viscosity: f32,
        pub(crate) regolith_most: f32,
        pub(crate) regolith_kept: f32,
        pub(crate) regolith_flow_rate: f32,
        pub(crate) slippage: f32,
        /// Uniforms with vectors end on a multiple of sixteen bytes.
        pub(crate) padding_a: f32,
        pub(crate) padding_b: f32,
    }
}

impl StavaNumbers {
    const NOTHING: Self = Self {
        materials: [[0.0; 4]; MAX_MATERIALS],
        flow_rate: 0.0,
        capacity: 0.0,
        epsilon: 0.0,
        velocity_epsilon: 0.0,
        deposition: 0.0,
        viscosity: 0.0,
        regolith_most: 0.0,
        regolith_kept: 0.0,
        regolith_flow_rate: 0.0,
        slippage: 0.0,
        padding_a: 0.0,
        padding_b: 0.0,
    };

    fn set(&mut self, lane: usize, numbers: &[f32]) {
        for (material, &number) in self.materials.iter_mut().zip(numbers) {
            material[lane] = number;
        }
    }

    /// With the numbers of what there is.
    pub(crate) fn of(dissolution: Option<&Dissolution>, slippage: Option<&Slippage>) -> Self {
        let mut numbers = Self::NOTHING;
        if let Some(dissolution) = dissolution {
            numbers.set(1, &dissolution.digging.shares);
            numbers.regolith_most = dissolution.most;
            numbers.regolith_kept = dissolution.kept;
            numbers.regolith_flow_rate = dissolution.flow_rate;
        }
        if let Some(slippage) = slippage {
            numbers.set(2, &slippage.talus);
            numbers.slippage = slippage.strength;
        }
        numbers
    }
}

/// A program with the column of materials; `deposit` is the material that settles.
pub(crate) fn draft(
    name: &'static str,
    numbers: &StavaNumbers,
    (planes, deposit): (Planes, usize),
    masked: bool,
) -> ProgramBuilder {
    let weather = if name == "stava" {
        Uniforms::of(&Forcing { rain: 0.0, evaporation: 0.0 })
    } else {
        Uniforms::default()
    };
    let mut draft =
        ProgramBuilder::new(name, &[FORCING, SUMS, CONSTANTS, LAYER], Uniforms::of(numbers), weather);
    draft.count("MATERIALS", planes.materials);
    draft.count("DEPOSIT", deposit);
    let first_constant = planes.count();
    draft.buffer("base", 1, Content::Constant(vec![first_constant]));
    let column = (0..planes.materials).map(|material| planes.of(material)).collect();
    draft.layered("column", planes.materials, Content::State(column));
    if masked {
        draft.mask(first_constant + links_plane::VALID, first_constant + links_plane::ERODIBLE);
    }
    draft
}

impl Dissolution {
    /// Adds the passes of dissolution and of the flow of regolith. `standing` is the shader that knows the water, in
    /// the buffer `water`.
    pub(crate) fn add_to(draft: &mut ProgramBuilder, standing: &'static str, water: &str) {
        draft.scratch("solid", 1);
        let shaders = [PIPES, COLUMN, DIGGING, standing, include_str!("dissolution.wgsl")];
        draft.pass("dissolve", &shaders, &["base", water], &["column", "regolith", "solid"]);
        draft.pass(
            "creep",
            &[PIPES, FLOWS, include_str!("creep.wgsl")],
            &["solid", "regolith"],
            &["creeping"],
        );
        draft.pass("crept", &[PIPES, FLOWS, include_str!("crept.wgsl")], &["creeping"], &["regolith"]);
    }

    /// Adds the buffers of the regolith.
    pub(crate) fn add_buffers_to(&self, draft: &mut ProgramBuilder) {
        let first = self.plane;
        draft.buffer("regolith", 1, Content::State(vec![first]));
        draft.buffer("creeping", 4, Content::State((first + 1..first + 5).collect()));
    }
}

impl Slippage {
    /// Adds the passes of slippage over so many materials.
    pub(crate) fn add_to(&self, draft: &mut ProgramBuilder, materials: usize) {
        draft.layered("tops", materials, Content::Scratch);
        draft.layered("affordable", materials, Content::Scratch);
        draft.pass("pile_up", &[include_str!("tops.wgsl")], &["base", "column"], &["tops"]);
        let mut reads = vec!["tops"];
        let talus = if self.softening {
            draft.layered("softened_talus", materials, Content::Scratch);
            draft.pass("soften", &[include_str!("soften.wgsl")], &["tops"], &["softened_talus"]);
            reads.push("softened_talus");
            include_str!("talus_soft.wgsl")
        } else {
            include_str!("talus_firm.wgsl")
        };
        let shaders = [PIPES, talus, include_str!("slippage.wgsl")];
        let available_share = [&shaders[..], &[include_str!("available_share.wgsl")]].concat();
        draft.pass("available_share", &available_share, &[&reads[..], &["column"]].concat(), &["affordable"]);
        let slid = [&shaders[..], &[include_str!("slid.wgsl")]].concat();
        draft.pass("slip", &slid, &[&reads[..], &["affordable"]].concat(), &["column"]);
    }
}

impl Stava {
    pub(super) fn passes(&self) -> Program {
        let deposit = (self.planes, self.erosion.deposit);
        let mut draft = draft("stava", &self.numbers(), deposit, self.setting.links.planes() > 0);
        draft.flag("OPEN", self.setting.open);
        draft.buffer("carried", 2, Content::State(vec![plane::DEPTH, plane::SEDIMENT]));
        let outflows = vec![plane::EAST, plane::WEST, plane::SOUTH, plane::NORTH];
        draft.buffer("outflows", 4, Content::State(outflows));
        draft.buffer("means", 2, Content::Mean);
        draft.scratch("levels", 2);
        if let Some(dissolution) = &self.dissolution {
            dissolution.add_buffers_to(&mut draft);
        }
        self.add_water_to(&mut draft);
        self.add_erosion_to(&mut draft);
        if self.dissolution.is_some() {
            Dissolution::add_to(&mut draft, include_str!("standing_flow.wgsl"), "carried");
        }
        self.add_transport_to(&mut draft);
        if let Some(slippage) = &self.slippage {
            slippage.add_to(&mut draft, self.planes.materials);
        }
        draft.pass("record", &[INFLOW, RECORD], &["outflows"], &["means"]).recorded = true;
        draft.shows("column", Some("carried"));
        draft.finish(self.reach())
    }

    fn numbers(&self) -> StavaNumbers {
        let mut numbers = StavaNumbers {
            flow_rate: self.constants.flow_rate,
            capacity: self.constants.capacity,
            epsilon: self.constants.epsilon,
            velocity_epsilon: self.constants.velocity_epsilon,
            deposition: self.erosion.deposition,
            viscosity: self.viscosity.map_or(0.0, |viscosity| viscosity.share),
            ..StavaNumbers::of(self.dissolution.as_ref(), self.slippage.as_ref())
        };
        numbers.set(0, &self.erosion.shares);
        numbers
    }

    fn add_water_to(&self, draft: &mut ProgramBuilder) {
        let mut reads = vec!["base", "column"];
        let mut writes = vec!["levels"];
        let mut shaders = vec![PIPES, COLUMN];
        if self.dissolution.is_some() {
            reads.push("regolith");
            shaders.push(include_str!("regolith_some.wgsl"));
        } else {
            shaders.push(include_str!("regolith_none.wgsl"));
        }
        if self.painted {
            let first = self.planes.count() + self.setting.constant_planes();
            draft.layered(
                "painted",
                WEATHER_PLANES,
                Content::Constant((first..first + WEATHER_PLANES).collect()),
            );
            reads.push("painted");
            writes.push("carried");
            shaders.push(include_str!("painted_some.wgsl"));
        } else {
            reads.push("carried");
            shaders.push(include_str!("painted_none.wgsl"));
        }
        shaders.push(include_str!("weather.wgsl"));
        draft.pass("weather_and_ground", &shaders, &reads, &writes).tallies = true;
        draft.pass(
            "outflow",
            &[PIPES, FLOWS, include_str!("../four_outflows.wgsl"), include_str!("outflow.wgsl")],
            &["levels"],
            &["outflows"],
        );
    }

    fn add_erosion_to(&self, draft: &mut ProgramBuilder) {
        let by_velocity = self.setting.advection.is_some() && !self.setting.in_flux_form();
        if self.viscosity.is_some() || by_velocity {
            draft.scratch("velocities", 2);
        }
        let mut reads = vec!["levels", "outflows"];
        let mut writes = vec!["carried", "column"];
        let mut shaders = vec![PIPES, FLOWS, INFLOW, MOVED, DIGGING];
        if self.viscosity.is_some() {
            Self::add_viscosity_to(draft);
            reads.push("velocities");
            shaders.push(include_str!("speed_diffused.wgsl"));
        } else {
            shaders.push(include_str!("speed_of_flow.wgsl"));
        }
        shaders.push(include_str!("force.wgsl"));
        if self.setting.advection.is_none() {
            draft.scratch("concentration", 1);
            writes.push("concentration");
            shaders.push(include_str!("transport_input_concentration.wgsl"));
        } else if by_velocity && self.viscosity.is_none() {
            writes.push("velocities");
            shaders.push(include_str!("transport_input_velocity.wgsl"));
        } else {
            shaders.push(include_str!("transport_input_none.wgsl"));
        }
        draft.pass("erode", &shaders, &reads, &writes).tallies = self.setting.open;
    }

    fn add_viscosity_to(draft: &mut ProgramBuilder) {
        draft.scratch("velocities_once", 2);
        let shaders = [PIPES, FLOWS, INFLOW, MOVED, include_str!("velocity.wgsl")];
        draft.pass("velocity_before_diffusion", &shaders, &["levels", "outflows"], &["velocities"]);
        let sweep = include_str!("viscosity.wgsl");
        let first = [sweep, include_str!("first_sweep.wgsl")];
        draft.pass("first_sweep", &first, &["velocities"], &["velocities_once"]);
        let second = [sweep, include_str!("second_sweep.wgsl")];
        draft.pass("second_sweep", &second, &["velocities_once"], &["velocities"]);
    }

    fn add_transport_to(&self, draft: &mut ProgramBuilder) {
        let Some(advection) = self.setting.advection else {
            let shaders = [PIPES, FLOWS, INFLOW, CARRY];
            draft.pass("carry", &shaders, &["outflows", "concentration"], &["carried"]);
            return;
        };
        draft.scratch("carried_next", 2);
        let model = |from, reads| Advected {
            from,
            into: &[ARRIVE],
            reads,
            keeps: &["carried"],
            writes: "carried_next",
        };
        if let Advection::FluxCorrected { .. } = advection {
            let from = [SETTLED, INFLOW, FACES_OF_FLUX, include_str!("water_before.wgsl")];
            advection.add_to(draft, &model(&from, &["carried", "outflows", "levels"]));
        } else {
            advection.add_to(draft, &model(&[SETTLED, VELOCITY_OF_SEDIMENT], &["carried", "velocities"]));
        }
        draft.swap("carried", "carried_next");
    }
}
