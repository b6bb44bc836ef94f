//! Standing water: which depths are lakes, where their shores lie, and how blue they are.

use super::colour::{Linear, linear_of_hex, mix};
use super::contours::ramp;
use super::ground::shrink;
use super::ramp::Ramp;
use super::sheet::Sheet;
use super::spline::SplineRow;
use weald_core::connected::components;
use weald_core::domain::Domain;
use weald_core::grid::Field;

/// Water shallower than this share of a cell's side is a thin sheet of rain, not a lake.
const SHALLOWEST: f64 = 0.3;

/// Fewer cells than this are a puddle.
const SMALLEST: usize = 12;

/// Depth, in shallowest depths, at which a lake shows the middle of its ramp.
const MIDDLE_DEPTH: f32 = 6.0;

/// Lakes, ready to be drawn.
#[derive(Debug)]
pub(super) struct Lakes {
    /// 1 at the shore, 2 in the water, below 1 on land.
    pub level: Field,
    /// Depth in shallowest depths.
    pub(super) depth: Field,
    ramp: Ramp,
    shore: Linear,
}

impl Lakes {
    /// The lakes in a layer of water depths in metres; `None` where there are none.
    pub(super) fn of(water: &Field, domain: &Domain, sheet: &Sheet) -> Option<Self> {
        let depth = depths(water, domain)?;
        let level =
            Field::from_values(depth.size(), depth.values().iter().map(|depth| depth.min(2.0)).collect());
        Some(Self {
            level: shrink(&level, sheet),
            depth: shrink(&depth, sheet),
            ramp: Ramp::through(&[0xa6_d0de, 0x6f_b0cf, 0x3f_83b0, 0x25_5a8c]),
            shore: linear_of_hex(0x2f_6d98),
        })
    }

    /// Colour and cover of lake at a pixel.
    #[inline]
    pub(super) fn at(&self, level: Rise, depth: f32, line: f32) -> (Linear, f32) {
        let pixels_inside = (level.value - 1.0) / level.by_pixel.max(1e-6);
        let cover = (pixels_inside + 0.5).clamp(0.0, 1.0);
        let share = depth.max(0.0) / (depth.max(0.0) + MIDDLE_DEPTH);
        let shore = 1.0 - ramp(pixels_inside, 0.4 * line, 1.6 * line);
        (mix(self.ramp.at(share), self.shore, 0.8 * shore), cover)
    }
}

/// Depths in shallowest depths: 1 and more in lakes, less outside; `None` where there are no lakes.
pub(super) fn depths(water: &Field, domain: &Domain) -> Option<Field> {
    let shallowest = (SHALLOWEST * domain.cell) as f32;
    let relative = |(cell, &depth): (usize, &f32)| {
        let land = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        if land && depth.is_finite() { depth.max(0.0) / shallowest } else { 0.0 }
    };
    let mut depth =
        Field::from_values(water.size(), water.values().iter().enumerate().map(relative).collect());
    drop_puddles(&mut depth).then_some(depth)
}

/// A value and its steepest rise in one pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rise {
    /// The value.
    pub(super) value: f32,
    /// Its steepest rise, in one pixel.
    pub(super) by_pixel: f32,
}

impl Rise {
    /// From a row of spline values, at `scale` cells a pixel.
    #[inline]
    pub(super) fn at(row: &SplineRow, x: usize, scale: f32) -> Self {
        let (east, south) = (row.east[x], row.south[x]);
        Self { value: row.value[x], by_pixel: scale * (east * east + south * south).sqrt() }
    }
}

/// Lowers the depth of puddles below the shore; says whether a lake is left.
fn drop_puddles(depth: &mut Field) -> bool {
    let wet: Vec<bool> = depth.values().iter().map(|&depth| depth >= 1.0).collect();
    let mut lakes = false;
    for cells in components(depth.size(), &wet) {
        lakes |= cells.len() >= SMALLEST;
        if cells.len() < SMALLEST {
            for cell in cells {
                depth.values_mut()[cell] = 0.5;
            }
        }
    }
    lakes
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn puddles_dry_up_and_lakes_stay() {
        let size = Size::square(20).expect("legal");
        let mut depth = Field::filled(size, 0.1);
        depth.set(3, 3, 5.0);
        assert!(!drop_puddles(&mut depth.clone()));
        (0..16).for_each(|cell| depth.set(10 + cell % 4, 10 + cell / 4, 5.0));
        assert!(drop_puddles(&mut depth));
        assert_eq!((depth.at(3, 3), depth.at(11, 11), depth.at(0, 0)), (0.5, 5.0, 0.1));
    }
}
