//! A landscape made ready for a view: surfaces, water, limits of the kinds of ground.

use std::sync::Arc;

use rayon::prelude::*;

use super::drawn_rivers::Rivers;
use super::flow::Flow;
use super::ground_kinds::Limits;
use super::keys::{GroundColour, View};
use super::refined::{Coarse, finer};
use super::side::Strata;
use super::site::{ColouredBy, Sites, names_materials};
use super::surface::Surface;
use super::surroundings::Surroundings;
use super::terrain::Terrain;
use super::vector::Vector;
use super::water;
use crate::colour::linear_of_srgb;
use crate::ground::{drawable, land_share, within_rim};
use crate::sheet::Sheet;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::Nested;
use weald_core::strata::stack;

/// Longest side of the surfaces, in cells.
const LONGEST: u64 = 4096;

/// Depth of the base below the lowest ground, as a share of the landscape's width.
const BASE: f32 = 0.035;

/// Share of the land that is less steep than bare rock, and the bounds of that slope in degrees.
const BELOW_ROCK: f64 = 0.90;
const ROCK_DEG: [f64; 2] = [30.0, 42.0];

/// Least and most cells, along the longer side, for which the visible sky is known.
const SKY_CELLS: [usize; 2] = [512, 1024];

/// Share of the relief up to which trees grow.
const TREES: f32 = 0.6;

/// All of a landscape that light can fall on. Heights are above the lowest ground, times the exaggeration.
#[derive(Debug)]
pub(super) struct Setting {
    pub(super) terrain: Terrain,
    /// The ground itself, under the water.
    pub(super) bed: Arc<Surface>,
    /// Levels of lakes, below the ground where it is dry.
    pub level: Option<Surface>,
    pub(super) rivers: Option<Rivers>,
    /// How water runs.
    pub(super) flow: Option<Flow>,
    pub(super) strata: Arc<Strata>,
    pub(super) limits: Limits,
    pub(super) exaggeration: f32,
    /// Elevation of the lowest ground in metres.
    pub(super) low: f32,
    /// Height of the sea as it is drawn.
    pub(super) sea: Option<f32>,
    /// What is around the landscape; `None` where it is a block.
    pub(super) around: Option<Surroundings>,
    /// Whether crags stand on its ground.
    pub(super) has_crags: bool,
    /// Cells along the longer side of the landscape for which the visible sky is known.
    pub(super) sky_cells: usize,
}

impl Setting {
    /// The setting, and what its places are like.
    pub(super) fn new(
        view: &View,
        landscape: &Landscape,
        ground_of: GroundOf,
    ) -> Result<(Self, Sites), Error> {
        let domain = &landscape.domain;
        let field = landscape.field(&view.of.0)?;
        let (low, high) = field.range(domain.valid.as_ref()).unwrap_or((0.0, 0.0));
        let low = ground_of.from.unwrap_or(low);
        let frame = Frame::new(view, landscape, low)?;
        let level = if view.water { water::levels(landscape, field) } else { None };
        let (ground, level) = (frame.raised(field), level.map(|level| frame.raised(&level)));
        let has_horizon = view.has_horizon(domain);
        // A horizon has no holes before it: what fills them is drawn.
        let land = if has_horizon { None } else { land_share(domain.valid.as_ref(), &frame.sheet) };
        let sea = domain.sea_level.filter(|_| view.water).map(|sea| frame.drawn(sea));
        let spacing = frame.spacing(ground.size());
        let base = BASE * (domain.cell * domain.size.columns.max(domain.size.rows) as f64) as f32;
        let limits = limits(view, [low, high], &ground, spacing);
        let wished = view.ground.map(|colour| colour == GroundColour::Materials);
        let coloured_by = match &view.drape {
            Some(Nested(drape)) => ColouredBy::Drape(drape),
            None if wished.unwrap_or_else(|| names_materials(landscape)) => ColouredBy::Materials,
            None => ColouredBy::Natural,
        };
        let sites = Sites::new(landscape, field, &frame.sheet, (spacing, limits.rock), coloured_by)?;
        let flow =
            view.water.then(|| Flow::of(landscape, &higher(&ground, level.as_ref()), spacing, &frame.sheet));
        let coarse = Coarse {
            ground: &ground,
            level: level.as_ref(),
            spacing,
            limits,
            exaggeration: frame.exaggeration,
            is_material: matches!(coloured_by, ColouredBy::Materials),
        };
        let longer = ground.size().columns.max(ground.size().rows);
        let crags = if ground_of.has_crags { coarse.crags() } else { None };
        let forms = match crags {
            Some(crags) => Forms::refined(&coarse, &crags, land.as_ref()),
            None => Forms { ground, level, land, fineness: 1 },
        };
        let fineness = forms.fineness;
        let Surfaces { top, bed, level } = Surfaces::of(forms.ground, forms.level);
        let terrain = Terrain::new(spacing.map(|side| side / fineness as f32), top, forms.land, -base);
        let setting = Self {
            flow: flow.flatten().map(|flow| flow.on_finer(fineness)),
            terrain,
            level,
            rivers: if view.water { Rivers::of(landscape, view.river_width) } else { None },
            strata: Arc::new(
                strata(landscape, (field, low), &frame.sheet, limits.relief + base / frame.exaggeration)?
                    .on_finer(fineness),
            ),
            around: has_horizon.then(|| Surroundings::new(&bed, sea)),
            bed,
            limits,
            exaggeration: frame.exaggeration,
            low,
            sea,
            has_crags: ground_of.has_crags,
            sky_cells: longer.clamp(SKY_CELLS[0], SKY_CELLS[1]),
        };
        Ok((setting, sites.on_finer(fineness)))
    }

