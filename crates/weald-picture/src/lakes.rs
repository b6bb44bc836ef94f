//! Standing water: which depths are lakes, where their shores lie, and how blue they are.

use super::colour::{Linear, linear_of_hex, mix};
use super::contours::ramp;
use super::ground::shrink;
use super::ramp::Ramp;
use super::sheet::Sheet;
use super::spline::SplineRow;
use super::texture::smoothed;
use weald_core::connected::components;
use weald_core::domain::Domain;
use weald_core::grid::Field;
use weald_core::sea;

/// Water shallower than this share of a cell's side is a thin sheet of rain, not a lake.
const SHALLOWEST: f64 = 0.3;

/// Fewer cells than this are a puddle.
const SMALLEST: usize = 12;

/// Depth, in usual shallowest depths, at which a lake shows the middle of its ramp.
const MIDDLE_DEPTH: f32 = 6.0;

/// Least distance of water from the level of the shore, in shallowest depths.
const LEAST: f32 = 1e-3;

/// Lakes, ready to be drawn.
#[derive(Debug)]
pub(super) struct Lakes {
    /// 1 at the shore, 2 in the water, below 1 on land.
    pub level: Field,
    /// Depth in shallowest depths.
    pub(super) depth: Field,
    /// Depth at which a lake shows the middle of its ramp, in the same.
    middle_depth: f32,
    ramp: Ramp,
    shore: Linear,
}

impl Lakes {
    /// The lakes in a layer of water depths in metres over the ground; `None` where there are none.
    pub(super) fn of(
        [water, ground]: [&Field; 2],
        domain: &Domain,
        sheet: &Sheet,
        shallowest: Option<f64>,
    ) -> Option<Self> {
        let usual = SHALLOWEST * domain.cell;
        let shallowest = shallowest.unwrap_or(usual);
        let depth = deeper_than(shallowest, [water, ground], domain)?;
        let level = shores(&depth, ground, shallowest as f32);
        // A shore that follows cells has teeth; water one cell wide is left to the lines of rivers.
        let [level, depth] = [level, depth].map(|field| smoothed(&field, 1));
        Some(Self {
            level: shrink(&level, sheet),
            depth: shrink(&depth, sheet),
            middle_depth: MIDDLE_DEPTH * (usual / shallowest) as f32,
            ramp: Ramp::through(&[0x86_bfd9, 0x5d_a3ca, 0x3a_80b2, 0x25_5a8c]),
            shore: linear_of_hex(0x2f_6d98),
        })
    }

    /// Colour and cover of lake at a pixel.
    #[inline]
    pub(super) fn at(&self, level: Rise, depth: f32, line: f32) -> (Linear, f32) {
        let pixels_inside = (level.value - 1.0) / level.by_pixel.max(1e-6);
        let cover = (pixels_inside + 0.5).clamp(0.0, 1.0);
        let share = depth.max(0.0) / (depth.max(0.0) + self.middle_depth);
        let shore = 1.0 - ramp(pixels_inside, 0.4 * line, 1.6 * line);
        (mix(self.ramp.at(share), self.shore, 0.8 * shore), cover)
    }
}

/// Depths of water over the ground in shallowest depths: 1 and more in lakes and in the sea, less outside; `None` where
/// there are neither.
pub(super) fn depths(over: [&Field; 2], domain: &Domain) -> Option<Field> {
    deeper_than(SHALLOWEST * domain.cell, over, domain)
}

/// The sea is no sheet of rain however shallow it is: its depth counts from 1.
fn deeper_than(shallowest: f64, [water, ground]: [&Field; 2], domain: &Domain) -> Option<Field> {
    let (shallowest, sea) = (shallowest as f32, sea::cells_on(domain, ground));
    let relative = |(cell, &depth): (usize, &f32)| {
        let land = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let from = f32::from(u8::from(sea.as_ref().is_some_and(|sea| sea[cell])));
        if land && depth.is_finite() { from + depth.max(0.0) / shallowest } else { 0.0 }
    };
    let mut depth =
        Field::from_values(water.size(), water.values().iter().enumerate().map(relative).collect());
    drop_puddles(&mut depth).then_some(depth)
}

