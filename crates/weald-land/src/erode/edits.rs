//! Strokes on a running simulation: a rectangle of its state becomes a canvas, is painted on, and goes back.
//!
//! What a stroke adds or takes counts into the sums of the run, water as rain and evaporation, ground as solid
//! that went out (below 0 where some came), so that the budget closes over it. Only cells that a stroke changed
//! get new values.

use super::links::mask_planes;
use super::material_planes::WEATHER_PLANES;
use super::painted_mask::{MaskBefore, PaintedMask};
use super::stack::Column;
use super::sums;
use super::water_planes as plane;
use super::working::WorkingGrid;
use crate::edit::{Area, Brush, Canvas, Effect};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_engine::device::Window;
use weald_engine::patch::{Patch, Patched};
use weald_engine::stencil::chain::Process;
use weald_engine::stencil::rows::Rows;

/// What was there before a stroke.
#[derive(Clone, Debug)]
pub(crate) enum Before {
    /// It touched nothing.
    Nothing,
    /// A part of the state.
    State(Patch),
    /// A part of the mask.
    Mask(MaskBefore),
}

/// Where a state lies on the landscape, and what its planes are.
pub(crate) struct Place {
    /// Name of the process, for errors.
    name: &'static str,
    /// Columns and rows of the landscape, without the ring.
    size: Size,
    ring: usize,
    cell: f64,
    /// Height from which the ground counts, in metres.
    lowest: f64,
    /// Cells that take part, without the ring.
    valid: Option<Mask>,
    /// Names of the materials that it tells apart, bedrock first.
    materials: Vec<String>,
    planes: PaintedPlanes,
}

/// What can be painted, by its planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PaintedPlanes {
    pub(crate) column: Column,
    /// Depth of the water.
    pub(crate) water: Option<usize>,
    /// The first of the planes of the mask.
    pub(crate) mask: Option<usize>,
    /// The first of the [`WEATHER_PLANES`].
    pub(crate) weather: Option<usize>,
}

impl PaintedPlanes {
    /// Those of a process whose constant planes begin with the ground, and the mask where there is one.
    pub(crate) fn of<P: Process>(process: &P, column: Column, working: &WorkingGrid) -> Self {
        let mask = working.mask.as_ref().map(|_| process.state_planes() + 1);
        Self { column, water: None, mask, weather: None }
    }

    /// The planes of the rain and of the sources, which are the first and the last of the weather.
    fn rain_and_source(self) -> Option<[usize; 2]> {
        self.weather.map(|first| [first, first + WEATHER_PLANES - 1])
    }
}

impl Place {
    pub(crate) fn of(
        name: &'static str,
        working: &WorkingGrid,
        materials: Vec<String>,
        planes: PaintedPlanes,
    ) -> Self {
        let size = working.start.size();
        let cells = (0..size.rows).flat_map(|y| (0..size.columns).map(move |x| working.place(x, y)));
        let takes_part = |mask: &Mask| cells.map(|at| at.is_some_and(|at| mask.is_valid_at(at))).collect();
        let valid = working.mask.as_ref().and_then(|mask| Mask::new(size, takes_part(mask)));
        let (ring, cell, lowest) = (working.ring, working.cell, working.lowest);
        Self { name, size, ring, cell, lowest, valid, materials, planes }
    }

    /// Whether a stroke touches a cell of the landscape.
    pub(crate) fn is_touched_by(&self, brush: &Brush) -> bool {
        brush.area(self.size, self.cell).is_some()
    }

    /// Paints a stroke on a state, as far as the mask leaves it, or on the mask; gives what was there before.
    pub(crate) fn stroke(
        &self,
        brush: &Brush,
        state: &mut dyn Patched,
        mask: &mut PaintedMask,
    ) -> Result<Before, Error> {
        self.check(brush).map_err(Error::Run)?;
        let Some(area) = brush.area(self.size, self.cell) else { return Ok(Before::Nothing) };
        if brush.effect.masks() {
            return self.paint_mask(brush, mask);
        }
        let before = state.patch(&self.window(area, brush))?;
        let canvas = Canvas { mask: mask.part(area), ..self.canvas_of(area, &before) };
        let mut painted = canvas.clone();
        brush.paint(&mut painted)?;
        let mut after = before.clone();
        self.take_over([&canvas, &painted], &mut after);
        if canvas.frozen != painted.frozen {
            self.freeze(&painted, &mut after);
        }
        let changed = before.differs(&after);
        state.lay(&after.only(&changed))?;
        Ok(Before::State(before.only(&changed)))
    }

    /// Paints a stroke of the mask on that alone.
    pub(crate) fn paint_mask(&self, brush: &Brush, mask: &mut PaintedMask) -> Result<Before, Error> {
        let Some(area) = brush.area(self.size, self.cell) else { return Ok(Before::Nothing) };
        mask.stroke(brush, (self.size, self.cell), (area, self.open(area))).map(Before::Mask)
    }

