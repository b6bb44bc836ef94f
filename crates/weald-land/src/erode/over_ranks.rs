//! How the ranks of a run come to the same simulation: the first has its start, and says after how many steps it begins.

use std::sync::Arc;

use weald_core::error::Error;
use weald_engine::Engine;
use weald_engine::ranks::Ranks;
use weald_engine::stencil::rows::Rows;

/// What a simulation begins with on this rank.
pub(super) enum Beginning<'a> {
    /// The state before the first step.
    With(Rows),
    /// Where another rank leads: that has the state.
    Led(&'a Arc<dyn Ranks>),
}

impl<'a> Beginning<'a> {
    /// Makes the state where this rank needs it.
    pub(super) fn of(engine: &'a Engine, start: impl FnOnce() -> Result<Rows, Error>) -> Result<Self, Error> {
        match engine.led_by() {
            Some(ranks) => Ok(Self::Led(ranks)),
            None => start().map(Self::With),
        }
    }
}

/// Says on the first rank that a simulation begins after so many steps; nothing on other engines.
pub(super) fn announce(engine: &Engine, done: u64) -> Result<(), Error> {
    match engine {
        Engine::Ranks(ranks) => ranks.tell(done.to_le_bytes().to_vec()).map(drop),
        _ => Ok(()),
    }
}

/// Hears on another rank after how many steps the simulation begins.
///
/// # Errors
/// [`Error::Interrupted`] where the first has ended the step instead, by a message without words.
pub(super) fn learn(ranks: &dyn Ranks) -> Result<u64, Error> {
    let message = ranks.tell(Vec::new())?;
    let done = message.try_into().map(u64::from_le_bytes);
    done.map_err(|_| Error::Interrupted("the first rank ended the step before it ran".to_owned()))
}
