//! Recipes: [`source`] as written, [`parameter`] declarations, the [`catalog`] of steps.

pub mod catalog;
pub mod parameter;
pub mod source;
