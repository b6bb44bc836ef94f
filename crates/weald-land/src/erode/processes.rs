//! The list of the processes that run alone: all engines are compared on it, and all of its shaders checked.

use super::{dissolution_step, fluvial_step, slippage_step, thermal_step};
use weald_engine::step::Step;

/// What gives the variants of a process.
type Variants = fn() -> Vec<Box<dyn Step>>;

/// Those of each process: a new one adds its line.
const VARIANTS: &[Variants] =
    &[dissolution_step::variants, fluvial_step::variants, slippage_step::variants, thermal_step::variants];

/// Every process that runs alone, in every variant that has code of its own, for tests. They are ready for ground of
/// a few materials that is some metres high, with cells of a metre and a layer `painted` from 0 to 1.
pub fn processes() -> Vec<Box<dyn Step>> {
    VARIANTS.iter().flat_map(|variants| variants()).collect()
}
