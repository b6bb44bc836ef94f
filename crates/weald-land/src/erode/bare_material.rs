//! What lies bare, by how far ground has worn into its materials: how soft it is, and how steeply it stands.

use super::fluvial_materials::StartColumn;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::Material;

/// How a material resists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Resistance {
    /// Erodibility over that of the bedrock.
    pub(super) softness: f32,
    /// Steepest slope that stands, as a tangent.
    pub(super) talus: f32,
}

/// How the materials under each cell resist.
pub(super) struct BareMaterial {
    /// Thickness in metres of each material on the bedrock, and how it resists, uppermost first.
    beds: Vec<(Field, Resistance)>,
    bedrock: Resistance,
}

impl BareMaterial {
    pub(super) fn of(landscape: &Landscape, start: &Field) -> Result<Self, Error> {
        let column = StartColumn::of(landscape, start)?;
        let hardest = landscape.materials.first().map_or(1.0, |bedrock| bedrock.erodibility);
        let resistance = |material: &Material| Resistance {
            softness: (material.erodibility / hardest) as f32,
            talus: libm::tan(material.talus_deg.to_radians()) as f32,
        };
        let mut resistances = landscape.materials.iter().map(resistance);
        let bedrock = resistances.next().unwrap_or(Resistance { softness: 1.0, talus: f32::INFINITY });
        let beds = column.thicknesses.into_iter().zip(resistances).rev().collect();
        Ok(Self { beds, bedrock })
    }

    /// Of what lies bare where so many metres are worn.
    pub(super) fn at(&self, cell: usize, worn: f32) -> Resistance {
        let mut depth = 0.0;
        for (thickness, resistance) in &self.beds {
            depth += thickness.values()[cell];
            if worn < depth {
                return *resistance;
            }
        }
        // What has settled on bare rock is the last material as well.
        self.beds.first().filter(|_| worn < 0.0).map_or(self.bedrock, |(_, resistance)| *resistance)
    }
}
