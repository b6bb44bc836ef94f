//! Water that comes and goes: springs, drains, rain, evaporation (Šťava et al. 2008).
//!
//! `w' = max(0, w + R r + q⁺ - q⁻ - E e)` with rain `R` and evaporation `E` a step, the painted shares `r` and
//! `e`, and the sources `q`, which drain where they are negative.

use super::{Stava, plane};
use crate::erode::pipes::worth_counting;
use crate::erode::sums;
use weald_engine::kernel;
use weald_engine::stencil::chain::Flow;

kernel! {
    /// Depth after the weather, what came and what went, as they changed the depth.
    pub(crate) struct Weathered {
        reads { before, rain_share, evaporation_share, source, land }
        updates {}
        writes { depth, came, went }
        constants { rain: f32, evaporation: f32 }
    }
    fn cell() {
        let wet = before + (rain * rain_share + source.max(0.0)) * land;
        let dried = (evaporation * evaporation_share + (-source).max(0.0)) * land;
        depth = worth_counting(wet - dried.min(wet));
        came = wet - before;
        went = depth - wet;
    }
}

impl Stava {
    pub(super) fn weather(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let (ones, still) = (scratch.ones.here(0), scratch.still.here(0));
        let [rain_share, evaporation_share, source] = match &flow.constants[self.setting.constant_planes()..]
        {
            [rain, evaporation, source] => [rain, evaporation, source].map(|plane| plane.here(y)),
            _ => [ones, ones, still],
        };
        let [came, went] = &mut scratch.tally;
        Weathered {
            before: flow.input[plane::DEPTH].here(y),
            rain_share,
            evaporation_share,
            source,
            land: self.setting.links.row(flow.constants, y).land,
            depth: scratch.rained.here_mut(y),
            came: came.here_mut(0),
            went: went.here_mut(0),
            rain: flow.weather.rain,
            evaporation: flow.weather.evaporation,
        }
        .run(self.setting.arch);
        flow.sums.add(y, sums::RAINED, came.here(0));
        flow.sums.add(y, sums::EVAPORATED, went.here(0));
    }
}
