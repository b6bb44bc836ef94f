//! What the landscape says of each place: moisture, soil, the materials at the surface.
//!
//! Moisture is that of the form of the ground, as water gathers in hollows: how far a place lies below its
//! surroundings of some ten and some forty cells. A layer `moisture` says the other half, evened out over a few
//! cells, since plants do not follow each thread of water. Soil is the layer `soil_depth`; without it what is deposited,
//! or stays, on gentle slopes.

use super::scree::fallen;
use super::surface::Surface;
use crate::colour::{Linear, linear_of_srgb, mix};
use crate::colour_scale::Drape;
use crate::ground::drawable;
use crate::sheet::Sheet;
use crate::texture::smoothed;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::strata::stack;

/// Thickness of a material, in metres, that hides half of what it lies on.
const THINNEST: f32 = 0.05;

/// Thickness of soil, in metres, of which half of the full effect comes.
const HALF_SOIL: f32 = 0.5;

/// What colours the ground.
#[derive(Clone, Copy, Debug)]
pub(super) enum ColouredBy<'a> {
    /// What grows and lies on it.
    Natural,
    /// The materials at the surface.
    Materials,
    /// The values of a layer.
    Drape(&'a Drape),
}

/// What places are like.
#[derive(Debug)]
pub(super) struct Sites {
    pub(super) moisture: Surface,
    pub(super) soil: Surface,
    /// What has fallen from cliffs.
    pub(super) fallen: Surface,
    /// Colours of the materials, or of a layer that is draped.
    pub(super) materials: Option<[Surface; 3]>,
    mean: Option<Linear>,
    is_draped: bool,
    /// How many of the cells in which places are counted lie along one of the landscape.
    pub(super) fineness: f32,
}

impl Sites {
    /// From the layers of a landscape, no finer than the sheet, on cells of such sides whose rock is bare from a slope on,
    /// with the colours that it is to have.
    pub(super) fn new(
        landscape: &Landscape,
        ground: &Field,
        sheet: &Sheet,
        (spacing, rock): ([f32; 2], f32),
        coloured_by: ColouredBy<'_>,
    ) -> Result<Self, Error> {
        let land = landscape.domain.valid.as_ref();
        let height = drawable(ground, land, sheet);
        let layer = |name: &str| landscape.field(name).ok().map(|field| drawable(field, land, sheet));
        let hollows = hollows(&height);
        let moisture = match layer("moisture") {
            Some(moisture) => mean_of(&hollows, &ranked(&even(&moisture))),
            None => hollows,
        };
        let deposits = || layer("deposition").map(|deposits| covered(&deposits, [0.35, 0.85]));
        let soil = layer("soil_depth").map(|soil| covered(&even(&soil), [0.0, 1.0])).or_else(deposits);
        let soil = soil.unwrap_or_else(|| Field::filled(height.size(), 0.5));
        let colours = match coloured_by {
            ColouredBy::Natural => None,
            ColouredBy::Materials => Some(colours(landscape, ground)?),
            ColouredBy::Drape(drape) => Some(draped(drape, landscape)?),
        };
        let channel = |cells: &[Linear], c: usize| {
            let field = Field::from_values(ground.size(), cells.iter().map(|colour| colour[c]).collect());
            Surface::new(&drawable(&field, land, sheet))
        };
        Ok(Self {
            moisture: Surface::new(&moisture),
            soil: Surface::new(&soil),
            fallen: Surface::new(&fallen(&height, spacing, rock)),
            mean: colours.as_deref().map(mean),
            materials: colours.map(|cells| [0, 1, 2].map(|c| channel(&cells, c))),
            is_draped: matches!(coloured_by, ColouredBy::Drape(_)),
            fineness: 1.0,
        })
    }

    /// The same for places that are counted in finer cells.
    #[must_use]
    pub(super) fn on_finer(self, fineness: usize) -> Self {
        Self {
            moisture: self.moisture.on_finer(fineness),
            soil: self.soil.on_finer(fineness),
            fallen: self.fallen.on_finer(fineness),
            materials: self.materials.map(|channels| channels.map(|channel| channel.on_finer(fineness))),
            fineness: self.fineness * fineness as f32,
            ..self
        }
    }

    /// Whether the materials at the surface are shown.
    pub(super) fn shows_materials(&self) -> bool {
        self.materials.is_some()
    }

    /// Whether the values of a layer are shown, which nothing of the ground's own may hide.
    pub(super) fn is_draped(&self) -> bool {
        self.is_draped
    }

    /// From 0 dry to 1 wet.
    #[inline]
    pub(super) fn moisture(&self, place: [f32; 2]) -> f32 {
        self.moisture.at(place)
    }

