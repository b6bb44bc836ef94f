//! The window as a person uses it: found by the labels that a screen reader reads.

mod controls;
mod dialogs;
mod followed;
mod guide;
mod harness;
mod history;
mod kills;
mod looking;
mod marks;
mod masks;
mod panels;
mod pen;
mod plants;
mod rays;
mod refused;
mod remote;
mod results;
mod seeds;
mod settings;
