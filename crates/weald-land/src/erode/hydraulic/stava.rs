//! The model of Šťava et al. with the keys of a recipe filled in.

use super::defaults::ResolvedKeys;
use super::keys::{Boundary, Hydraulic, Model, StavaKeys};
use super::models::{OnLand, Scheme, another_model, named};
use super::pipe_models::MEI_PLANES;
use crate::edit::{Script, Setting};
use crate::erode::material_planes::{Planes, REGOLITH_PLANES};
use crate::erode::mei;
use crate::erode::scripted;
use crate::erode::settings;
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
use weald_core::parameter::{LayerName, Nested};
use weald_engine::machine::Means;

impl Scheme for Stava {
    const MEANS: Means<'static> = mei::MEAN_FLUXES;

    fn of(step: &Hydraulic, on: &OnLand<'_>) -> Result<Self, Error> {
        let Model::Stava(keys) = &step.model else { return Err(another_model(step)) };
        let OnLand { landscape, filled, working, painted } = *on;
        let column = keys.column(landscape);
        Ok(Self {
            constants: StavaConstants {
                flow_rate: filled.flow_rate,
                capacity: filled.capacity,
                epsilon: filled.epsilon,
                velocity_epsilon: filled.velocity_epsilon,
            },
            planes: column.planes,
            painted,
            viscosity: keys.viscosity_in(landscape.domain.cell),
            erosion: keys.digging(landscape, filled)?,
            dissolution: keys.dissolution_in(landscape, filled)?,
            slippage: keys.slippage_in(landscape, column.planes)?,
            setting: step.setting(filled, working.shape()),
        })
    }

    fn plane_names(&self, landscape: &Landscape) -> Vec<String> {
        let mut names = named(MEI_PLANES);
        names.extend(self.column().names(&landscape.materials));
        names
    }

    fn column(&self) -> Column {
        Column {
            planes: self.planes,
            regolith: self.dissolution.as_ref().map(|dissolution| dissolution.plane),
        }
    }

    fn weather(
        step: &Hydraulic,
        landscape: &Landscape,
        working: &WorkingGrid,
        changes: bool,
    ) -> Result<Vec<Vec<f32>>, Error> {
        let Some(keys) = step.model.stava() else { return Ok(Vec::new()) };
        keys.weather_planes(landscape, working, changes)
    }
}

impl Hydraulic {
    /// The script of edits, which is read here.
    pub(super) fn script(&self, materials: &[Material]) -> Result<Option<Script>, Error> {
        let try_keys = |settings: &[Setting]| settings::no_faults(&self.after(settings)?, materials);
        scripted::load(self.edits.as_ref(), self.boundary == Boundary::Open, materials, try_keys)
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
