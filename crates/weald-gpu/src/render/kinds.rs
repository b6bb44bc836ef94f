//! The kinds of light of the ground and of what lies behind it, and how the pixels of each are drawn: by comparing depths with
//! the kinds of a canvas (`ground.wgsl`).

use std::ops::Range;

use wgpu::{Color, CompareFunction, RenderPipeline};

/// A kind of light, the kinds of ground that have it, far away and close by, and what it is laid over.
#[derive(Debug)]
pub(super) struct Light {
    pub(super) fragment: &'static str,
    pub(super) kinds: [Range<u32>; 2],
    pub(super) over: Over,
}

/// Whether light is laid over what is there, by its own share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Over {
    /// It is all of the light.
    Nothing,
    /// It changes from picture to picture where it is close by.
    Flowing,
    /// It changes no more than the ground below.
    Still,
}

/// In the order in which they are drawn, with the kinds as `ground.wgsl` numbers them.
pub(super) const LIGHTS: [Light; 3] = [
    Light { fragment: "far_fragment", kinds: [9..11, NONE], over: Over::Nothing },
    Light { fragment: "near_fragment", kinds: [NONE, 11..13], over: Over::Nothing },
    Light { fragment: "water_fragment", kinds: [10..11, 11..12], over: Over::Flowing },
];

/// The same of the ground beyond the border, and of what it fades into.
pub(super) const LIGHTS_BEYOND: [Light; 4] = [
    Light { fragment: "far_beyond_fragment", kinds: [1..3, NONE], over: Over::Nothing },
    Light { fragment: "near_beyond_fragment", kinds: [NONE, 25..27], over: Over::Nothing },
    Light { fragment: "water_beyond_fragment", kinds: WET_BEYOND, over: Over::Flowing },
    Light { fragment: "farthest_fragment", kinds: [1..3, 25..27], over: Over::Still },
];

/// What lies behind the landscape.
pub(super) const BACKDROP: [Light; 2] = [
    Light { fragment: "sky_fragment", kinds: [17..18, NONE], over: Over::Nothing },
    Light { fragment: "plain_fragment", kinds: [18..19, NONE], over: Over::Nothing },
];

/// No kinds, and those of water beyond the border.
const NONE: Range<u32> = 0..0;
pub(super) const WET_BEYOND: [Range<u32>; 2] = [2..3, 25..26];

/// How much further the kinds behind edges are numbered, as the shader has it.
const BEHIND_EDGE: u32 = 4;

/// The first of all kinds and the last: in pixels of one sample several kinds at either end are one draw.
const FIRST_KIND: u32 = 1;
const LAST_KIND: u32 = 26;

/// What becomes of the opacity of ground under water, which says whether the next picture takes its light.
const STAYS: Color = Color::WHITE;
const FORGOTTEN: Color = Color::TRANSPARENT;

/// How the light of some kinds is drawn, of pixels of so many samples: how a pixel's kind compares to those that are drawn,
/// each by an instance.
fn drawn_as(kinds: Range<u32>, samples: u32) -> (CompareFunction, Range<u32>) {
    if samples == 1 && kinds.start == FIRST_KIND {
        (CompareFunction::GreaterEqual, kinds.end - 1..kinds.end)
    } else if samples == 1 && kinds.end == LAST_KIND + 1 {
        (CompareFunction::LessEqual, kinds.start..kinds.start + 1)
    } else {
        (CompareFunction::Equal, kinds)
    }
}

/// The light of some kinds.
#[derive(Debug)]
pub(super) struct KindsLight {
    pub(super) pipeline: RenderPipeline,
    pub(super) kinds: Range<u32>,
    /// Whether they are seen from close by.
    pub(super) is_near: bool,
    /// What becomes of the opacity of ground below.
    pub(super) ages: Color,
}

/// What is to be known of it before it is made.
#[derive(Clone, Copy, Debug)]
pub(super) struct KindsOf<'a> {
    pub(super) light: &'a Light,
    is_near: bool,
    pub(super) is_behind: bool,
}

impl KindsOf<'_> {
    /// Of all kinds of some lights, in their order; behind edges as well where pixels have several samples.
    pub(super) fn all(lights: &'static [Light], samples: u32) -> impl Iterator<Item = Self> {
        let behind: &[bool] = if samples > 1 { &[false, true] } else { &[false] };
        lights
            .iter()
            .flat_map(|light| behind.iter().map(move |&is_behind| (light, is_behind)))
            .flat_map(|(light, is_behind)| [false, true].map(|is_near| KindsOf { light, is_near, is_behind }))
            .filter(|of| !of.light.kinds[usize::from(of.is_near)].is_empty())
    }

    /// How it is drawn, of pixels of so many samples.
    pub(super) fn drawn(&self, samples: u32) -> (CompareFunction, Range<u32>) {
        let further = if self.is_behind { BEHIND_EDGE } else { 0 };
        let kinds = &self.light.kinds[usize::from(self.is_near)];
        drawn_as(kinds.start + further..kinds.end + further, samples)
    }

    /// Its light, by the pipeline that is made for it.
    pub(super) fn with(&self, pipeline: RenderPipeline, samples: u32) -> KindsLight {
        // Water that is close by flows: its pixels are no longer light of ground that the next picture takes.
        let flows = self.is_near && self.light.over == Over::Flowing;
        let ages = if flows { FORGOTTEN } else { STAYS };
        KindsLight { pipeline, kinds: self.drawn(samples).1, is_near: self.is_near, ages }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a draw of one instance meets a kind.
    fn meets(compare: CompareFunction, instance: u32, kind: u32) -> bool {
        match compare {
            CompareFunction::Equal => instance == kind,
            CompareFunction::GreaterEqual => instance >= kind,
            _ => instance <= kind,
        }
    }

    #[test]
    fn every_light_is_drawn_once_on_each_of_its_kinds_and_on_no_other() {
        for (samples, behind) in [(1, &[0][..]), (4, &[0, BEHIND_EDGE][..])] {
            let all = || KindsOf::all(&LIGHTS, samples).chain(KindsOf::all(&LIGHTS_BEYOND, samples));
            for light in LIGHTS.iter().chain(&LIGHTS_BEYOND) {
                for kind in FIRST_KIND..=LAST_KIND + behind[behind.len() - 1] {
                    let of_light = all().filter(|of| of.light.fragment == light.fragment);
                    let draws: usize = of_light
                        .map(|of| {
                            let (compare, instances) = of.drawn(samples);
                            instances.filter(|&instance| meets(compare, instance, kind)).count()
                        })
                        .sum();
                    let has = |further: &u32| {
                        light.kinds.iter().any(|kinds| kind >= *further && kinds.contains(&(kind - further)))
                    };
                    let wanted = usize::from(behind.iter().any(has));
                    assert_eq!(draws, wanted, "{} of kind {kind}, {samples} samples", light.fragment);
                }
            }
        }
    }
}
