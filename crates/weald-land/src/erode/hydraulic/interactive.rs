//! A simulation that a person runs interactively: steps and strokes in any order, forth and back.

use super::keys::Hydraulic;
use crate::edit::{Action, Area, Canvas, Script, Session};
use crate::erode::edits::Edits;
use crate::erode::saved::Saved;
use crate::erode::springs::Forcing;
use weald_core::error::{Error, NotFinite};
use weald_core::landscape::Landscape;
use weald_engine::Engine;
use weald_engine::machine::{Machine, Snapshot};
use weald_engine::machine_of_engine;

/// A running simulation of layered ground, the [`Session`] of an [`edit::History`](crate::edit::History).
pub struct InteractiveSession<'a> {
    machine: Box<dyn Machine<Forcing> + 'a>,
    forcing: &'a dyn Fn(u64) -> Forcing,
    edits: &'a Edits,
    plane_names: &'a [String],
    /// Steps done.
    done: u64,
}

impl std::fmt::Debug for InteractiveSession<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("InteractiveSession").field("done", &self.done).finish_non_exhaustive()
    }
}

/// A state of a [`InteractiveSession`].
#[derive(Clone)]
pub struct SessionState(Saved);

impl std::fmt::Debug for SessionState {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("SessionState").field("done", &self.0.done).finish_non_exhaustive()
    }
}

impl PartialEq for SessionState {
    fn eq(&self, other: &Self) -> bool {
        self.0.done == other.0.done && self.0.snapshot == other.0.snapshot
    }
}

impl Hydraulic {
    /// Starts the simulation on a landscape, gives it to `hold`, and ends it; `iterations` and `edits` do not count.
    /// The landscape stays as it is.
    ///
    /// # Errors
    /// [`Error::Run`] for another model than `stava`, which alone knows layers; those of `hold`.
    pub fn run_interactive<R>(
        &self,
        landscape: &Landscape,
        engine: &Engine,
        hold: impl FnOnce(InteractiveSession<'_>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let Some(keys) = self.model.stava() else {
            let model = self.model.word();
            return Err(Error::Run(format!("model \"{model}\" knows no layers to edit; use \"stava\"")));
        };
        let filled = self.filled(landscape.domain.cell);
        let working = self.working(landscape, true)?;
        let chosen = self.stava(keys, landscape, (&filled, &working), Some(Script::default()))?;
        let start = Snapshot::start(chosen.start(&working), 0);
        let machine = machine_of_engine::start(&chosen.process, &[], &start, engine)?;
        let forcing = |step| self.forcing(&filled, step);
        let edits = chosen.edits.as_ref().expect("a script was given");
        let plane_names = &chosen.plane_names;
        hold(InteractiveSession { machine, forcing: &forcing, edits, plane_names, done: 0 })
    }
}

impl InteractiveSession<'_> {
    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.done
    }

    /// The whole of the landscape, for [`InteractiveSession::canvas`].
    pub fn whole(&self) -> Area {
        self.edits.whole()
    }

    /// The state over a rectangle of cells, in metres.
    ///
    /// # Errors
    /// [`Error::Device`] where it cannot be read from the device that holds it.
    pub fn canvas(&mut self, area: Area) -> Result<Canvas, Error> {
        Ok(self.edits.canvas(area, &self.machine.snapshot()?.state))
    }

    fn step(&mut self, steps: u64) -> Result<(), Error> {
        let end = self.done + steps;
        while self.done < end {
            let stop = (self.done + 256).min(end);
            let weather: Vec<_> = (self.done..stop).map(self.forcing).collect();
            self.machine.advance(&weather, false)?;
            self.done = stop;
        }
        match self.machine.first_not_finite()? {
            None => Ok(()),
            Some([x, y, plane]) => {
                let message = format!(
                    "within {steps} iterations a value at column {x}, row {y} became no number; a lower `flow_rate` \
                     makes the scheme stable"
                );
                let (iteration, layer) = (Some(self.done), self.plane_names[plane].clone());
                Err(NotFinite { step: None, iteration, layer, cell: [x, y], message }.into())
            }
        }
    }
}

impl Session for InteractiveSession<'_> {
    type Snapshot = SessionState;

    fn snapshot(&mut self) -> Result<SessionState, Error> {
        Ok(SessionState(Saved { done: self.done, snapshot: self.machine.snapshot()? }))
    }

    fn restore(&mut self, SessionState(saved): &SessionState) -> Result<(), Error> {
        self.machine.restore(&saved.snapshot)?;
        self.done = saved.done;
        Ok(())
    }

    fn apply(&mut self, action: &Action) -> Result<(), Error> {
        match action {
            Action::Steps(steps) => self.step(*steps),
            Action::Stroke(brush) => {
                let mut snapshot = self.machine.snapshot()?;
                self.edits.stroke(brush, &mut snapshot)?;
                self.machine.restore(&snapshot)
            }
        }
    }

    fn bytes(SessionState(saved): &SessionState) -> usize {
        let Snapshot { state, row_sums, means } = &saved.snapshot;
        size_of_val(state.memory.as_slice())
            + size_of_val(row_sums.as_slice())
            + means.iter().map(|mean| size_of_val(mean.as_slice())).sum::<usize>()
    }
}
