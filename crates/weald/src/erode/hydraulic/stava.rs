//! The model of Šťava et al. with the keys of a recipe filled in.

use super::models::{Chosen, MEI_PLANES, named};
use super::{Filled, Hydraulic};
use crate::edit::Script;
use crate::erode::edits::{Edits, Place};
use crate::erode::mei;
use crate::erode::springs;
use crate::erode::stack::{Column, regolith_names, thickness_names};
use crate::erode::stava::digging::Digging;
use crate::erode::stava::planes::{Planes, REGOLITH_PLANES};
use crate::erode::stava::viscosity::Viscosity;
use crate::erode::stava::{Stava, StavaConstants, plane};
use crate::erode::working::Working;
use crate::error::Error;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::material::Material;
use crate::recipe::parameter::{LayerName, Nested};

impl Hydraulic {
    /// Where the materials stand in the state.
    pub(super) fn column(&self, landscape: &Landscape) -> Column {
        let regolith = self.dissolution.as_ref().map(|_| plane::COUNT);
        let first_layer = plane::COUNT + regolith.map_or(0, |_| REGOLITH_PLANES);
        Column { planes: Planes { first_layer, materials: landscape.materials.len() }, regolith }
    }

    /// Number of the material that settles.
    pub(super) fn deposit_of(&self, landscape: &Landscape) -> Result<usize, Error> {
        deposit_of(self.deposit.as_ref(), &landscape.materials)
    }

    pub(super) fn stava(
        &self,
        landscape: &Landscape,
        filled: &Filled,
        working: &Working,
    ) -> Result<Chosen<Stava>, Error> {
        let Column { planes, regolith } = self.column(landscape);
        let materials = &landscape.materials;
        let deposit = self.deposit_of(landscape)?;
        let constants = self.weather_planes(landscape, working)?;
        let edits = self.edits(landscape, working)?;
        let cell = landscape.domain.cell;
        let viscosity = (self.viscosity / (cell * cell)) as f32;
        let share = |material: &Material| (material.erodibility as f32 * filled.erosion).min(1.0);
        let dissolution = regolith.zip(self.dissolution.as_ref()).map(|(plane, Nested(within))| {
            within.dissolution(materials, deposit, plane, (filled.flow_rate, cell))
        });
        let slippage = self.slippage.as_ref().map(|Nested(within)| within.slippage(materials)).transpose()?;
        let process = Stava {
            constants: StavaConstants {
                flow_rate: filled.flow_rate,
                capacity: filled.capacity,
                epsilon: filled.epsilon,
                velocity_epsilon: filled.velocity_epsilon,
            },
            planes,
            painted: !constants.is_empty(),
            viscosity: (viscosity > 0.0).then(|| Viscosity::new(viscosity)),
            erosion: Digging {
                shares: materials.iter().map(share).collect(),
                deposit,
                deposition: self.deposition as f32,
            },
            dissolution,
            slippage,
            setting: self.setting(filled, working),
        };
        let mut plane_names = named(MEI_PLANES);
        plane_names.extend(regolith.into_iter().flat_map(|_| regolith_names()));
        plane_names.extend(thickness_names(materials));
        Ok(Chosen { process, plane_names, means: mei::MEAN_FLUXES, constants, edits })
    }

    /// The strokes of the script, which is read here.
    fn edits(&self, landscape: &Landscape, working: &Working) -> Result<Option<Edits>, Error> {
        let Some(file) = &self.edits else { return Ok(None) };
        let names: Vec<_> = landscape.materials.iter().map(|material| material.name.as_str()).collect();
        let script = Script::load(&file.path(), &names)?;
        let place = Place::of(working, self.column(landscape));
        Edits::new(script, names.into_iter().map(str::to_owned).collect(), place).map(Some)
    }

    /// Share of the rain, share of the evaporation, and sources in cells a step; none where nothing is painted.
    fn weather_planes(&self, landscape: &Landscape, working: &Working) -> Result<Vec<Vec<f32>>, Error> {
        let layer = |name: &Option<LayerName>| name.as_ref().map(|name| landscape.field(&name.0)).transpose();
        let shares = [layer(&self.rain_layer)?, layer(&self.evaporation_layer)?];
        let painted = layer(&self.source_layer)?;
        let plain = painted.is_none() && self.sources.is_empty() && self.drains.is_empty();
        let plain = plain && self.edits.is_none();
        if plain && shares == [None, None] {
            return Ok(Vec::new());
        }
        let share =
            |field: Option<&Field>| working.ringed(|x, y| field.map_or(1.0, |field| field.at(x, y).max(0.0)));
        let domain = &landscape.domain;
        let springs = springs::field_of(domain, painted, &self.sources, &self.drains);
        let springs = working.ringed(|x, y| (f64::from(springs.at(x, y)) / domain.cell) as f32);
        Ok(vec![share(shares[0]), share(shares[1]), springs])
    }
}

/// Number of the material that settles: the one named, or the last.
pub(in crate::erode) fn deposit_of(name: Option<&LayerName>, materials: &[Material]) -> Result<usize, Error> {
    let Some(LayerName(name)) = name else { return Ok(materials.len() - 1) };
    materials.iter().position(|material| material.name == *name).ok_or_else(|| {
        let known: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
        Error::Run(format!("`deposit` names material `{name}`; the landscape has: {}", known.join(", ")))
    })
}
