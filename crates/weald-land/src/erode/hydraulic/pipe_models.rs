//! The models of Han and of Mei et al. with the keys of a recipe filled in: pipes over one material.

use super::defaults::ResolvedKeys;
use super::keys::{HanKeys, Hydraulic, MeiKeys, Model, UptakeLaw};
use super::models::{OnLand, Scheme, another_model, named};
use crate::erode::han::{self, Han, HanConstants};
use crate::erode::material_planes::Planes;
use crate::erode::mei::{self, Mei, MeiConstants};
use crate::erode::setting::Setting;
use crate::erode::stack::Column;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::machine::Means;
use weald_engine::stencil::chain::Process;

/// Planes with which the states of mei and of stava begin.
pub(super) const MEI_PLANES: &[&str] =
    &["change", "water", "sediment", "flow_east", "flow_west", "flow_south", "flow_north"];

/// Bedrock alone behind so many planes.
fn one_material(planes: usize) -> Column {
    Column { planes: Planes { first_layer: planes, materials: 1 }, regolith: None }
}

impl Scheme for Han {
    const MEANS: Means<'static> = han::MEAN_FLUXES;

    fn of(step: &Hydraulic, on: &OnLand<'_>) -> Result<Self, Error> {
        Self::around(step, on.filled, step.setting(on.filled, on.working.shape()))
    }

    fn plane_names(&self, _: &Landscape) -> Vec<String> {
        named(Self::PLANES)
    }

    fn column(&self) -> Column {
        one_material(self.state_planes())
    }
}

impl Scheme for Mei {
    const MEANS: Means<'static> = mei::MEAN_FLUXES;

    fn of(step: &Hydraulic, on: &OnLand<'_>) -> Result<Self, Error> {
        Self::around(step, on.filled, step.setting(on.filled, on.working.shape()))
    }

    fn plane_names(&self, _: &Landscape) -> Vec<String> {
        named(MEI_PLANES)
    }

    fn column(&self) -> Column {
        one_material(self.state_planes())
    }
}

/// A model whose state is pipes over one material.
pub(super) trait PipeModel: Scheme {
    /// Names of its state planes, which begin with change, depth and sediment.
    const PLANES: &'static [&'static str];

    /// The process in a setting.
    fn around(step: &Hydraulic, filled: &ResolvedKeys, setting: Setting) -> Result<Self, Error>
    where
        Self: Sized;
}

impl PipeModel for Han {
    const PLANES: &'static [&'static str] = &["change", "water", "sediment", "flux_east", "flux_south"];

    fn around(step: &Hydraulic, filled: &ResolvedKeys, setting: Setting) -> Result<Self, Error> {
        let Model::Han(keys) = &step.model else { return Err(another_model(step)) };
        Ok(Self { constants: han_constants(keys, filled), limiter: keys.limiter, setting })
    }
}

impl PipeModel for Mei {
    const PLANES: &'static [&'static str] = MEI_PLANES;

    fn around(step: &Hydraulic, filled: &ResolvedKeys, setting: Setting) -> Result<Self, Error> {
        let Model::Mei(keys) = &step.model else { return Err(another_model(step)) };
        let (constants, limiter) = (mei_constants(keys, filled), keys.limiter);
        Ok(Self { constants, limiter, slope: keys.slope, setting })
    }
}

fn han_constants(keys: &HanKeys, filled: &ResolvedKeys) -> HanConstants {
    let uptake = |law| if keys.law == law { filled.erosion } else { 0.0 };
    HanConstants {
        flow_rate: filled.flow_rate,
        capacity: filled.capacity,
        uptake_by_speed: uptake(UptakeLaw::Velocity),
        uptake_by_capacity: uptake(UptakeLaw::Dissolution),
        deposit_ratio: keys.deposit_ratio as f32,
        epsilon: filled.epsilon,
        velocity_epsilon: filled.velocity_epsilon,
    }
}

fn mei_constants(keys: &MeiKeys, filled: &ResolvedKeys) -> MeiConstants {
    MeiConstants {
        flow_rate: filled.flow_rate,
        capacity: filled.capacity,
        erosion: filled.erosion,
        deposition: keys.deposition as f32,
        deposit_ratio: keys.deposit_ratio as f32,
        epsilon: filled.epsilon,
        velocity_epsilon: filled.velocity_epsilon,
    }
}
