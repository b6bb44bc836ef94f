//! What the effects of a brush do to a canvas.

use super::brush::{Brush, Effect};
use super::canvas::Canvas;
use super::keys::MAX_PLACES;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::material::BEDROCK;

/// What a stroke added and took away, in cubic metres, for the budget of a simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Volumes {
    /// Ground added.
    pub solid_added: f64,
    /// Ground taken away.
    pub solid_removed: f64,
    /// Water added.
    pub water_added: f64,
    /// Water taken away.
    pub water_removed: f64,
}

impl Volumes {
    fn solid(&mut self, change: f64) {
        *(if change > 0.0 { &mut self.solid_added } else { &mut self.solid_removed }) += change.abs();
    }

    fn water(&mut self, change: f64) {
        *(if change > 0.0 { &mut self.water_added } else { &mut self.water_removed }) += change.abs();
    }

    fn of_cells(self, area: f64) -> Self {
        Self {
            solid_added: self.solid_added * area,
            solid_removed: self.solid_removed * area,
            water_added: self.water_added * area,
            water_removed: self.water_removed * area,
        }
    }
}

impl Brush {
    /// Changes a canvas. Cells beyond it are left out; [`Brush::area`] says how much of a landscape the canvas
    /// must hold for the same bits as on the whole.
    ///
    /// # Errors
    /// [`Error::Run`] for a stroke that is none, and for a material that the canvas does not have; the canvas
    /// is then as it was.
    pub fn paint(&self, canvas: &mut Canvas) -> Result<Volumes, Error> {
        if let Some(fault) = self.fault() {
            return Err(Error::Run(format!("a brush cannot paint: {fault}")));
        }
        let touched = self.touched(canvas);
        let mut volumes = Volumes::default();
        match &self.effect {
            Effect::Add { material, thickness } => {
                let mut layer = layer(canvas, material)?;
                lay(&mut layer, &touched, *thickness, &mut volumes);
            }
            Effect::Remove { material, thickness } => {
                let mut layer = layer(canvas, material)?;
                lay(&mut layer, &touched, -thickness, &mut volumes);
            }
            Effect::AddWater { depth } => pour(&mut canvas.water, &touched, *depth, &mut volumes),
            Effect::RemoveWater { depth } => pour(&mut canvas.water, &touched, -depth, &mut volumes),
            Effect::Smooth { times } => (0..*times).for_each(|_| smooth(canvas, &touched, &mut volumes)),
            Effect::Flatten { height } => flatten(canvas, &touched, *height, &mut volumes),
            Effect::Source { rate } => blend(&mut canvas.source, &touched, *rate),
            Effect::Drain { rate } => blend(&mut canvas.source, &touched, -rate),
            Effect::Rain { factor } => blend(&mut canvas.rain, &touched, *factor),
            Effect::Freeze => hold(&mut canvas.frozen, &touched, 1.0),
            Effect::Thaw => hold(&mut canvas.frozen, &touched, 0.0),
            Effect::Mask => blend(&mut canvas.mask, &touched, 1.0),
            Effect::Unmask => blend(&mut canvas.mask, &touched, 0.0),
        }
        Ok(volumes.of_cells(canvas.cell * canvas.cell))
    }

    /// Brings a field over a whole landscape towards a value, by the weight of the stroke.
    pub(super) fn blend_into(&self, field: &mut Field, cell: f64, goal: f64) {
        let Some(area) = self.area(field.size(), cell) else { return };
        let weights = self.weights(&Canvas::level(area, cell, &[]));
        for (place, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
            let (x, y) = (place % area.size.columns, place / area.size.columns);
            let value = &mut field.row_mut(area.first[1] + y)[area.first[0] + x];
            *value = (f64::from(*value) * (1.0 - weight) + goal * weight) as f32;
        }
    }

    /// The cells that the stroke changes, with its weight in each: what the mask leaves of it.
    fn touched(&self, canvas: &Canvas) -> Vec<(usize, f64)> {
        let mask = (!self.effect.masks()).then(|| canvas.mask.values());
        let left = |cell: usize| mask.map_or(1.0, |mask| 1.0 - f64::from(mask[cell]));
        let weights = self.weights(canvas).into_iter().enumerate();
        let weights = weights.map(|(cell, weight)| (cell, weight * left(cell)));
        weights.filter(|&(cell, weight)| weight > 0.0 && canvas.is_open(cell)).collect()
    }

    /// What makes it no stroke, if anything.
    fn fault(&self) -> Option<String> {
        let places = self.path.len();
        if !(1..=MAX_PLACES).contains(&places) {
            return Some(format!("it has {places} places; a stroke has 1 to {MAX_PLACES}"));
        }
        if let Some([x, y]) = self.path.iter().find(|place| !place.iter().all(|axis| axis.is_finite())) {
            return Some(format!("its place {x}, {y} is nowhere"));
        }
        if !(self.radius.is_finite() && self.radius > 0.0) {
            return Some(format!("its radius is {} m; it must be above 0", self.radius));
        }
        if !(0.0..=1.0).contains(&self.strength) {
            return Some(format!("its strength is {}, outside 0 to 1", self.strength));
        }
        let (what, amount, signed) = self.effect.amount()?;
        let legal = amount.is_finite() && (signed || amount >= 0.0);
        (!legal).then(|| {
            format!(
                "its {what} is {amount}; it must be finite{}",
                if signed { "" } else { " and not below 0" }
            )
        })
    }
}

