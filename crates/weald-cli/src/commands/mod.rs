//! The commands, one file each.

pub(crate) mod bench;
pub(crate) mod bench_render;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod fractal;
pub(crate) mod gallery;
pub(crate) mod info;
pub(crate) mod migrate;
pub(crate) mod new;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod steps;
#[cfg(feature = "studio")]
pub(crate) mod studio;
pub(crate) mod web;
