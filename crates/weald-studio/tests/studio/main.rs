//! The window as a person uses it: found by the labels that a screen reader reads.

mod controls;
mod guide;
mod harness;
mod kills;
mod looking;
mod panels;
mod rays;
mod remote;