    /// The diagonal of the landscape in metres.
    pub(super) fn extent(&self) -> f32 {
        let (size, spacing) = (self.terrain.top.size(), self.terrain.spacing);
        let sides = [size.columns as f32 * spacing[0], size.rows as f32 * spacing[1]];
        (sides[0] * sides[0] + sides[1] * sides[1]).sqrt()
    }

    /// The point of the lowest height in the middle of the landscape.
    pub(super) fn centre(&self) -> Vector {
        let size = self.terrain.top.size();
        self.terrain.point([0.5 + 0.5 * size.columns as f32, 0.5 + 0.5 * size.rows as f32], 0.0)
    }
}

/// Which ground is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GroundOf {
    /// Elevation from which heights count; from the lowest ground where it is not given.
    pub(super) from: Option<f32>,
    /// Whether crags stand on what is steep; else the ground is as smooth as its cells.
    pub(super) has_crags: bool,
}

/// How fields become surfaces of the view.
struct Frame<'a> {
    domain: &'a Domain,
    sheet: Sheet,
    /// Cells whose heights are drawn.
    land: Option<Mask>,
    /// Lowest ground in metres.
    low: f32,
    exaggeration: f32,
}

impl<'a> Frame<'a> {
    fn new(view: &View, landscape: &'a Landscape, low: f32) -> Result<Self, Error> {
        let domain = &landscape.domain;
        let longer = domain.size.columns.max(domain.size.rows) as u64;
        let width = (longer.min(LONGEST) * domain.size.columns as u64 / longer).max(1);
        let valid = domain.valid.as_ref();
        // What goes on beyond a rim that stands over worn ground would be a wall of teeth.
        let land = if view.has_horizon(domain) { valid.map(within_rim) } else { valid.cloned() };
        Ok(Self {
            domain,
            sheet: Sheet::new(domain, Some(width as u32))?,
            land,
            low,
            exaggeration: view.exaggeration as f32,
        })
    }

    /// The height of an elevation in metres as it is drawn.
    fn drawn(&self, elevation: f64) -> f32 {
        (elevation - f64::from(self.low)) as f32 * self.exaggeration
    }

    /// Heights above the lowest ground as they are drawn, no finer than the sheet.
    fn raised(&self, field: &Field) -> Field {
        let mut field = drawable(field, self.land.as_ref(), &self.sheet);
        field.values_mut().iter_mut().for_each(|height| *height = (*height - self.low) * self.exaggeration);
        field
    }

    /// Sides of a cell of a drawn field in metres.
    fn spacing(&self, drawn: Size) -> [f32; 2] {
        let whole = self.domain.size;
        [whole.columns as f64 / drawn.columns as f64, whole.rows as f64 / drawn.rows as f64]
            .map(|cells| (cells * self.domain.cell) as f32)
    }
}