    /// From 0 bare to 1 deep soil.
    #[inline]
    pub(super) fn soil(&self, place: [f32; 2]) -> f32 {
        self.soil.at(place)
    }

    /// From 0 to 1, how much has fallen there from cliffs.
    #[inline]
    pub(super) fn fallen(&self, place: [f32; 2]) -> f32 {
        self.fallen.at(place)
    }

    /// Colour of the materials at the surface, where they are shown.
    #[inline]
    pub(super) fn material(&self, place: [f32; 2]) -> Option<Linear> {
        let channels = self.materials.as_ref()?;
        Some([0, 1, 2].map(|c| channels[c].at(place).clamp(0.01, 0.95)))
    }

    /// Mean colour of the materials, where they are shown.
    pub(super) fn mean_material(&self) -> Option<Linear> {
        self.mean
    }
}

/// Whether a recipe names materials of its own.
pub(super) fn names_materials(landscape: &Landscape) -> bool {
    landscape.materials != Material::default_stack()
}

fn colours(landscape: &Landscape, ground: &Field) -> Result<Vec<Linear>, Error> {
    let stack = stack(landscape, ground)?;
    let inks: Vec<Linear> =
        landscape.materials.iter().map(|material| linear_of_srgb(material.colour)).collect();
    let surface = |cell: usize| {
        let layers = stack.iter().zip(&inks[1..]);
        layers.fold(inks[0], |below, (layer, &ink)| {
            let thickness = layer.values()[cell];
            mix(below, ink, hidden(thickness))
        })
    };
    Ok((0..ground.size().cells()).map(surface).collect())
}

/// Share of what lies below that a material of such a thickness in metres hides.
pub(super) fn hidden(thickness: f32) -> f32 {
    thickness / (thickness + THINNEST)
}

fn draped(drape: &Drape, landscape: &Landscape) -> Result<Vec<Linear>, Error> {
    let scale = drape.scale(landscape)?;
    Ok(landscape.field(&drape.of.0)?.values().iter().map(|value| scale.colour(*value)).collect())
}

fn mean(colours: &[Linear]) -> Linear {
    std::array::from_fn(|c| {
        (colours.iter().map(|colour| f64::from(colour[c])).sum::<f64>() / colours.len() as f64) as f32
    })
}

/// How far places lie below their surroundings, in root mean squares, brought to 0 to 1.
fn hollows(height: &Field) -> Field {
    let near = [1, 2, 4].into_iter().fold(height.clone(), |field, gap| smoothed(&field, gap));
    let far = [8, 16].into_iter().fold(near.clone(), |field, gap| smoothed(&field, gap));
    let [near, far] = [near, far].map(|mean| below(&mean, height));
    let depth = |(near, far): (&f32, &f32)| {
        let depth = 0.6 * near + 0.6 * far;
        0.5 + 0.5 * depth / (1.0 + depth * depth).sqrt()
    };
    Field::from_values(height.size(), near.values().iter().zip(far.values()).map(depth).collect())
}

/// Without what differs from cell to cell.
fn even(field: &Field) -> Field {
    [1, 2].into_iter().fold(field.clone(), |field, gap| smoothed(&field, gap))
}

fn mean_of(one: &Field, other: &Field) -> Field {
    let means = one.values().iter().zip(other.values()).map(|(one, other)| 0.5 * (one + other));
    Field::from_values(one.size(), means.collect())
}

fn below(mean: &Field, height: &Field) -> Field {
    let depths: Vec<f32> =
        mean.values().iter().zip(height.values()).map(|(mean, height)| mean - height).collect();
    let squares: f64 = depths.iter().map(|&depth| f64::from(depth) * f64::from(depth)).sum();
    let usual = (squares / depths.len() as f64).sqrt().max(1e-9) as f32;
    Field::from_values(height.size(), depths.into_iter().map(|depth| depth / usual).collect())
}

/// Share of the cells that hold less, so that moisture of any range has dry and wet places.
fn ranked(field: &Field) -> Field {
    let mut sorted = field.values().to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let last = (sorted.len() - 1).max(1) as f32;
    let rank = |value: &f32| sorted.partition_point(|other| other < value) as f32 / last;
    Field::from_values(field.size(), field.values().iter().map(rank).collect())
}

/// The effect of a thickness of soil, from that of none to that of much.
fn covered(soil: &Field, [none, much]: [f32; 2]) -> Field {
    let share =
        |&thickness: &f32| none + (much - none) * thickness.max(0.0) / (thickness.max(0.0) + HALF_SOIL);
    Field::from_values(soil.size(), soil.values().iter().map(share).collect())
}
