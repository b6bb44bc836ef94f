//! The surface of standing and running water over a mesh of the ground.
//!
//! The sheet covers the wet cells and the ring of cells around them. There it goes on at the level of the water beside
//! it, under the bank, so that the shore is where the two surfaces meet and not a stair of cells.

use super::surface::Surface;
use weald_core::connected::components;
use weald_core::domain::Domain;
use weald_core::grid::{Field, Mask};
use weald_core::landscape::Landscape;

/// Fewer connected cells than this are a puddle, which is left out.
const SMALLEST: usize = 4;

/// A sheet of water.
#[derive(Debug)]
pub(super) struct Water {
    /// Height of the surface in metres; of no meaning where there is no sheet.
    pub level: Field,
    /// Where the sheet is.
    pub(super) sheet: Mask,
}

impl Water {
    /// The water that is at least `shallowest` metres deep: of the layer `water`, or else of the lakes that the step
    /// `lakes` found. `None` where there is none.
    pub(super) fn of(landscape: &Landscape, ground: &Field, shallowest: f32) -> Option<Self> {
        let depth = landscape.field("water").or_else(|_| landscape.field("lake_depth")).ok()?;
        let domain = &landscape.domain;
        let is_valid = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let is_wet = |(cell, &depth): (usize, &f32)| depth >= shallowest && is_valid(cell);
        let mut wet: Vec<_> = depth.values().iter().enumerate().map(is_wet).collect();
        drop_puddles(&mut wet, domain);
        wet.contains(&true).then(|| Self::over(ground, depth, &wet, domain))
    }

    fn over(ground: &Field, depth: &Field, wet: &[bool], domain: &Domain) -> Self {
        let size = domain.size;
        let mut level = ground.clone();
        for (level, depth) in level.values_mut().iter_mut().zip(depth.values()) {
            *level += depth;
        }
        let mut sheet = wet.to_vec();
        let is_valid = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        for cell in (0..size.cells()).filter(|&cell| !wet[cell] && is_valid(cell)) {
            let beside = size.neighbours(cell).filter(|&other| wet[other]);
            let levels = beside.map(|other| ground.values()[other] + depth.values()[other]);
            if let Some(lowest) = levels.min_by(f32::total_cmp) {
                sheet[cell] = true;
                // Where the ground falls away from water, the sheet comes down to it.
                level.values_mut()[cell] = level.values()[cell].min(lowest);
            }
        }
        Self { level, sheet: Mask::always(size, sheet) }
    }

    /// The ground, to be followed to `error` metres, and beside water closely enough to stay on its side of it.
    pub(super) fn spared<'a>(&self, ground: &'a Field, valid: Option<&'a Mask>, error: f64) -> Surface<'a> {
        let bears = |cell: usize| {
            if !self.sheet.is_valid_at(cell) {
                return error;
            }
            let apart = f64::from(self.level.values()[cell]) - f64::from(ground.values()[cell]);
            (CLEARANCE * apart.abs()).clamp(STRICTEST * error, error)
        };
        Surface::bearing(ground, valid, bears)
    }
}

/// Share of the distance between ground and water by which the ground may be off.
const CLEARANCE: f64 = 0.5;

/// But no closer than this share of the error asked for.
const STRICTEST: f64 = 0.2;

fn drop_puddles(wet: &mut [bool], domain: &Domain) {
    let patches = components(domain.size, wet);
    for cell in patches.into_iter().filter(|patch| patch.len() < SMALLEST).flatten() {
        wet[cell] = false;
    }
}
