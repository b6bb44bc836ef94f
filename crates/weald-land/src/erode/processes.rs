//! The lists of the processes: those that run alone, on which all engines are compared and whose shaders are checked, and
//! those that a person can hold.

use super::hydraulic::{self, Hydraulic};
use super::interactive::Interactive;
use super::{dissolution_step, fluvial_step, slippage_step, thermal_step, transport_step};
use weald_core::parameter::{Diagnostics, Parameters};
use weald_core::source::Table;
use weald_engine::step::Step;

/// What gives the variants of a process.
type Variants = fn() -> Vec<Box<dyn Step>>;

/// Those of each process: a new one adds its line.
const VARIANTS: &[Variants] =
    &[dissolution_step::variants, fluvial_step::variants, slippage_step::variants, thermal_step::variants];

/// Reads a step that can be held.
type Read = fn(&Table, &mut Diagnostics) -> Box<dyn Interactive>;

/// The steps that a person can hold: a new one adds its line.
const INTERACTIVE: &[(&str, Read)] = &[
    (dissolution_step::ENTRY.name, read::<dissolution_step::DissolutionStep>),
    (fluvial_step::ENTRY.name, read::<fluvial_step::Fluvial>),
    (hydraulic::ENTRY.name, read::<Hydraulic>),
    (slippage_step::ENTRY.name, read::<slippage_step::SlippageStep>),
    (thermal_step::ENTRY.name, read::<thermal_step::Thermal>),
    (transport_step::ENTRY.name, read::<transport_step::Carry>),
];

fn read<S: Interactive + Parameters + 'static>(
    table: &Table,
    diagnostics: &mut Diagnostics,
) -> Box<dyn Interactive> {
    Box::new(S::read(table, diagnostics))
}

/// Names of the steps that a person can hold.
pub fn interactive_names() -> Vec<&'static str> {
    INTERACTIVE.iter().map(|(name, _)| *name).collect()
}

/// The step of that name with these keys, where a person can hold it.
pub fn interactive(name: &str, keys: &Table, diagnostics: &mut Diagnostics) -> Option<Box<dyn Interactive>> {
    let (_, read) = INTERACTIVE.iter().find(|(known, _)| *known == name)?;
    Some(read(keys, diagnostics))
}

/// Every process that runs alone, in every variant that has code of its own, for tests. They are ready for ground of
/// a few materials that is some metres high, with cells of a metre and a layer `painted` from 0 to 1.
pub fn processes() -> Vec<Box<dyn Step>> {
    VARIANTS.iter().flat_map(|variants| variants()).collect()
}
