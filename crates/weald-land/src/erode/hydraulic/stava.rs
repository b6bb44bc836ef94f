//! The model of Šťava et al. with the keys of a recipe filled in.

use super::defaults::ResolvedKeys;
use super::keys::{Boundary, Hydraulic, StavaKeys};
use super::models::{MEI_PLANES, SelectedModel, named};
use crate::edit::Script;
use crate::erode::edits::{self, Edits, Place};
use crate::erode::material_planes::{Planes, REGOLITH_PLANES};
use crate::erode::mei;
use crate::erode::springs;
use crate::erode::stack::{Column, deposit_of};
use crate::erode::stava::digging::Digging;
use crate::erode::stava::dissolution::Dissolution;
use crate::erode::stava::slippage::Slippage;
use crate::erode::stava::viscosity::Viscosity;
use crate::erode::stava::{Stava, StavaConstants};
use crate::erode::water_planes as plane;
use crate::erode::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Nested, ScriptFile};

impl Hydraulic {
    pub(super) fn stava(
        &self,
        keys: &StavaKeys,
        landscape: &Landscape,
        (filled, working): (&ResolvedKeys, &WorkingGrid),
        script: Option<Script>,
    ) -> Result<SelectedModel<Stava>, Error> {
        let column = keys.column(landscape);
        let weather = keys.weather_planes(landscape, working, script.is_some())?;
        let edits = script.map(|script| keys.edits(script, landscape, working));
        let process = Stava {
            constants: StavaConstants {
                flow_rate: filled.flow_rate,
                capacity: filled.capacity,
                epsilon: filled.epsilon,
                velocity_epsilon: filled.velocity_epsilon,
            },
            planes: column.planes,
            painted: !weather.is_empty(),
            viscosity: keys.viscosity_in(landscape.domain.cell),
            erosion: keys.digging(landscape, filled)?,
            dissolution: keys.dissolution_in(landscape, filled)?,
            slippage: keys.slippage_in(landscape, column.planes)?,
            setting: self.setting(filled, working),
        };
        let mut plane_names = named(MEI_PLANES);
        plane_names.extend(column.names(&landscape.materials));
        Ok(SelectedModel { process, plane_names, means: mei::MEAN_FLUXES, constants: weather, edits })
    }

    /// The script of strokes, which is read here.
    pub(super) fn script(&self, materials: &[Material]) -> Result<Option<Script>, Error> {
        let Some(path) = self.edits().map(ScriptFile::path) else { return Ok(None) };
        let names: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
        let script = Script::load(&path, &names)?;
        edits::check(&script, self.boundary == Boundary::Open).map_err(|what| Error::input(&path, what))?;
        Ok(Some(script))
    }
}

impl StavaKeys {
    /// Where the materials stand in the state.
    pub(super) fn column(&self, landscape: &Landscape) -> Column {
        let regolith = self.dissolution.as_ref().map(|_| plane::COUNT);
        let first_layer = plane::COUNT + regolith.map_or(0, |_| REGOLITH_PLANES);
        Column { planes: Planes { first_layer, materials: landscape.materials.len() }, regolith }
    }

    /// Number of the material that settles.
    pub(super) fn deposit_of(&self, landscape: &Landscape) -> Result<usize, Error> {
        deposit_of(self.deposit.as_ref(), &landscape.materials).map_err(Error::Run)
    }

    fn viscosity_in(&self, cell: f64) -> Option<Viscosity> {
        let viscosity = (self.viscosity / (cell * cell)) as f32;
        (viscosity > 0.0).then(|| Viscosity::new(viscosity))
    }

    fn digging(&self, landscape: &Landscape, filled: &ResolvedKeys) -> Result<Digging, Error> {
        let share = |material: &Material| (material.erodibility as f32 * filled.erosion).clamp(0.0, 1.0);
        Ok(Digging {
            shares: landscape.materials.iter().map(share).collect(),
            deposit: self.deposit_of(landscape)?,
            deposition: self.deposition as f32,
        })
    }

    fn dissolution_in(
        &self,
        landscape: &Landscape,
        filled: &ResolvedKeys,
    ) -> Result<Option<Dissolution>, Error> {
        let Some(Nested(within)) = &self.dissolution else { return Ok(None) };
        let deposit = self.deposit_of(landscape)?;
        let numbers = (filled.flow_rate, landscape.domain.cell);
        Ok(Some(within.dissolution(&landscape.materials, deposit, plane::COUNT, numbers)))
    }

    fn slippage_in(&self, landscape: &Landscape, planes: Planes) -> Result<Option<Slippage>, Error> {
        let within = self.slippage.as_ref();
        within.map(|Nested(within)| within.slippage(&landscape.materials, planes)).transpose()
    }

    fn edits(&self, script: Script, landscape: &Landscape, working: &WorkingGrid) -> Edits {
        let names = landscape.materials.iter().map(|material| material.name.clone()).collect();
        Edits::new(script, names, Place::of(working, self.column(landscape)))
    }

    /// Share of the rain, share of the evaporation, and sources in cells per step; none where nothing is painted
    /// and none of it changes.
    fn weather_planes(
        &self,
        landscape: &Landscape,
        working: &WorkingGrid,
        changes: bool,
    ) -> Result<Vec<Vec<f32>>, Error> {
        let layer = |name: &Option<LayerName>| name.as_ref().map(|name| landscape.field(&name.0)).transpose();
        let shares = [layer(&self.rain_layer)?, layer(&self.evaporation_layer)?];
        let painted = layer(&self.source_layer)?;
        let plain = painted.is_none() && self.sources.is_empty() && self.drains.is_empty();
        if plain && !changes && shares == [None, None] {
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
