//! How soft what lies bare is, by how far ground has worn into its materials.

use super::fluvial_materials::StartColumn;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

/// How soft the materials under each cell are, relative to the bedrock.
pub(super) struct BareSoftness {
    /// Thickness of each material on the bedrock and its softness, uppermost first.
    beds: Vec<(Field, f32)>,
}

impl BareSoftness {
    pub(super) fn of(landscape: &Landscape, start: &Field) -> Result<Self, Error> {
        let column = StartColumn::of(landscape, start)?;
        let bedrock = landscape.materials.first().map_or(1.0, |bedrock| bedrock.erodibility);
        let above =
            landscape.materials.iter().skip(1).map(|material| (material.erodibility / bedrock) as f32);
        let beds = column.thicknesses.into_iter().zip(above).rev().collect();
        Ok(Self { beds })
    }

    /// Of what lies bare where so many metres are worn.
    pub(super) fn at(&self, cell: usize, worn: f32) -> f32 {
        let mut depth = 0.0;
        for (thickness, softness) in &self.beds {
            depth += thickness.values()[cell];
            if worn < depth {
                return *softness;
            }
        }
        // What has settled on bare rock is the last material as well.
        self.beds.first().filter(|_| worn < 0.0).map_or(1.0, |(_, softness)| *softness)
    }
}
