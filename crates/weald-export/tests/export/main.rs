//! Exports as other programs open them.

#[path = "../../../weald-land/tests/land/common/mod.rs"]
mod common;
mod meshes;
mod programs;
