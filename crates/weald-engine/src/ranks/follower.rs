//! What all ranks but the first do: what they are told.

use std::sync::Arc;

use super::band::Band;
use super::command::{Command, Start};
use super::leader::{described, place_message};
use super::messages::Ranks;
use super::share::Share;
use crate::machine::Means;
use crate::stencil::chain::Process;
use crate::uniform::FromWords;
use weald_core::error::Error;

/// Takes part in a simulation that the first rank leads, to its end. `next` gives the process with which it begins, and
/// then each with which it goes on after a key of its step was set.
///
/// # Errors
/// [`Error::Run`] where another rank can no longer be reached or computes something else, and those of `next`.
pub fn follow<P: Process>(
    means: Means<'static>,
    ranks: &Arc<dyn Ranks>,
    next: &mut dyn FnMut() -> Result<Arc<P>, Error>,
) -> Result<(), Error> {
    let mut process = next()?;
    let mut band = None;
    loop {
        let command = Command::read(&ranks.tell(Vec::new())?)?;
        match (command, &mut band) {
            (Command::End, _) => return Ok(()),
            (Command::Begin(start), band) => *band = Some(begin(&process, means, &start, ranks)?),
            (Command::Follow, _) => process = next()?,
            (command, Some(band)) => obey(command, band, ranks)?,
            (command, None) => {
                return Err(Error::Run(format!("a rank was told {command:?} before anything began")));
            }
        }
    }
}

fn begin<P: Process>(
    process: &Arc<P>,
    means: Means<'static>,
    start: &Start,
    ranks: &Arc<dyn Ranks>,
) -> Result<Band<P>, Error> {
    let Start { layout, rows, process: expected } = start;
    let ours = described(&**process);
    if ours != *expected {
        return Err(Error::Run(format!(
            "rank {} computes another process than rank 0: all ranks must run the same build of Weald and read the same \
             files; `{ours}` in place of `{expected}`",
            ranks.rank()
        )));
    }
    let share = Share::of((ranks.rank(), ranks.count()), *rows, process.reach());
    let part = ranks.deal(&mut |_| Vec::new())?;
    Band::new(&**process, means, (share, *layout), &part, ranks)
}

fn obey<P: Process>(command: Command, band: &mut Band<P>, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    let nobody = &mut |_, _| Ok(());
    match command {
        Command::Advance { recorded, weather } => {
            let weather: Vec<_> = weather.iter().map(|words| P::Weather::from_words(words)).collect();
            band.advance(&weather, recorded)
        }
        Command::Check => ranks.collect(place_message(band.first_not_finite()), nobody),
        Command::Keep => band.keep(),
        Command::GoBack => band.go_back(),
        Command::Collect => ranks.collect(band.part(), nobody),
        Command::Cut(window) => ranks.collect(band.cut(&window), nobody),
        Command::Lay(patch) => {
            band.lay(&patch);
            Ok(())
        }
        Command::ClearMeans => band.clear_means(),
        Command::Begin(_) | Command::Follow | Command::End => Ok(()),
    }
}
