//! Levels of detail of the ground: level 0 has the finest spacing of vertices, each further one twice that.

/// Vertices of the finest level on the side of a cell.
const FINEST: f32 = 0.125;

/// Most levels: enough for the largest grid.
pub(crate) const MAX_LEVELS: usize = 26;

/// Cells between vertices of a level.
pub(crate) fn spacing(level: usize) -> f32 {
    FINEST * (1_u32 << level) as f32
}
