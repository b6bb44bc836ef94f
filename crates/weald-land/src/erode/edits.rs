//! Strokes of a script in a running simulation: its state becomes a canvas, is painted on, and goes back.
//!
//! What a stroke adds or takes counts into the sums of the run, water as rain and evaporation, ground as solid
//! that went out (below 0 where some came), so that the budget closes over it. Only cells that a stroke changed
//! get new values.

use super::links::{MASK_PLANES, mask_planes};
use super::material_planes::WEATHER_PLANES;
use super::stack::Column;
use super::sums;
use super::water_planes as plane;
use super::working::WorkingGrid;
use crate::edit::{Area, Brush, Canvas, Edit, Effect, Script};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_engine::machine::Snapshot;
use weald_engine::stencil::rows::Rows;

/// Where a state lies on the landscape, and what its planes are.
pub(crate) struct Place {
    /// Columns and rows of the landscape, without the ring.
    size: Size,
    ring: usize,
    cell: f64,
    /// Height from which the ground counts, in metres.
    lowest: f64,
    /// Cells that take part, without the ring.
    valid: Option<Mask>,
    column: Column,
}

impl Place {
    pub(crate) fn of(working: &WorkingGrid, column: Column) -> Self {
        let size = working.start.size();
        let cells = (0..size.rows).flat_map(|y| (0..size.columns).map(move |x| working.place(x, y)));
        let takes_part = |mask: &Mask| cells.map(|at| at.is_some_and(|at| mask.is_valid_at(at))).collect();
        let valid = working.mask.as_ref().and_then(|mask| Mask::new(size, takes_part(mask)));
        Self { size, ring: working.ring, cell: working.cell, lowest: working.lowest, valid, column }
    }
}

/// A script that happens to a simulation.
pub(crate) struct Edits {
    script: Script,
    materials: Vec<String>,
    place: Place,
}

impl Edits {
    /// Strokes that pass [`check`].
    pub(crate) fn new(script: Script, materials: Vec<String>, place: Place) -> Self {
        Self { script, materials, place }
    }

    /// The first step, from `step` on, before which something happens.
    pub(crate) fn next_from(&self, step: u64) -> Option<u64> {
        self.script.next_from(step)
    }

    /// What the user should know after a run of so many steps.
    pub(crate) fn notes(&self, iterations: u64) -> Vec<String> {
        let edits = self.script.edits();
        let (happened, late) = edits.split_at(edits.partition_point(|edit| edit.step < iterations));
        let Place { size, cell, .. } = self.place;
        let beside = happened.iter().filter(|edit| edit.brush.area(size, cell).is_none()).count();
        let mut notes = vec![format!(
            "strokes of the script that happened: {}; in the budget the ground that they gave or took counts as \
             solid that went out (below 0: came), the water as rain and evaporation",
            happened.len()
        )];
        if beside > 0 {
            notes.push(format!("strokes that touched no cell of the landscape: {beside}"));
        }
        if !late.is_empty() {
            let late = late.len();
            notes.push(format!(
                "strokes that did not happen, since they come after the last of {iterations} iterations: {late}"
            ));
        }
        notes
    }

    /// All strokes that happen before a step.
    pub(crate) fn change(&self, step: u64, snapshot: &mut Snapshot) -> Result<(), Error> {
        self.script.before(step).iter().try_for_each(|edit| self.stroke(&edit.brush, snapshot))
    }

    /// Paints the weather, and what stands still, again as they were after `done` steps: a checkpoint does not
    /// hold them.
    pub(crate) fn catch_up(&self, done: u64, snapshot: &mut Snapshot) -> Result<(), Error> {
        let weather = |effect: &Effect| {
            matches!(effect, Effect::Source { .. } | Effect::Drain { .. } | Effect::Rain { .. })
        };
        let stays = |edit: &&Edit| weather(&edit.brush.effect) || stills(&edit.brush.effect);
        let earlier = self.script.edits().iter().filter(|edit| edit.step < done);
        earlier.filter(stays).try_for_each(|edit| self.stroke(&edit.brush, snapshot))
    }

    /// One stroke.
    pub(crate) fn stroke(&self, brush: &Brush, snapshot: &mut Snapshot) -> Result<(), Error> {
        check_stroke(brush, self.place.ring > 0).map_err(Error::Run)?;
        let Some(area) = brush.area(self.place.size, self.place.cell) else { return Ok(()) };
        let before = self.canvas(area, &snapshot.state);
        let mut after = before.clone();
        brush.paint(&mut after)?;
        self.take_back(&before, &after, snapshot);
        if before.frozen != after.frozen {
            self.freeze(&after, &mut snapshot.state);
        }
        Ok(())
    }

