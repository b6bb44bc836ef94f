//! A simulation that is held, on a machine.

use std::sync::Arc;

use super::edits::{Before, Place};
use super::finished::Finished;
use super::look;
use super::painted_mask::PaintedMask;
use super::scripted::{Numbers, Remake, nothing_to_paint_on};
use super::started::{StartedSimulation, Store};
use crate::edit::{Area, Brush, Canvas, Setting};
use weald_core::error::{Error, NotFinite};
use weald_core::landscape::Landscape;
use weald_engine::Engine;
use weald_engine::machine::{Machine, Snapshot};
use weald_engine::machine_of_engine;
use weald_engine::patch::Patch;
use weald_engine::stencil::chain::Process;
use weald_engine::step::Outcome;

/// Steps between two looks for values that are no numbers.
const STRETCH: u64 = 256;

/// A simulation whatever its process.
pub(super) trait Live: Send {
    fn advance(&mut self, steps: std::ops::Range<u64>) -> Result<(), Error>;
    fn stroke(&mut self, brush: &Brush, mask: &mut PaintedMask) -> Result<Before, Error>;
    fn follow(&mut self, settings: &[Setting]) -> Result<(), Error>;
    fn lay(&mut self, patch: &Patch) -> Result<(), Error>;
    fn canvas(&mut self, area: Area, mask: &PaintedMask) -> Result<Canvas, Error>;
    fn store(&mut self, landscape: &mut Landscape, steps: u64) -> Result<Outcome, Error>;
    fn keep_as(&mut self, number: u64) -> Result<(), Error>;
    fn return_to(&mut self, number: u64) -> Result<(), Error>;
    fn release(&mut self, number: u64);
    fn bytes_of_copy(&self) -> u64;
}

/// A process on a machine.
pub(super) struct Running<P: Process> {
    machine: Box<dyn Machine<P>>,
    first: Numbers<P>,
    numbers: Numbers<P>,
    remake: Remake<P>,
    plane_names: Vec<String>,
    place: Option<Arc<Place>>,
    store: Store,
}

impl<P: Process> Running<P> {
    pub(super) fn new(begun: StartedSimulation<P>, engine: &Engine) -> Result<Self, Error> {
        if let Engine::Ranks(_) = engine {
            let what = "a simulation that is held cannot run over ranks: nobody holds it on the others; take another engine";
            return Err(Error::Run(what.to_owned()));
        }
        let StartedSimulation { numbers, remake, plane_names, means, start, place, working, store } = begun;
        if let Some(working) = working.as_deref() {
            working.show(engine)?;
        }
        let start = Snapshot::start(start(), means.len());
        let machine = machine_of_engine::start(&numbers.process, means, &start, engine)?;
        Ok(Self { machine, first: numbers.clone(), numbers, remake, plane_names, place, store })
    }

    fn place(&self) -> Result<Arc<Place>, Error> {
        self.place.clone().ok_or_else(nothing_to_paint_on)
    }

    fn run(&mut self, steps: std::ops::Range<u64>, recorded: bool) -> Result<(), Error> {
        let weather: Vec<_> = steps.map(|step| (self.numbers.weather)(step)).collect();
        if weather.is_empty() { Ok(()) } else { self.machine.advance(&weather, recorded) }
    }

    fn look(&mut self, done: u64) -> Result<(), Error> {
        let Some([x, y, plane]) = self.machine.first_not_finite()? else { return Ok(()) };
        let layer = self.plane_names[plane].clone();
        let message = format!(
            "before iteration {done} `{layer}` at column {x}, row {y} became no number; a lower `flow_rate` or \
             `erosion` makes the scheme stable"
        );
        Err(NotFinite { step: None, iteration: Some(done), layer, cell: [x, y], message }.into())
    }
}

impl<P: Process> Live for Running<P> {
    /// The means are those of the last step, which a run with `mean_over = 1` has as well.
    fn advance(&mut self, steps: std::ops::Range<u64>) -> Result<(), Error> {
        let Some(last) = steps.end.checked_sub(1).filter(|last| *last >= steps.start) else { return Ok(()) };
        let mut done = steps.start;
        while done < last {
            let end = (done + STRETCH).min(last);
            self.run(done..end, false)?;
            self.look(end)?;
            done = end;
        }
        self.machine.clear_means()?;
        self.run(last..steps.end, true)?;
        self.look(steps.end)
    }

    fn stroke(&mut self, brush: &Brush, mask: &mut PaintedMask) -> Result<Before, Error> {
        self.place()?.stroke(brush, &mut *self.machine, mask)
    }

    fn follow(&mut self, settings: &[Setting]) -> Result<(), Error> {
        let numbers = if settings.is_empty() { self.first.clone() } else { (self.remake)(settings)? };
        self.machine.follow(&numbers.process)?;
        self.numbers = numbers;
        Ok(())
    }

    fn lay(&mut self, patch: &Patch) -> Result<(), Error> {
        self.machine.lay(patch)
    }

    fn canvas(&mut self, area: Area, mask: &PaintedMask) -> Result<Canvas, Error> {
        self.place()?.canvas(area, &mut *self.machine, mask)
    }

    fn store(&mut self, landscape: &mut Landscape, steps: u64) -> Result<Outcome, Error> {
        let Snapshot { state, row_sums, means } = self.machine.snapshot()?;
        let notes = self.machine.note().into_iter().collect();
        (self.store)(landscape, &Finished { state, sums: look::total(&row_sums), means, notes }, steps)
    }

    fn keep_as(&mut self, number: u64) -> Result<(), Error> {
        self.machine.keep_as(number)
    }

    fn return_to(&mut self, number: u64) -> Result<(), Error> {
        self.machine.return_to(number)
    }

    fn release(&mut self, number: u64) {
        self.machine.release(number);
    }

    fn bytes_of_copy(&self) -> u64 {
        self.machine.bytes_of_copy()
    }
}
