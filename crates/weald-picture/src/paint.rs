//! What the ground of a relief picture is painted with: tints by height, or a colour a cell.

use super::colour::{Linear, linear_of_srgb, mix};
use super::ground::drawable;
use super::ramp::Ramp;
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::strata::stack;

/// Colours of the ground before light falls on it.
#[derive(Debug)]
pub(super) enum Paint {
    /// By height, from the lowest tint to the highest.
    Tints(Ramp),
    /// Red, green and blue of each cell, in linear light.
    Cells([Field; 3]),
}

impl Paint {
    /// The materials at the surface. One that is `thinnest` metres thick hides half of what it lies on.
    pub(super) fn of_materials(
        landscape: &Landscape,
        ground: &Field,
        thinnest: f32,
        sheet: &Sheet,
    ) -> Result<Self, Error> {
        let stack = stack(landscape, ground)?;
        let colours: Vec<_> = landscape.materials.iter().map(|m| linear_of_srgb(m.colour)).collect();
        let surface = |cell: usize| {
            let cover = |thickness: f32| thickness / (thickness + thinnest);
            let layers = stack.iter().zip(&colours[1..]);
            layers.fold(colours[0], |below, (layer, &colour)| mix(below, colour, cover(layer.values()[cell])))
        };
        let cells: Vec<Linear> = (0..ground.size().cells()).map(surface).collect();
        let channel = |c: usize| {
            let field = Field::from_values(ground.size(), cells.iter().map(|colour| colour[c]).collect());
            drawable(&field, landscape.domain.valid.as_ref(), sheet)
        };
        Ok(Self::Cells([0, 1, 2].map(channel)))
    }

    /// Evaluates the colours along row `y` of the sheet.
    pub(super) fn evaluate(&self, spline: &Spline, y: usize, rows: &mut [SplineRow; 3]) {
        if let Self::Cells(channels) = self {
            for (channel, row) in channels.iter().zip(rows) {
                spline.row(channel, y, row);
            }
        }
    }

    /// The colour of a pixel of the evaluated row, whose height is `share` of the way between the tints.
    #[inline]
    pub(super) fn at(&self, x: usize, share: f32, rows: &[SplineRow; 3]) -> Linear {
        match self {
            Self::Tints(ramp) => ramp.at(share),
            // The spline passes the colours of thin beds by a little where it turns.
            Self::Cells(_) => std::array::from_fn(|c| rows[c].value[x].clamp(0.01, 1.0)),
        }
    }
}
