//! Strokes of a script in a running simulation: its state becomes a canvas, is painted on, and goes back.
//!
//! What a stroke adds or takes counts into the sums of the run, water as rain and evaporation, ground as solid
//! that went out (below 0 where some came), so that the budget closes over it. Only cells that a stroke changed
//! get new values.

use super::stack::Column;
use super::stava::{WEATHER_PLANES, plane};
use super::sums;
use super::working::Working;
use crate::edit::{Area, Brush, Canvas, Edit, Effect, Script};
use crate::engine::machine::Snapshot;
use crate::error::Error;
use crate::grid::{Field, Mask, Size};
use crate::stencil::rows::Rows;

/// Where a state lies on the landscape, and what its planes are.
pub(crate) struct Place {
    /// Columns and rows of the landscape, without the ring.
    size: Size,
    ring: usize,
    cell: f64,
    /// Height from which the ground counts, in metres.
    lowest: f64,
    /// Cells that take part, without the ring.
    land: Option<Mask>,
    column: Column,
}

impl Place {
    pub(crate) fn of(working: &Working, column: Column) -> Self {
        let size = working.start.size();
        let cells = (0..size.rows).flat_map(|y| (0..size.columns).map(move |x| working.place(x, y)));
        let takes_part = |mask: &Mask| cells.map(|at| mask.is_land_at(at)).collect();
        let land = working.mask.as_ref().and_then(|mask| Mask::new(size, takes_part(mask)));
        Self { size, ring: working.ring, cell: working.cell, lowest: working.lowest, land, column }
    }
}

/// A script that happens to a simulation.
pub(crate) struct Edits {
    script: Script,
    materials: Vec<String>,
    place: Place,
}

impl Edits {
    /// # Errors
    /// [`Error::Run`] for a stroke that this simulation cannot follow.
    pub(crate) fn new(script: Script, materials: Vec<String>, place: Place) -> Result<Self, Error> {
        let stills = |edit: &&Edit| matches!(edit.brush.effect, Effect::Freeze | Effect::Thaw);
        match script.edits().iter().find(stills) {
            Some(edit) => Err(Error::Run(format!(
                "the script freezes or thaws ground before step {}, which cannot be done within a run; give the \
                 step a `region` outside which all stands still",
                edit.step
            ))),
            None => Ok(Self { script, materials, place }),
        }
    }

    /// The first step, from `step` on, before which something happens.
    pub(crate) fn next_from(&self, step: u64) -> Option<u64> {
        self.script.next_from(step)
    }

    /// All strokes that happen before a step.
    pub(crate) fn change(&self, step: u64, snapshot: &mut Snapshot) -> Result<(), Error> {
        self.script.before(step).iter().try_for_each(|edit| self.stroke(&edit.brush, snapshot))
    }

    /// Paints the weather again as it was after `done` steps: a checkpoint does not hold it.
    pub(crate) fn catch_up(&self, done: u64, snapshot: &mut Snapshot) -> Result<(), Error> {
        let weather = |edit: &&Edit| {
            matches!(edit.brush.effect, Effect::Source { .. } | Effect::Drain { .. } | Effect::Rain { .. })
        };
        let earlier = self.script.edits().iter().filter(|edit| edit.step < done);
        earlier.filter(weather).try_for_each(|edit| self.stroke(&edit.brush, snapshot))
    }

    fn stroke(&self, brush: &Brush, snapshot: &mut Snapshot) -> Result<(), Error> {
        let Some(area) = brush.area(self.place.size, self.place.cell) else { return Ok(()) };
        let before = self.canvas(area, &snapshot.state);
        let mut after = before.clone();
        brush.paint(&mut after)?;
        self.take_back(&before, &after, snapshot);
        Ok(())
    }

