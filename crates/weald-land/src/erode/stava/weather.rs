//! Water that comes and goes: springs, drains, rain, evaporation (Šťava et al. 2008).
//!
//! `w' = max(0, w + R r + q⁺ - q⁻ - E e)` with rain `R` and evaporation `E` a step, the painted shares `r` and
//! `e`, and the sources `q`, which drain where they are negative. A drain takes its water first, and with it what it
//! carries as transport does: the share `min(w + R r, q⁻) / (w + R r + ε)` of the sediment, of which the source says nothing.

use super::Stava;
use crate::erode::pipes::without_negligible;
use crate::erode::sums;
use crate::erode::water_planes as plane;
use weald_engine::kernel;
use weald_engine::stencil::chain::Flow;

kernel! {
    /// Depth after the weather, what came and what went, as they changed the depth.
    pub(crate) struct Weathered {
        reads { before, rain_share, evaporation_share, source, valid }
        updates {}
        writes { depth, gained, lost }
        constants { rain: f32, evaporation: f32 }
    }
    fn cell() {
        let wet = before + (rain * rain_share + source.max(0.0)) * valid;
        let dried = (evaporation * evaporation_share + (-source).max(0.0)) * valid;
        depth = without_negligible(wet - dried.min(wet));
        gained = wet - before;
        lost = depth - wet;
    }
}

kernel! {
    /// Sediment that drains leave, and what they take.
    pub(crate) struct Drained {
        reads { before, rain_share, source, valid, found }
        updates {}
        writes { kept, taken }
        constants { rain: f32, epsilon: f32 }
    }
    fn cell() {
        let wet = before + (rain * rain_share + source.max(0.0)) * valid;
        let drained = ((-source).max(0.0) * valid).min(wet);
        kept = found - found * (drained / (wet + epsilon));
        taken = found - kept;
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
        let [gained, lost] = &mut scratch.tally;
        Weathered {
            before: flow.input[plane::DEPTH].here(y),
            rain_share,
            evaporation_share,
            source,
            valid: self.setting.links.row(flow.constants, y).valid,
            depth: scratch.rained.here_mut(y),
            gained: gained.here_mut(0),
            lost: lost.here_mut(0),
            rain: flow.weather.rain,
            evaporation: flow.weather.evaporation,
        }
        .run(self.setting.arch);
        flow.sums.add(y, sums::RAINED, gained.here(0));
        flow.sums.add(y, sums::EVAPORATED, lost.here(0));
    }

    /// Takes from a row the sediment of the water that drains take.
    pub(super) fn drain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let [rain_share, _, source] = &flow.constants[self.setting.constant_planes()..] else { return };
        let scratch = &mut *flow.scratch;
        Drained {
            before: flow.input[plane::DEPTH].here(y),
            rain_share: rain_share.here(y),
            source: source.here(y),
            valid: self.setting.links.row(flow.constants, y).valid,
            found: flow.input[plane::SEDIMENT].here(y),
            kept: scratch.found.here_mut(y),
            taken: scratch.tally[0].here_mut(0),
            rain: flow.weather.rain,
            epsilon: self.constants.epsilon,
        }
        .run(self.setting.arch);
        flow.sums.add(y, sums::SEDIMENT_OUT, scratch.tally[0].here(0));
    }
}
