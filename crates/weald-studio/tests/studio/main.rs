//! The window as a person uses it: found by the labels that a screen reader reads.

mod controls;
mod dialogs;
mod guide;
mod harness;
mod history;
mod kills;
mod looking;
mod marks;
mod panels;
mod rays;
mod remote;
mod settings;
