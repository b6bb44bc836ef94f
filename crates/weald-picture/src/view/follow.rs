//! A scene whose ground and water change while it is drawn: `follow.wgsl` makes its surfaces anew on a device.

use super::lit_scene::LitScene;
use super::surface::Surface;
use super::water::{DRY, SHALLOW};
use weald_core::grid::Field;
use weald_engine::uniform;

uniform! {
    /// What the shader is given.
    pub struct Follow {
        /// Cells from west to east.
        pub columns: u32,
        /// Cells from north to south.
        pub rows: u32,
        /// Elevation of the lowest ground at the beginning, in metres.
        pub low: f32,
        /// Factor on heights.
        pub exaggeration: f32,
        /// Depth of water in metres from which it is drawn.
        pub shallow: f32,
        /// Depth in metres to which levels fall below dry ground.
        pub dry: f32,
        /// Side of a cell in metres.
        pub cell: f32,
    }
}

impl LitScene {
    /// The shader that makes the maps `top`, `bed` and `level` of ground and water; its entry point is `follow_ground`,
    /// with 16 × 16 control points a workgroup.
    pub const FOLLOW: &str = include_str!("follow.wgsl");

    /// The same scene, whose ground and water may change: all deep enough water is drawn as it stands, and the lines of
    /// rivers are not, which come from means of a whole simulation.
    #[must_use]
    pub fn to_follow(mut self) -> Self {
        self.setting.rivers = None;
        if self.setting.level.is_none() {
            let bed = &self.setting.bed;
            let cell = self.setting.terrain.cell();
            let dry = Field::from_function(bed.size(), |x, y| {
                bed.at([x as f32 + 1.0, y as f32 + 1.0]) - cell * self.setting.exaggeration
            });
            self.setting.level = Some(Surface::new(&dry));
        }
        self
    }

    /// What the shader is given.
    pub fn follow(&self) -> Follow {
        let cell = self.setting.terrain.cell();
        let [columns, rows] = self.cells().map(|cells| cells as u32);
        Follow {
            columns,
            rows,
            low: self.setting.low,
            exaggeration: self.setting.exaggeration,
            shallow: SHALLOW * cell,
            dry: DRY * cell,
            cell,
        }
    }
}
