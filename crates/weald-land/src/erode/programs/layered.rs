//! Programs of the processes that know materials.

use pulp::Arch;

use super::settings::{links, settings};
use crate::erode::dissolution_step::Dissolving;
use crate::erode::material_planes::{Planes, REGOLITH_PLANES};
use crate::erode::slippage_step;
use crate::erode::stava::digging::Digging;
use crate::erode::stava::dissolution::Dissolution;
use crate::erode::stava::slippage::Slippage;
use crate::erode::stava::viscosity::Viscosity;
use crate::erode::stava::{Stava, StavaConstants};
use crate::erode::water_planes as plane;
use weald_engine::program::Program;
use weald_engine::stencil::chain::Process;

/// Stacks from bedrock alone to as many materials as there can be.
const STACKS: [usize; 3] = [1, 4, 8];

pub(super) fn programs() -> impl Iterator<Item = Program> {
    stava().chain(alone())
}

fn stava() -> impl Iterator<Item = Program> {
    let water = settings().filter(|setting| setting.slide.is_none());
    let switches = water.flat_map(|setting| (0..16).map(move |switches| (setting, switches)));
    let stacks = switches.flat_map(|variant| STACKS.map(|materials| (variant, materials)));
    stacks.map(|((setting, switches), materials)| {
        let on = |bit: u32| switches >> bit & 1 == 1;
        let regolith = if on(0) { REGOLITH_PLANES } else { 0 };
        let planes = Planes { first_layer: plane::COUNT + regolith, materials };
        let process = Stava {
            constants: StavaConstants {
                flow_rate: 0.1,
                capacity: 0.05,
                epsilon: 0.001,
                velocity_epsilon: 0.0001,
            },
            planes,
            painted: on(1),
            viscosity: on(2).then(|| Viscosity::new(0.1)),
            erosion: digging(materials),
            dissolution: on(0).then(|| dissolution(plane::COUNT, materials)),
            slippage: on(3).then(|| slippage(planes, on(2))),
            setting: setting.made(),
        };
        process.program()
    })
}

fn alone() -> impl Iterator<Item = Program> {
    let masked = [false, true].into_iter().flat_map(|masked| STACKS.map(|materials| (masked, materials)));
    masked.flat_map(|(masked, materials)| {
        let dissolving = Dissolving {
            dissolution: dissolution(1, materials),
            planes: Planes { first_layer: 1 + REGOLITH_PLANES, materials },
            links: links(masked),
            arch: Arch::new(),
        };
        let planes = Planes { first_layer: 1, materials };
        let slipping = [false, true]
            .map(|softening| slippage_step::program(&slippage(planes, softening), planes, masked));
        slipping.into_iter().chain([dissolving.program()])
    })
}

fn digging(materials: usize) -> Digging {
    Digging { shares: vec![0.1; materials], deposit: materials - 1, deposition: 0.1 }
}

fn dissolution(plane: usize, materials: usize) -> Dissolution {
    Dissolution { plane, most: 0.1, kept: 0.15, flow_rate: 0.1, digging: digging(materials) }
}

fn slippage(planes: Planes, softening: bool) -> Slippage {
    Slippage::new(planes, vec![0.7; planes.materials], 0.03, softening)
}