impl Effect {
    /// The number that says how much, and whether it may be below 0.
    fn amount(&self) -> Option<(&'static str, f64, bool)> {
        match *self {
            Self::Add { thickness, .. } | Self::Remove { thickness, .. } => {
                Some(("thickness", thickness, false))
            }
            Self::AddWater { depth } | Self::RemoveWater { depth } => Some(("depth", depth, false)),
            Self::Flatten { height } => Some(("height", height, true)),
            Self::Source { rate } | Self::Drain { rate } => Some(("rate", rate, false)),
            Self::Rain { factor } => Some(("factor", factor, false)),
            Self::Smooth { .. } | Self::Freeze | Self::Thaw | Self::Mask | Self::Unmask => None,
        }
    }
}

/// A layer of the ground, and the least that it can hold.
struct Ground<'a> {
    field: &'a mut Field,
    least: f64,
}

fn layer<'a>(canvas: &'a mut Canvas, name: &str) -> Result<Ground<'a>, Error> {
    let place = canvas.materials.iter().position(|material| material == name);
    match place.or((name == BEDROCK).then_some(0)) {
        Some(0) => Ok(Ground { field: &mut canvas.bedrock, least: f64::NEG_INFINITY }),
        Some(place) => Ok(Ground { field: &mut canvas.thickness[place - 1], least: 0.0 }),
        None => Err(Error::Run(format!(
            "a brush names the material `{name}`; the ground is of: {}",
            canvas.materials.join(", ")
        ))),
    }
}

/// Adds to a value, which stays at `least` or above, and gives the change that came of it.
fn add(value: &mut f32, amount: f64, least: f64) -> f64 {
    let old = f64::from(*value);
    *value = (old + amount).max(least) as f32;
    f64::from(*value) - old
}

fn lay(layer: &mut Ground<'_>, touched: &[(usize, f64)], amount: f64, volumes: &mut Volumes) {
    for &(cell, weight) in touched {
        volumes.solid(add(&mut layer.field.values_mut()[cell], weight * amount, layer.least));
    }
}

fn pour(water: &mut Field, touched: &[(usize, f64)], amount: f64, volumes: &mut Volumes) {
    for &(cell, weight) in touched {
        volumes.water(add(&mut water.values_mut()[cell], weight * amount, 0.0));
    }
}

/// Brings a field towards a value.
fn blend(field: &mut Field, touched: &[(usize, f64)], goal: f64) {
    for &(cell, weight) in touched {
        let value = &mut field.values_mut()[cell];
        *value = (f64::from(*value) * (1.0 - weight) + goal * weight) as f32;
    }
}

/// A cell stands still or it does not: there is nothing in between.
fn hold(frozen: &mut Field, touched: &[(usize, f64)], value: f32) {
    for &(cell, _) in touched.iter().filter(|&&(_, weight)| weight >= 0.5) {
        frozen.values_mut()[cell] = value;
    }
}

fn flatten(canvas: &mut Canvas, touched: &[(usize, f64)], height: f64, volumes: &mut Volumes) {
    for &(cell, weight) in touched {
        let rise = weight * (height - canvas.surface(cell));
        raise(canvas, cell, rise, volumes);
    }
}

fn smooth(canvas: &mut Canvas, touched: &[(usize, f64)], volumes: &mut Volumes) {
    let rise = |&(cell, weight): &(usize, f64)| weight * (mean_around(canvas, cell) - canvas.surface(cell));
    // All rises are those of the ground before any of them.
    let rises: Vec<f64> = touched.iter().map(rise).collect();
    for (&(cell, _), rise) in touched.iter().zip(rises) {
        raise(canvas, cell, rise, volumes);
    }
}

/// Mean height of the ground in the cell and its up to eight open neighbours.
fn mean_around(canvas: &Canvas, cell: usize) -> f64 {
    let (mut sum, mut count) = (canvas.surface(cell), 1.0);
    for neighbour in canvas.size().neighbours(cell).filter(|&neighbour| canvas.is_open(neighbour)) {
        sum += canvas.surface(neighbour);
        count += 1.0;
    }
    sum / count
}

/// Raises the ground by giving to its topmost material, or lowers it by taking from there downward.
fn raise(canvas: &mut Canvas, cell: usize, rise: f64, volumes: &mut Volumes) {
    let mut left = rise;
    for layer in canvas.thickness.iter_mut().rev().map(|layer| &mut layer.values_mut()[cell]) {
        if *layer > 0.0 && left != 0.0 {
            let change = add(layer, left, 0.0);
            volumes.solid(change);
            // What rounding leaves of a gift is not for the layers below.
            left = if rise > 0.0 || *layer > 0.0 { 0.0 } else { left - change };
        }
    }
    if left != 0.0 {
        volumes.solid(add(&mut canvas.bedrock.values_mut()[cell], left, f64::NEG_INFINITY));
    }
}
