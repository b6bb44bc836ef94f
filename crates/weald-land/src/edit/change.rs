//! What a person does to a running simulation, and when.

use super::brush::Brush;
use weald_core::source::Value;

/// What a person does between two iterations.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Paints a stroke.
    Stroke(Brush),
    /// Gives a key of the step another value.
    Set(Setting),
}

/// A key of the step that runs, and its value from now on.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The key; one within a table has its name behind a point: `thermal.talus`.
    pub key: String,
    /// A number, a flag or a word, as in a recipe.
    pub value: Value,
}

/// A change, and the iteration before which it happens.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// Iterations of the simulation that are done before it; 0 for none.
    pub step: u64,
    /// What happens.
    pub change: Change,
}

impl Edit {
    /// A stroke.
    pub fn stroke(step: u64, brush: Brush) -> Self {
        Self { step, change: Change::Stroke(brush) }
    }

    /// The stroke, where it is one.
    pub fn brush(&self) -> Option<&Brush> {
        match &self.change {
            Change::Stroke(brush) => Some(brush),
            Change::Set(_) => None,
        }
    }

    /// The setting, where it is one.
    pub fn setting(&self) -> Option<&Setting> {
        match &self.change {
            Change::Stroke(_) => None,
            Change::Set(setting) => Some(setting),
        }
    }
}

impl From<Brush> for Change {
    fn from(brush: Brush) -> Self {
        Self::Stroke(brush)
    }
}

impl From<Setting> for Change {
    fn from(setting: Setting) -> Self {
        Self::Set(setting)
    }
}

/// What can be done to a simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Simulates so many steps.
    Steps(u64),
    /// Paints a stroke, or changes a key.
    Change(Change),
}

impl<C: Into<Change>> From<C> for Action {
    fn from(change: C) -> Self {
        Self::Change(change.into())
    }
}

impl Action {
    /// What it costs to do it again, in iterations.
    pub(super) fn work(&self) -> u64 {
        match self {
            Self::Steps(steps) => (*steps).max(1),
            Self::Change(_) => 1,
        }
    }
}
