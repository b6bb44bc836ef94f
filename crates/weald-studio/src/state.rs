//! Which text of the document, and how much done by hand: what is saved is known by it.

use serde::{Deserialize, Serialize};

/// Numbers that grow with every change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct State {
    /// Revision of the document.
    pub revision: u64,
    /// How often something was done by hand.
    pub changes: u64,
}

impl State {
    /// Of a document that was just read.
    pub const AS_READ: Self = Self { revision: 1, changes: 0 };
}

/// What was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Did {
    /// The recipe.
    Recipe,
    /// The simulation: a stroke, a setting, steps.
    Simulation,
}
