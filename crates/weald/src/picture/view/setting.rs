//! A landscape made ready for a view: surfaces, water, limits of the kinds of ground.

use super::View;
use super::cover::Limits;
use super::side::Strata;
use super::site::{Sites, names_materials};
use super::surface::Surface;
use super::terrain::Terrain;
use super::water::{self, Rivers};
use crate::error::Error;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::material::stack;
use crate::picture::colour::linear_of_srgb;
use crate::picture::ground::{drawable, land_share};
use crate::picture::sheet::Sheet;

/// Longest side of the surfaces, in cells.
const LONGEST: u32 = 4096;

/// Depth of the base below the lowest ground, as a share of the landscape's width.
const BASE: f32 = 0.035;

/// Share of the land that is less steep than bare rock, and the bounds of that slope in degrees.
const BELOW_ROCK: f64 = 0.90;
const ROCK_DEG: [f64; 2] = [30.0, 42.0];

/// Share of the relief up to which trees grow.
const TREES: f64 = 0.55;

/// All of a landscape that light can fall on. Heights are above the lowest ground, times the exaggeration.
#[derive(Debug)]
pub(super) struct Setting {
    pub(super) terrain: Terrain,
    /// The ground itself, under the water.
    pub(super) bed: Surface,
    /// Levels of lakes, below the ground where it is dry.
    pub(super) level: Option<Surface>,
    pub(super) rivers: Option<Rivers>,
    pub(super) strata: Strata,
    pub(super) limits: Limits,
    pub(super) exaggeration: f32,
}

impl Setting {
    pub(super) fn new(view: &View, landscape: &Landscape) -> Result<(Self, Sites), Error> {
        let domain = &landscape.domain;
        let longer = domain.size.columns.max(domain.size.rows) as u32;
        let width =
            (u64::from(longer.min(LONGEST)) * domain.size.columns as u64 / u64::from(longer)).max(1) as u32;
        let sheet = Sheet::new(domain, Some(width))?;
        let mask = domain.land.as_ref();
        let field = landscape.field(&view.of.0)?;
        let (low, high) = field.range(mask).unwrap_or((0.0, 0.0));
        let exaggeration = view.exaggeration as f32;
        let raised = |mut field: Field| {
            field.values_mut().iter_mut().for_each(|height| *height = (*height - low) * exaggeration);
            field
        };
        let level = if view.water { water::levels(landscape, field) } else { None };
        let ground = raised(drawable(field, mask, &sheet));
        let level = level.map(|level| raised(drawable(&level, mask, &sheet)));
        let top = level.as_ref().map_or_else(|| ground.clone(), |level| higher(&ground, level));
        let size = ground.size();
        let spacing = [
            (domain.cell * domain.size.columns as f64 / size.columns as f64) as f32,
            (domain.cell * domain.size.rows as f64 / size.rows as f64) as f32,
        ];
        let extent = (domain.cell * longer as f64) as f32;
        let land = land_share(mask, &sheet).map(|land| Surface::new(&land));
        let terrain = Terrain::new(spacing, Surface::new(&top), land, -BASE * extent);
        let materials =
            view.ground.map_or_else(|| names_materials(landscape), |cover| cover == super::Cover::Materials);
        let relief = high - low;
        let limits = Limits {
            rock: rock_slope(view, &ground, spacing, exaggeration),
            trees: view.tree_line.map_or(TREES * f64::from(relief), |line| line - f64::from(low)) as f32,
            snow: view.snow_line.map_or(f64::INFINITY, |line| line - f64::from(low)) as f32,
            relief,
            cell: spacing[0].min(spacing[1]),
        };
        let sites = Sites::new(landscape, field, &sheet, materials)?;
        let setting = Self {
            terrain,
            level: level.as_ref().map(Surface::new),
            rivers: if view.water { Rivers::of(landscape, view.river_width) } else { None },
            strata: strata(landscape, field, &sheet, relief + BASE * extent / exaggeration)?,
            bed: Surface::new(&ground),
            limits,
            exaggeration,
        };
        Ok((setting, sites))
    }

    /// Whether anything is land at all.
    pub(super) fn has_land(landscape: &Landscape) -> bool {
        landscape.domain.land_cells() > 0
    }
}

fn higher(a: &Field, b: &Field) -> Field {
    Field::from_values(a.size(), a.values().iter().zip(b.values()).map(|(a, b)| a.max(*b)).collect())
}

fn strata(landscape: &Landscape, ground: &Field, sheet: &Sheet, relief: f32) -> Result<Strata, Error> {
    let mask = landscape.domain.land.as_ref();
    let bedrock = landscape.materials.first().map_or([0.2; 3], |material| linear_of_srgb(material.colour));
    if !names_materials(landscape) {
        return Ok(Strata::new(Vec::new(), bedrock, relief));
    }
    let layers = stack(landscape, ground)?;
    let materials = layers.iter().zip(&landscape.materials[1..]).map(|(thickness, material)| {
        (Surface::new(&drawable(thickness, mask, sheet)), linear_of_srgb(material.colour))
    });
    Ok(Strata::new(materials.collect(), bedrock, relief))
}

/// Rise over run from which rock is bare.
fn rock_slope(view: &View, ground: &Field, spacing: [f32; 2], exaggeration: f32) -> f32 {
    if let Some(degrees) = view.rock_deg {
        return libm::tan(degrees.to_radians()) as f32;
    }
    let size = ground.size();
    let slope = |x: usize, y: usize| {
        let east = (ground.at((x + 1).min(size.columns - 1), y) - ground.at(x, y)) / spacing[0];
        let south = (ground.at(x, (y + 1).min(size.rows - 1)) - ground.at(x, y)) / spacing[1];
        (east * east + south * south).sqrt() / exaggeration
    };
    let mut slopes: Vec<f32> =
        (0..size.cells()).map(|cell| slope(cell % size.columns, cell / size.columns)).collect();
    slopes.sort_unstable_by(f32::total_cmp);
    let steep = slopes[((slopes.len() - 1) as f64 * BELOW_ROCK) as usize];
    let [low, high] = ROCK_DEG.map(|degrees| libm::tan(degrees.to_radians()) as f32);
    steep.clamp(low, high)
}