    /// A rectangle of the state, in metres.
    pub(crate) fn canvas(
        &self,
        area: Area,
        state: &mut dyn Patched,
        mask: &PaintedMask,
    ) -> Result<Canvas, Error> {
        let last = [area.first[0] + area.size.columns, area.first[1] + area.size.rows];
        if last[0] > self.size.columns || last[1] > self.size.rows {
            let [x, y] = area.first;
            let Size { columns, rows } = self.size;
            let size = area.size;
            let message =
                format!("{size} cells from column {x}, row {y} on are not within {columns} × {rows}");
            return Err(Error::Run(message));
        }
        let canvas = self.canvas_of(area, &state.patch(&self.cells(area, 0))?);
        Ok(Canvas { mask: mask.part(area), ..canvas })
    }

    /// Cells of the state that a stroke reads: those of walls depend on their neighbours.
    fn window(&self, area: Area, brush: &Brush) -> Window {
        self.cells(area, if stills(&brush.effect) { 2 } else { 0 })
    }

    fn cells(&self, area: Area, margin: usize) -> Window {
        let side = |first: usize, length: usize, whole: usize| {
            let (first, end) = (first + self.ring, first + length + self.ring);
            first.saturating_sub(margin)..(end + margin).min(whole + 2 * self.ring)
        };
        Window {
            columns: side(area.first[0], area.size.columns, self.size.columns),
            rows: side(area.first[1], area.size.rows, self.size.rows),
        }
    }

    /// Column and row of a patch at which an area begins.
    fn corner(&self, area: Area, patch: &Patch) -> [usize; 2] {
        let [left, top] = area.first.map(|first| first + self.ring);
        [left - patch.window.columns.start, top - patch.window.rows.start]
    }

    fn canvas_of(&self, area: Area, patch: &Patch) -> Canvas {
        let PaintedPlanes { column, water, .. } = self.planes;
        let (rows, cell) = (&patch.rows, self.cell);
        let [left, top] = self.corner(area, patch);
        let cut = |value: &dyn Fn(usize, usize) -> f32| {
            Field::from_function(area.size, |x, y| value(left + x, top + y))
        };
        let plane =
            |plane: usize, factor: f64| cut(&|x, y| (f64::from(rows.plane(y, plane)[x]) * factor) as f32);
        let or = |given: Option<usize>, factor: f64, otherwise: f32| {
            given.map_or_else(|| Field::filled(area.size, otherwise), |at| plane(at, factor))
        };
        let base = column.planes.count();
        let height = |x: usize, y: usize| {
            let [base, change] = [base, plane::CHANGE].map(|plane| f64::from(rows.plane(y, plane)[x]));
            (self.lowest + (base + change) * cell) as f32
        };
        let weather = self.planes.rain_and_source();
        Canvas {
            first: area.first,
            cell,
            materials: self.materials.clone(),
            valid: self.open(area),
            bedrock: cut(&height),
            thickness: (1..column.planes.materials).map(|at| plane(column.planes.of(at), cell)).collect(),
            water: or(water, cell, 0.0),
            source: or(weather.map(|[_, source]| source), cell, 0.0),
            rain: or(weather.map(|[rain, _]| rain), 1.0, 1.0),
            frozen: self.frozen(area, patch),
            mask: Field::filled(area.size, 0.0),
        }
    }

    /// Cells of an area that a brush may change.
    fn open(&self, area: Area) -> Option<Mask> {
        let valid = self.valid.as_ref()?;
        let rows = area.first[1]..area.first[1] + area.size.rows;
        let columns = area.first[0]..area.first[0] + area.size.columns;
        Mask::new(area.size, rows.flat_map(|y| columns.clone().map(move |x| valid.is_valid(x, y))).collect())
    }

