//! The plain that a landscape stands on, and what the landscape hides of the sky there.

use super::sky::Sky;
use super::skylight::Skylight;
use super::surface::Surface;
use super::terrain::Terrain;
use weald_core::grid::{Field, Size};

/// Cells of the plain along the landscape's side for which the visible sky is known; the plain is three such sides wide.
const PLAIN_CELLS: usize = 40;

/// The sky that is seen from the plain, three times as wide as the landscape.
pub(super) fn light(sky: &Sky, terrain: &Terrain) -> Skylight {
    let (inner, size) = (terrain.top.size(), Size { columns: 3 * PLAIN_CELLS, rows: 3 * PLAIN_CELLS });
    let share =
        |cell: usize, cells: usize| 0.5 + ((cell as f32 + 0.5) / PLAIN_CELLS as f32 - 1.0) * cells as f32;
    let height = Field::from_function(size, |x, y| {
        let place = [share(x, inner.columns), share(y, inner.rows)];
        if terrain.is_valid(place) { terrain.top.at(place) } else { terrain.base }
    });
    let spacing = [0, 1]
        .map(|axis| terrain.spacing[axis] * [inner.columns, inner.rows][axis] as f32 / PLAIN_CELLS as f32);
    Skylight::new(sky, &Surface::new(&height), spacing, 3 * PLAIN_CELLS)
}
