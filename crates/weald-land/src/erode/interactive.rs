//! A simulation that a person holds: run a few steps at a time, painted on, changed while it runs, shown, and taken back.
//!
//! It owns all that it needs, and works on every engine. A stroke reads and writes the rectangle that it touches and no
//! more, on a device too; copies to go back to stay where the state is. What is done to it can be written down: the
//! step with [`Interactive::replayed`] and a [`Script`] of the changes gives the same bits.

use std::collections::BTreeMap;

use super::edits::Before;
use super::live::{Live, Running};
use super::painted_mask::PaintedMask;
use super::started::StartedSimulation;
use crate::edit::{Action, Area, Brush, Canvas, Change, Script, Setting, Undoable};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::source::Value;
use weald_engine::Engine;
use weald_engine::stencil::chain::Process;
use weald_engine::step::{Outcome, Step};

/// A step that is a simulation, which a person can hold.
pub trait Interactive: Step {
    /// The simulation on a landscape before its first iteration; iterations and edits of the step do not count.
    ///
    /// # Errors
    /// As [`Step::run`].
    fn hold(&self, landscape: &Landscape, engine: &Engine) -> Result<InteractiveSimulation, Error>;

    /// Steps that it runs as written, on such a landscape.
    fn written_steps(&self, landscape: &Landscape) -> u64;

    /// Keys with which the step runs so many steps, and `edits` beside them, to the same bits as when it was held.
    fn replayed(&self, steps: u64) -> Vec<(&'static str, Value)>;

    /// Steps that it runs as written, and its script, which is read here; `None` where it has no script.
    ///
    /// # Errors
    /// [`Error::Input`] for a script that cannot be read or followed.
    fn recorded(&self, materials: &[Material]) -> Result<Option<(u64, Script)>, Error>;
}

/// A running simulation.
pub struct InteractiveSimulation {
    live: Box<dyn Live>,
    /// The landscape on which it began.
    start: Landscape,
    done: u64,
    settings: Vec<Setting>,
    mask: PaintedMask,
    /// Steps, settings and masks of the copies that are kept.
    kept: BTreeMap<u64, (u64, Vec<Setting>, PaintedMask)>,
}

impl std::fmt::Debug for InteractiveSimulation {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("InteractiveSimulation").field("done", &self.done).finish_non_exhaustive()
    }
}

/// What takes a change of a simulation back.
#[derive(Clone, Debug)]
pub struct Undo(What);

#[derive(Clone, Debug)]
enum What {
    /// What was there before a stroke.
    Painted(Before),
    /// A setting is the last one.
    Set,
}

impl InteractiveSimulation {
    pub(crate) fn new<P: Process>(
        begun: StartedSimulation<P>,
        landscape: &Landscape,
        engine: &Engine,
    ) -> Result<Self, Error> {
        let live = Box::new(Running::new(begun, engine)?);
        let (settings, mask, kept) = (Vec::new(), PaintedMask::default(), BTreeMap::new());
        Ok(Self { live, start: landscape.clone(), done: 0, settings, mask, kept })
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.done
    }

    /// The landscape on which it began.
    pub fn start(&self) -> &Landscape {
        &self.start
    }

    /// The whole of the landscape, for [`InteractiveSimulation::canvas`].
    pub fn whole(&self) -> Area {
        Area { first: [0, 0], size: self.start.domain.size }
    }

    /// The state over a rectangle of cells, in metres; no more is read from a device.
    ///
    /// # Errors
    /// [`Error::Run`] where the rectangle is not within the landscape or there is no ground to see, [`Error::Device`]
    /// where it cannot be read from the device that holds it.
    pub fn canvas(&mut self, area: Area) -> Result<Canvas, Error> {
        self.live.canvas(area, &self.mask)
    }

    /// The landscape as if the step had ended here, and what the step would report.
    ///
    /// # Errors
    /// [`Error::Device`] where the state cannot be read from the device that holds it.
    pub fn landscape(&mut self) -> Result<(Landscape, Outcome), Error> {
        let mut landscape = self.start.clone();
        let outcome = self.live.store(&mut landscape, self.done)?;
        Ok((landscape, outcome))
    }

    /// Simulates so many steps.
    ///
    /// # Errors
    /// [`Error::NotFinite`] where values become no numbers; the state is then of no further use until it returns to a copy.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        self.live.advance(self.done..self.done + steps)?;
        self.done += steps;
        Ok(())
    }

    /// Paints a stroke.
    ///
    /// # Errors
    /// [`Error::Run`] for a stroke that the step cannot follow; nothing has changed then.
    pub fn stroke(&mut self, brush: &Brush) -> Result<Undo, Error> {
        self.live.stroke(brush, &mut self.mask).map(|before| Undo(What::Painted(before)))
    }

    /// Gives a key of the step another value from here on.
    ///
    /// # Errors
    /// [`Error::Run`] for a key or a value that there is not, or that cannot change while it runs; nothing has changed
    /// then.
    pub fn set(&mut self, setting: &Setting) -> Result<Undo, Error> {
        let settings = self.settings.iter().chain([setting]).cloned().collect();
        self.follow(settings)?;
        Ok(Undo(What::Set))
    }

    fn follow(&mut self, settings: Vec<Setting>) -> Result<(), Error> {
        self.live.follow(&settings)?;
        self.settings = settings;
        Ok(())
    }
}

impl Undoable for InteractiveSimulation {
    type Patch = Undo;

    fn apply(&mut self, action: &Action) -> Result<Option<Undo>, Error> {
        match action {
            Action::Steps(steps) => self.advance(*steps).map(|()| None),
            Action::Change(Change::Stroke(brush)) => self.stroke(brush).map(Some),
            Action::Change(Change::Set(setting)) => self.set(setting).map(Some),
        }
    }

    fn take_back(&mut self, Undo(what): &Undo) -> Result<(), Error> {
        match what {
            What::Painted(Before::Nothing) => Ok(()),
            What::Painted(Before::State(patch)) => self.live.lay(patch),
            What::Painted(Before::Mask(before)) => {
                self.mask.take_back(before);
                Ok(())
            }
            What::Set => {
                let before = self.settings.split_last().map_or(&[][..], |(_, before)| before).to_vec();
                self.follow(before)
            }
        }
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.live.keep_as(number)?;
        self.kept.insert(number, (self.done, self.settings.clone(), self.mask.clone()));
        Ok(())
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        let Some((done, settings, mask)) = self.kept.get(&number).cloned() else {
            return Err(Error::Run(format!("copy {number} of the simulation was never kept")));
        };
        if settings != self.settings {
            self.follow(settings)?;
        }
        self.live.return_to(number)?;
        (self.done, self.mask) = (done, mask);
        Ok(())
    }

    fn release(&mut self, number: u64) {
        self.kept.remove(&number);
        self.live.release(number);
    }

    fn bytes_of_copy(&self) -> u64 {
        self.live.bytes_of_copy()
    }

    fn bytes_of(Undo(what): &Undo) -> u64 {
        match what {
            What::Painted(Before::State(patch)) => patch.bytes() as u64,
            What::Painted(Before::Mask(before)) => before.bytes(),
            What::Painted(Before::Nothing) | What::Set => size_of::<Setting>() as u64,
        }
    }
}

/// A whole number of steps as a recipe has it.
pub(super) fn whole(steps: u64) -> Value {
    Value::Integer(i64::try_from(steps).unwrap_or(i64::MAX))
}