    /// Whether a cell of the landscape is simulated.
    fn takes_part(&self, x: usize, y: usize) -> bool {
        self.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y))
    }

    /// Where cells that take part stand still.
    fn frozen(&self, area: Area, patch: &Patch) -> Field {
        let [left, top] = self.corner(area, patch);
        Field::from_function(area.size, |x, y| {
            let masked =
                self.planes.mask.is_some_and(|mask| patch.rows.plane(top + y, mask)[left + x] == 0.0);
            let frozen = masked && self.takes_part(area.first[0] + x, area.first[1] + y);
            f32::from(u8::from(frozen))
        })
    }

    /// Puts walls around what stands still, and takes them away from what does not.
    fn freeze(&self, after: &Canvas, patch: &mut Patch) {
        let Some(masked) = self.planes.mask else { return };
        let size = patch.window.size();
        let mut flags: Vec<_> = patch.rows.gather(masked).into_iter().map(|valid| valid > 0.0).collect();
        let [left, top] = self.corner(after.area(), patch);
        for y in 0..after.frozen.size().rows {
            for (x, &frozen) in after.frozen.row(y).iter().enumerate() {
                let takes_part = self.takes_part(after.first[0] + x, after.first[1] + y);
                flags[size.index(left + x, top + y)] = takes_part && frozen == 0.0;
            }
        }
        let inner = self.known_walls(&patch.window);
        let mask = Mask::always(size, flags);
        for (at, plane) in mask_planes(&mask, false).iter().enumerate() {
            for y in inner.rows.clone() {
                let cells = &plane[y * size.columns..][inner.columns.clone()];
                patch.rows.plane_mut(y, masked + at)[inner.columns.clone()].copy_from_slice(cells);
            }
        }
    }

    /// Cells of a patch all of whose neighbours it holds, or that lie at the edge of the whole.
    fn known_walls(&self, window: &Window) -> Window {
        let inner = |range: &std::ops::Range<usize>, whole: usize| {
            let first = usize::from(range.start > 0);
            first..range.len() - usize::from(range.end < whole + 2 * self.ring)
        };
        Window {
            columns: inner(&window.columns, self.size.columns),
            rows: inner(&window.rows, self.size.rows),
        }
    }

    /// Gives a patch what a stroke changed.
    fn take_over(&self, [before, after]: [&Canvas; 2], patch: &mut Patch) {
        let PaintedPlanes { column, water, .. } = self.planes;
        let cell = self.cell;
        let whole = |_: f32, _: f32, new: f32| (f64::from(new) / cell) as f32;
        let share = |_: f32, _: f32, new: f32| new;
        // Of a high mountain the change alone has the digits of what was added.
        let change =
            |now: f32, old: f32, new: f32| (f64::from(now) + (f64::from(new) - f64::from(old)) / cell) as f32;
        let corner = self.corner(before.area(), patch);
        let solid = (0..column.planes.materials).map(|material| column.planes.of(material));
        for ((plane, (_, old)), (_, new)) in solid.zip(before.fields()).zip(after.fields()) {
            let value: &dyn Fn(f32, f32, f32) -> f32 = if plane == plane::CHANGE { &change } else { &whole };
            let moved = Painted { corner, plane, old, new }.lay(&mut patch.rows, value);
            patch.sums[sums::SEDIMENT_OUT] -= moved[0] + moved[1];
        }
        if let Some(plane) = water {
            let moved =
                Painted { corner, plane, old: &before.water, new: &after.water }.lay(&mut patch.rows, &whole);
            patch.sums[sums::RAINED] += moved[0];
            patch.sums[sums::EVAPORATED] += moved[1];
        }
        if let Some([rain, source]) = self.planes.rain_and_source() {
            Painted { corner, plane: source, old: &before.source, new: &after.source }
                .lay(&mut patch.rows, &whole);
            Painted { corner, plane: rain, old: &before.rain, new: &after.rain }.lay(&mut patch.rows, &share);
        }
    }

    /// Complains of a stroke that the simulation cannot follow.
    pub(crate) fn check(&self, brush: &Brush) -> Result<(), String> {
        check_stroke(brush, self.ring > 0)?;
        let (name, planes) = (self.name, &self.planes);
        let missing = match brush.effect {
            Effect::AddWater { .. } | Effect::RemoveWater { .. } if planes.water.is_none() => "water",
            Effect::Source { .. } | Effect::Drain { .. } if planes.weather.is_none() => "painted springs",
            Effect::Rain { .. } if planes.weather.is_none() => "painted rain",
            Effect::Freeze | Effect::Thaw if planes.mask.is_none() => "ground that stands still",
            _ => return Ok(()),
        };
        Err(format!("`{name}` knows no {missing}, so that this stroke has nothing to paint on"))
    }
}

/// What stands still has walls, and where the border is open water would fall through them.
pub(super) fn check_stroke(brush: &Brush, open: bool) -> Result<(), String> {
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
pub(super) fn stills(effect: &Effect) -> bool {
    matches!(effect, Effect::Freeze | Effect::Thaw)
}

/// A field before and after a stroke, and the plane that it came from.
struct Painted<'a> {
    /// Column and row of the patch at which the fields begin.
    corner: [usize; 2],
    plane: usize,
    old: &'a Field,
    new: &'a Field,
}

impl Painted<'_> {
    /// Sets the cells that differ; gives what they gained and, below 0, what they lost.
    fn lay(&self, state: &mut Rows, value: &dyn Fn(f32, f32, f32) -> f32) -> [f64; 2] {
        let [left, top] = self.corner;
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
