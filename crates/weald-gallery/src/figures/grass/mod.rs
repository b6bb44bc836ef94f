//! The figures of Kim and Cho 2009, "Modeling and rendering of growing grass", one constant each. The control values of
//! its curves, its images and its scenes are lost; ours are stated. Scenes with rates are drawn by a device.

mod chart;
mod curves;
mod fields;
mod kinds;
mod raster;
mod rates;
mod scenes;
mod stem;
mod tufts;

pub(super) use curves::{FIGURE_2, FIGURE_3};
pub(super) use fields::{FIGURE_10, FIGURE_11};
pub(super) use kinds::FIGURE_5B;
pub(super) use rates::FIGURE_8;
pub(super) use scenes::{FIGURE_12, FIGURE_13};
pub(super) use stem::FIGURE_6;
pub(super) use tufts::FIGURE_5;
