//! The window as a person uses it: found by the labels that a screen reader reads.

mod harness;
mod panels;