/// 0 on land, 1 at the shore and 2 in lakes, so that the shore lies where the level of a lake, as it goes on over land,
/// cuts the ground between the centres of two cells. Depths are in shallowest depths, of that many metres.
fn shores(depth: &Field, ground: &Field, shallowest: f32) -> Field {
    let size = depth.size();
    let (depths, heights) = (depth.values(), ground.values());
    let above = |cell: usize| {
        let own = depths[cell] - 1.0;
        if own >= 0.0 {
            return Some(own.max(LEAST));
        }
        let (mut count, mut level, mut deep) = (0.0, 0.0, 0.0);
        for other in size.neighbours(cell).filter(|&other| depths[other] >= 1.0) {
            count += 1.0;
            level += heights[other] + depths[other] * shallowest;
            deep += depths[other];
        }
        let over_land = (level / count - heights[cell]) / shallowest - 1.0;
        // A flood that stands above dry ground beside it ends half-way.
        let lies = if over_land > own { own * deep / count } else { over_land };
        (count > 0.0).then(|| lies.min(-LEAST))
    };
    let above: Vec<Option<f32>> = (0..size.cells()).map(above).collect();
    let level = |cell: usize| {
        let Some(here) = above[cell] else { return 0.0 };
        let across = size.neighbours(cell).filter_map(|other| above[other]).filter(|it| it * here < 0.0);
        1.0 + here / across.map(f32::abs).fold(here.abs(), f32::max)
    };
    Field::from_values(size, (0..size.cells()).map(level).collect())
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

    #[test]
    fn a_round_lake_has_a_round_shore_between_the_cells() {
        let domain = Domain::new(Size::square(40).expect("legal"), 1.0);
        let bowl = |radius: f32| 0.5 * radius;
        let ground = Field::from_function(domain.size, |x, y| {
            let [east, south] = [x, y].map(|it| it as f32 + 0.5 - 20.0);
            bowl((east * east + south * south).sqrt())
        });
        let depths = ground.values().iter().map(|height| (bowl(12.3) - height).max(0.0)).collect();
        let water = Field::from_values(domain.size, depths);
        let sheet = Sheet::new(&domain, Some(40)).expect("legal");
        let lakes = Lakes::of([&water, &ground], &domain, &sheet, Some(0.01)).expect("a lake");
        for turn in 0..36 {
            let angle = std::f32::consts::TAU * turn as f32 / 36.0;
            let level = |radius: f32| {
                let [x, y] = [libm::cosf(angle), libm::sinf(angle)].map(|it| 20.0 + radius * it - 0.5);
                let (column, row) = (x as usize, y as usize);
                let [right, down] = [x - column as f32, y - row as f32];
                let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
                let along = |y| mix(lakes.level.at(column, y), lakes.level.at(column + 1, y), right);
                mix(along(row), along(row + 1), down)
            };
            let shore = (0..400).map(|step| 10.0 + 0.01 * step as f32).find(|&radius| level(radius) < 1.0);
            let off = shore.expect("a shore") - 12.3;
            assert!(off.abs() < 0.25, "the shore lies {off} cells off at {angle}");
        }
    }

    /// A lake in the south of 20 × 20 cells, with a depth along its shore.
    fn lake(shore: impl Fn(usize) -> f32, shallowest: Option<f64>) -> Option<Lakes> {
        let domain = Domain::new(Size::square(20).expect("legal"), 1.0);
        let water = Field::from_function(domain.size, |x, y| match y {
            0..10 => 0.0,
            10..13 => shore(x),
            _ => 2.0,
        });
        let sheet = Sheet::new(&domain, Some(20)).expect("legal");
        let ground = Field::filled(domain.size, 0.0);
        Lakes::of([&water, &ground], &domain, &sheet, shallowest)
    }

    #[test]
    fn a_shore_has_no_teeth_of_single_cells() {
        let comb = lake(|x| if x % 4 == 0 { 2.0 } else { 0.0 }, None).expect("a lake");
        assert!((2..18).all(|x| comb.level.at(x, 11) < 1.0 && comb.level.at(x, 14) > 1.0));
        let straight = lake(|_| 2.0, None).expect("a lake");
        assert!((0..20).all(|x| straight.level.at(x, 9) < 1.0 && straight.level.at(x, 10) > 1.0));
    }

    #[test]
    fn a_sea_too_shallow_for_a_lake_reaches_its_shore() {
        // Two metres in a kilometre, on cells of a hundred: the sea is nowhere as deep as a lake.
        let flat = Domain::new(Size::square(20).expect("legal"), 100.0);
        let ground = Field::from_function(flat.size, |_, y| 0.2 * (10.3 - y as f32));
        let depths = ground.values().iter().map(|height| (-height).max(0.0)).collect();
        let water = Field::from_values(flat.size, depths);
        let sheet = Sheet::new(&flat, Some(20)).expect("legal");
        assert!(Lakes::of([&water, &ground], &flat, &sheet, None).is_none(), "a sheet of rain");
        let by_the_sea = Domain { sea_level: Some(0.0), ..flat };
        let sea = Lakes::of([&water, &ground], &by_the_sea, &sheet, None).expect("a sea");
        assert!((2..18).all(|x| sea.level.at(x, 9) < 1.0 && sea.level.at(x, 12) > 1.0));
    }

    #[test]
    fn a_shallow_flood_is_drawn_where_that_is_asked_for() {
        let flood = |shallowest| {
            let lakes = lake(|_| 0.02, shallowest).expect("a lake");
            lakes.at(Rise { value: lakes.level.at(5, 11), by_pixel: 0.1 }, 1.0, 1.0).1
        };
        assert_eq!([flood(None), flood(Some(0.01))], [0.0, 1.0]);
    }
}
