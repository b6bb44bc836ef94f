//! A landscape as a coarser grid sees it, with the layers that a step reads.

use super::fluvial_levels as levels;
use super::fluvial_materials::StartColumn;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

/// What a coarser grid is told of a landscape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub(super) landscape: &'a Landscape,
    /// Layer of the ground.
    pub(super) ground: &'a LayerName,
    /// Whether the step reads the materials.
    pub(super) materials: bool,
}

impl<'a> Seen<'a> {
    /// On cells 2^`level` times as long: the ground, those layers, and the thickness of each material.
    pub(super) fn on_level(
        &self,
        level: u32,
        layers: impl Iterator<Item = &'a LayerName>,
    ) -> Result<Landscape, Error> {
        let mut fields = Vec::new();
        for LayerName(name) in std::iter::once(self.ground).chain(layers) {
            fields.push((name.clone(), self.landscape.field(name)?.clone()));
        }
        if self.materials {
            let column = StartColumn::of(self.landscape, self.landscape.field(&self.ground.0)?)?;
            let names = self.landscape.materials.iter().skip(1).map(|material| material.name.clone());
            fields.extend(names.zip(column.thicknesses));
        }
        levels::coarsened(self.landscape, 1 << level, &fields)
    }
}