    /// The whole of the landscape.
    pub(crate) fn whole(&self) -> Area {
        Area { first: [0, 0], size: self.place.size }
    }

    /// A rectangle of the state, in metres.
    pub(crate) fn canvas(&self, area: Area, state: &Rows) -> Canvas {
        let Place { cell, lowest, ref valid, column, .. } = self.place;
        let base = column.planes.count();
        let metres =
            |plane: usize| self.cut(area, |x, y| (f64::from(state.plane(y, plane)[x]) * cell) as f32);
        let height = |x: usize, y: usize| {
            let [base, change] = [base, plane::CHANGE].map(|plane| f64::from(state.plane(y, plane)[x]));
            (lowest + (base + change) * cell) as f32
        };
        let [rain, source] = weather_of(state);
        let open = valid.as_ref().map(|valid| {
            let rows = area.first[1]..area.first[1] + area.size.rows;
            let columns = area.first[0]..area.first[0] + area.size.columns;
            rows.flat_map(|y| columns.clone().map(move |x| valid.is_valid(x, y))).collect()
        });
        Canvas {
            first: area.first,
            cell,
            materials: self.materials.clone(),
            valid: open.and_then(|open| Mask::new(area.size, open)),
            bedrock: self.cut(area, height),
            thickness: (1..column.planes.materials)
                .map(|material| metres(column.planes.of(material)))
                .collect(),
            water: metres(plane::DEPTH),
            source: metres(source),
            rain: self.cut(area, |x, y| state.plane(y, rain)[x]),
            frozen: self.frozen(area, state),
        }
    }

    /// Where cells that take part stand still.
    fn frozen(&self, area: Area, state: &Rows) -> Field {
        let Place { ref valid, column, ring, .. } = self.place;
        let Some(masked) = mask_plane(column, state) else { return Field::filled(area.size, 0.0) };
        self.cut(area, |x, y| {
            let takes_part = valid.as_ref().is_none_or(|valid| valid.is_valid(x - ring, y - ring));
            f32::from(u8::from(takes_part && state.plane(y, masked)[x] == 0.0))
        })
    }

    /// Puts walls around what stands still, and takes them away from what does not.
    fn freeze(&self, after: &Canvas, state: &mut Rows) {
        let Place { ref valid, column, .. } = self.place;
        let masked = mask_plane(column, state).expect("a grid with edits has a mask");
        let columns = state.layout.columns;
        let mut flags: Vec<_> = state.gather(masked).into_iter().map(|valid| valid > 0.0).collect();
        for y in 0..after.frozen.size().rows {
            for (x, &frozen) in after.frozen.row(y).iter().enumerate() {
                let [x, y] = [after.first[0] + x, after.first[1] + y];
                let takes_part = valid.as_ref().is_none_or(|valid| valid.is_valid(x, y));
                flags[y * columns + x] = takes_part && frozen == 0.0;
            }
        }
        let mask = Mask::always(Size { columns, rows: state.count() }, flags);
        for (at, plane) in mask_planes(&mask, false).iter().enumerate() {
            state.scatter(masked + at, plane);
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

/// Complains of the first edit that a simulation cannot follow.
pub(super) fn check(script: &Script, open: bool) -> Result<(), String> {
    script.edits().iter().try_for_each(|Edit { step, brush }| {
        check_stroke(brush, open).map_err(|what| format!("before step {step} {what}"))
    })
}

/// What stands still has walls, and where the border is open water would fall through them.
fn check_stroke(brush: &Brush, open: bool) -> Result<(), String> {
    if open && stills(&brush.effect) {
        return Err(
            "a stroke freezes or thaws ground, which needs boundary = \"closed\" in the step; it is \
                    \"open\""
                .to_owned(),
        );
    }
    Ok(())
}

/// Whether a stroke makes ground stand still, or ends it.
fn stills(effect: &Effect) -> bool {
    matches!(effect, Effect::Freeze | Effect::Thaw)
}

/// The first of the planes of the mask, where the world has them: behind the ground of the start.
fn mask_plane(column: Column, state: &Rows) -> Option<usize> {
    let first = column.planes.count() + 1;
    (state.layout.planes >= first + MASK_PLANES + WEATHER_PLANES).then_some(first)
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
