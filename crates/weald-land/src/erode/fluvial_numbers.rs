//! A flood's numbers in cells and steps, from those of a recipe in metres and time.

use super::fluvial::strata::Strata;
use super::fluvial::{FluvialConstants, Numbers};
use super::fluvial_step::Fluvial;
use super::hydraulic::Boundary;
use weald_core::material::MAX_MATERIALS;

/// Gravity in m/s².
const GRAVITY: f64 = 9.81;

/// Part of a cell that the fastest wave passes in a step. Eight pipes are stable up to √3/2.
const COURANT: f64 = 0.5;

/// Most of the step between two cells that creeps or slides in a step of time. Stable up to 3/8.
const MAX_UNREST: f64 = 0.15;

/// Depth in metres that is added where something is divided by depth.
const THIN: f64 = 0.001;

/// How long a step is, and how many there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steps {
    pub(super) seconds: f64,
    pub(super) count: u64,
}

impl Fluvial {
    /// Years that pass in a second of flow.
    fn years_a_second(&self) -> f64 {
        self.duration / (self.flow_time * 3600.0)
    }

    /// The longest steps that are stable, so many that they fill the time.
    pub(super) fn steps(&self, cell: f64) -> Steps {
        let by_waves = COURANT * cell / (GRAVITY * self.deepest).sqrt();
        let diffusivity = (self.creep + self.slide) * self.years_a_second();
        let by_ground = MAX_UNREST * cell * cell / diffusivity.max(f64::MIN_POSITIVE);
        let time = self.flow_time * 3600.0;
        let count = (time / by_waves.min(by_ground)).ceil().max(1.0);
        Steps { seconds: time / count, count: count as u64 }
    }

    /// The numbers in cells and steps.
    fn constants(&self, cell: f64, strata: Option<&Strata>) -> FluvialConstants {
        let Steps { seconds, .. } = self.steps(cell);
        let years = self.years_a_second();
        let by_area = seconds / (cell * cell);
        let mut materials = [[0.0; 4]; MAX_MATERIALS];
        let strengths: Vec<_> = strata.into_iter().flat_map(Strata::all).collect();
        for (number, (row, strength)) in materials.iter_mut().zip(&strengths).enumerate() {
            let loose = f32::from(u8::from(number + 1 == strengths.len()));
            *row = [strength.softness, strength.repose, loose, 0.0];
        }
        FluvialConstants {
            materials,
            flow_rate: (GRAVITY * seconds * seconds / cell) as f32,
            deepest: (self.deepest / cell) as f32,
            friction: self.friction as f32,
            gathering: (self.gathering / cell) as f32,
            channel_width: (self.channel_width * (cell / seconds).sqrt()) as f32,
            lateral_wear: self.lateral_wear as f32,
            erodibility: (self.erodibility * years * cell) as f32,
            threshold: (self.threshold * by_area) as f32,
            settling: (self.settling * seconds / cell) as f32,
            thin: (THIN / cell) as f32,
            // Materials have their own.
            talus: if strata.is_some() { 1.0 } else { self.talus as f32 },
            slide: (self.slide * years * by_area) as f32,
            creep: (self.creep * years * by_area) as f32,
            open: f32::from(u8::from(self.boundary == Boundary::Open)),
            half: (self.cover / cell) as f32,
            padding_a: 0.0,
        }
    }

    pub(super) fn numbers(&self, cell: f64, strata: Option<Strata>) -> Numbers {
        Numbers {
            constants: self.constants(cell, strata.as_ref()),
            strata,
            rain_map: self.rain_map.is_some() || !self.sources.is_empty(),
            erodibility_map: self.erodibility_map.is_some(),
            evaporates: self.evaporation > 0.0,
        }
    }
}