    /// A rectangle of the state, in metres.
    fn canvas(&self, area: Area, state: &Rows) -> Canvas {
        let Place { cell, lowest, ref land, column, .. } = self.place;
        let base = column.planes.count();
        let metres =
            |plane: usize| self.cut(area, |x, y| (f64::from(state.plane(y, plane)[x]) * cell) as f32);
        let height = |x: usize, y: usize| {
            let [base, change] = [base, plane::CHANGE].map(|plane| f64::from(state.plane(y, plane)[x]));
            (lowest + (base + change) * cell) as f32
        };
        let [rain, source] = weather_of(state);
        let open = land.as_ref().map(|land| {
            let rows = area.first[1]..area.first[1] + area.size.rows;
            let columns = area.first[0]..area.first[0] + area.size.columns;
            rows.flat_map(|y| columns.clone().map(move |x| land.is_land(x, y))).collect()
        });
        Canvas {
            first: area.first,
            cell,
            materials: self.materials.clone(),
            land: open.and_then(|open| Mask::new(area.size, open)),
            bedrock: self.cut(area, height),
            thickness: (1..column.planes.materials)
                .map(|material| metres(column.planes.of(material)))
                .collect(),
            water: metres(plane::DEPTH),
            source: metres(source),
            rain: self.cut(area, |x, y| state.plane(y, rain)[x]),
            frozen: Field::filled(area.size, 0.0),
        }
    }

    /// A field over a rectangle, from values by column and row of the state.
    fn cut(&self, area: Area, value: impl Fn(usize, usize) -> f32) -> Field {
        let [left, top] = area.first.map(|first| first + self.place.ring);
        Field::from_function(area.size, |x, y| value(left + x, top + y))
    }

    /// Gives the state what a stroke changed.
    fn take_back(&self, before: &Canvas, after: &Canvas, snapshot: &mut Snapshot) {
        let Place { cell, column, .. } = self.place;
        let [rain, source] = weather_of(&snapshot.state);
        let whole = |_: f32, _: f32, new: f32| (f64::from(new) / cell) as f32;
        // Of a high mountain the change alone has the digits of what was added.
        let change =
            |now: f32, old: f32, new: f32| (f64::from(now) + (f64::from(new) - f64::from(old)) / cell) as f32;
        let fields = |canvas| Canvas::fields(canvas).map(|(_, field)| field);
        let names: Vec<_> = (0..column.planes.materials).map(|material| column.planes.of(material)).collect();
        let planes = names.iter().copied().chain([plane::DEPTH, source, rain]);
        for ((plane, old), new) in planes.zip(fields(before)).zip(fields(after)) {
            let value: &dyn Fn(f32, f32, f32) -> f32 = match plane {
                plane::CHANGE => &change,
                _ if plane == rain => &|_, _, new| new,
                _ => &whole,
            };
            let patch = Patch { first: before.first, ring: self.place.ring, plane, old, new };
            let moved = patch.lay(&mut snapshot.state, value);
            if plane == plane::DEPTH {
                snapshot.row_sums[0][sums::RAINED] += moved[0];
                snapshot.row_sums[0][sums::EVAPORATED] += moved[1];
            } else if names.contains(&plane) {
                snapshot.row_sums[0][sums::SEDIMENT_OUT] -= moved[0] + moved[1];
            }
        }
    }
}

/// The planes of the rain and of the sources, which are the first and the last of the weather.
fn weather_of(state: &Rows) -> [usize; 2] {
    [state.layout.planes - WEATHER_PLANES, state.layout.planes - 1]
}

/// A field before and after a stroke, and the plane that it came from.
struct Patch<'a> {
    first: [usize; 2],
    ring: usize,
    plane: usize,
    old: &'a Field,
    new: &'a Field,
}

impl Patch<'_> {
    /// Sets the cells that differ; gives what they gained and, below 0, what they lost.
    fn lay(&self, state: &mut Rows, value: &dyn Fn(f32, f32, f32) -> f32) -> [f64; 2] {
        let [left, top] = self.first.map(|first| first + self.ring);
        let Size { columns, rows } = self.old.size();
        let mut moved = [0.0; 2];
        for y in 0..rows {
            let cells = &mut state.plane_mut(top + y, self.plane)[left..left + columns];
            for ((now, &old), &new) in cells.iter_mut().zip(self.old.row(y)).zip(self.new.row(y)) {
                if old == new {
                    continue;
                }
                let was = f64::from(*now);
                *now = value(*now, old, new);
                let gained = f64::from(*now) - was;
                moved[usize::from(gained < 0.0)] += gained;
            }
        }
        moved
    }
}
