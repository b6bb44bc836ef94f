//! What a relief picture chooses for itself from the ground it shows.

use rayon::prelude::*;

use super::lakes::Lakes;
use weald_core::grid::Field;

/// Slope to which the steepest tenth of the land is exaggerated: the tangent of 45°.
const DRAWN_SLOPE: f64 = 1.0;

/// Texture that is this share of the relief or less is noise, and is not stretched to full strength.
const FAINTEST_TEXTURE: f32 = 2e-4;

/// Shares of the dry land that lie below the first and above the last tint: a few gorges and peaks should not
/// press all other ground into the middle of the ramp.
const BELOW_TINTS: f64 = 0.01;
const ABOVE_TINTS: f64 = 0.001;

/// Heights of the first and the last tint, from the land outside lakes.
pub(super) fn tint_range(height: &Field, land: Option<&Field>, lakes: Option<&Lakes>) -> [f32; 2] {
    let is_dry = |cell: usize| {
        land.is_none_or(|land| land.values()[cell] >= 0.5)
            && lakes.is_none_or(|lakes| lakes.level.values()[cell] < 1.0)
    };
    let dry = height.values().iter().enumerate().filter(|&(cell, _)| is_dry(cell));
    let mut heights: Vec<f32> = dry.map(|(_, &height)| height).collect();
    heights.sort_unstable_by(f32::total_cmp);
    let Some(last) = heights.len().checked_sub(1) else { return [0.0, 1.0] };
    let quantile = |share: f64| heights[(share * last as f64).round() as usize];
    let (low, high) = (quantile(BELOW_TINTS), quantile(1.0 - ABOVE_TINTS));
    if high > low { [low, high] } else { [low, low + 1.0] }
}

/// The factor that draws the slope exceeded by one cell in ten as [`DRAWN_SLOPE`]; 1 on flat ground.
pub(super) fn exaggeration(height: &Field, spacing: [f64; 2]) -> f64 {
    let mut slopes = slopes(height, spacing);
    slopes.sort_unstable_by(f32::total_cmp);
    let (Some(&usual), Some(&steepest)) = (slopes.get(slopes.len() * 9 / 10), slopes.last()) else {
        return 1.0;
    };
    let steep = f64::from(if usual > 0.0 { usual } else { steepest });
    if steep > 0.0 { (DRAWN_SLOPE / steep).clamp(0.02, 50.0) } else { 1.0 }
}

/// Slopes between the cells, from every cell with an eastern and a southern neighbour.
fn slopes(height: &Field, spacing: [f64; 2]) -> Vec<f32> {
    let size = height.size();
    let slope = |x: usize, y: usize| {
        let east = f64::from(height.at(x + 1, y) - height.at(x, y)) / spacing[0];
        let south = f64::from(height.at(x, y + 1) - height.at(x, y)) / spacing[1];
        (east * east + south * south).sqrt() as f32
    };
    let rows = (0..size.rows - 1).into_par_iter();
    rows.flat_map_iter(|y| (0..size.columns - 1).map(move |x| slope(x, y))).collect()
}

/// Texture over its root mean square, or over [`FAINTEST_TEXTURE`] of the relief where that is more.
pub(super) fn normalised(mut field: Field, relief: f32) -> Field {
    let squares: f64 = field.values().iter().map(|&value| f64::from(value) * f64::from(value)).sum();
    let usual = (squares / field.size().cells() as f64).sqrt() as f32;
    let scale = usual.max(FAINTEST_TEXTURE * relief);
    if scale > 0.0 {
        field.values_mut().iter_mut().for_each(|value| *value /= scale);
    }
    field
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn the_slope_of_the_steepest_tenth_is_drawn_as_45_degrees() {
        // Of twenty columns of slopes three rise by 2, the others by a tenth.
        let height = |x: usize, _| if x <= 17 { 0.1 * x as f32 } else { 1.7 + 2.0 * (x - 17) as f32 };
        let field = Field::from_function(Size::new(21, 11).expect("small"), height);
        let factor = exaggeration(&field, [1.0, 1.0]);
        assert!((factor - 0.5).abs() < 1e-5, "{factor}");
        assert!((exaggeration(&field, [4.0, 4.0]) - 2.0).abs() < 1e-5, "cells four times as wide");
    }

    #[test]
    fn texture_has_a_mean_square_of_one_unless_it_is_fainter_than_noise() {
        let size = Size::new(2, 1).expect("small");
        let texture = |relief: f32| normalised(Field::from_values(size, vec![0.2, -0.2]), relief);
        assert_eq!(texture(1.0).values(), [1.0, -1.0]);
        let faint = texture(10_000.0).at(0, 0);
        assert!((faint - 0.1).abs() < 1e-6, "{faint}: a fifth of a metre in ten kilometres is noise");
    }
}
