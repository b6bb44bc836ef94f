//! Rain and evaporation of one step.

use weald_engine::uniform;

uniform! {
    /// Rain and evaporation of one step, in cells.
    pub(crate) struct Forcing {
        pub(crate) rain: f32,
        pub(crate) evaporation: f32,
    }
}