fn limits(view: &View, [low, high]: [f32; 2], ground: &Field, spacing: [f32; 2]) -> Limits {
    let relief = high - low;
    let above = |line: f64| (line - f64::from(low)) as f32;
    Limits {
        rock: rock_slope(view, ground, spacing),
        trees: view.tree_line.map_or(TREES * relief, above),
        woods: view.woods as f32,
        snow: view.snow_line.map_or(f32::INFINITY, above),
        relief,
        cell: spacing[0].min(spacing[1]),
    }
}

/// Heights of ground, water and land on the cells that are drawn.
struct Forms {
    ground: Field,
    level: Option<Field>,
    land: Option<Field>,
    /// How many of those cells lie along the side of one of the landscape.
    fineness: usize,
}

impl Forms {
    /// On finer cells, with such shares of crags.
    fn refined(coarse: &Coarse<'_>, (craggy, fineness): &(Field, usize), land: Option<&Field>) -> Self {
        let fineness = *fineness;
        Self {
            ground: coarse.refined(craggy, fineness),
            level: coarse.level.map(|level| finer(level, fineness)),
            land: land.map(|land| finer(land, fineness)),
            fineness,
        }
    }
}

/// Surfaces of ground and water. Where there is no water one surface serves as ground and as what light falls on.
struct Surfaces {
    top: Arc<Surface>,
    bed: Arc<Surface>,
    level: Option<Surface>,
}

impl Surfaces {
    /// The fields go as soon as their surfaces are there: of fine cells there are many.
    fn of(ground: Field, level: Option<Field>) -> Self {
        let of = |field: Field| Surface::new(&field);
        let Some(level) = level else {
            let bed = Arc::new(of(ground));
            return Self { top: Arc::clone(&bed), bed, level: None };
        };
        let top = Arc::new(of(higher(&ground, Some(&level))));
        Self { top, bed: Arc::new(of(ground)), level: Some(of(level)) }
    }
}

/// The ground, or the water on it.
fn higher(ground: &Field, level: Option<&Field>) -> Field {
    let Some(level) = level else { return ground.clone() };
    let top = ground.values().par_iter().zip(level.values()).map(|(ground, level)| ground.max(*level));
    Field::from_values(ground.size(), top.collect())
}

fn strata(
    landscape: &Landscape,
    (ground, low): (&Field, f32),
    sheet: &Sheet,
    relief: f32,
) -> Result<Strata, Error> {
    let mask = landscape.domain.valid.as_ref();
    let bedrock = landscape.materials.first().map_or([0.2; 3], |material| linear_of_srgb(material.colour));
    if !names_materials(landscape) {
        return Ok(Strata::new(Vec::new(), (bedrock, None), relief));
    }
    let layers = stack(landscape, ground)?;
    let materials = layers.iter().zip(&landscape.materials[1..]).map(|(thickness, material)| {
        (Surface::new(&drawable(thickness, mask, sheet)), linear_of_srgb(material.colour))
    });
    let mut floor = ground.clone();
    floor.values_mut().par_iter_mut().enumerate().for_each(|(cell, height)| {
        *height -= low + layers.iter().map(|layer| layer.values()[cell]).sum::<f32>();
    });
    let floor = Surface::new(&drawable(&floor, mask, sheet));
    Ok(Strata::new(materials.collect(), (bedrock, Some(floor)), relief))
}

/// Rise over run from which rock is bare.
fn rock_slope(view: &View, ground: &Field, spacing: [f32; 2]) -> f32 {
    if let Some(degrees) = view.rock_deg {
        return libm::tan(degrees.to_radians()) as f32;
    }
    let size = ground.size();
    let slope = |x: usize, y: usize| {
        let east = (ground.at((x + 1).min(size.columns - 1), y) - ground.at(x, y)) / spacing[0];
        let south = (ground.at(x, (y + 1).min(size.rows - 1)) - ground.at(x, y)) / spacing[1];
        (east * east + south * south).sqrt() / view.exaggeration as f32
    };
    let mut slopes: Vec<f32> =
        (0..size.cells()).map(|cell| slope(cell % size.columns, cell / size.columns)).collect();
    slopes.sort_unstable_by(f32::total_cmp);
    let steep = slopes[((slopes.len() - 1) as f64 * BELOW_ROCK) as usize];
    let [low, high] = ROCK_DEG.map(|degrees| libm::tan(degrees.to_radians()) as f32);
    steep.clamp(low, high)
}
