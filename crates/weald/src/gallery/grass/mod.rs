//! The figures of Kim and Cho 2009, "Modeling and rendering of growing grass", one constant each. The control values of
//! its curves, its images and its scenes are lost; ours are stated. Figures of whole scenes with rates are the renderer's.

mod chart;
mod curves;
mod fields;
mod kinds;
mod raster;
mod stem;
mod tufts;

pub(super) use curves::{FIGURE_2, FIGURE_3};
pub(super) use fields::{FIGURE_10, FIGURE_11};
pub(super) use kinds::FIGURE_5B;
pub(super) use stem::FIGURE_6;
pub(super) use tufts::FIGURE_5;
