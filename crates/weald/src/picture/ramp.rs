//! Colour ramps whose steps look equally large: a smooth path through a few colours in Oklab, cut into
//! pieces of equal length.

use super::colour::{Linear, Oklab, linear_of_hex, mix};

crate::choices! {
    /// Colours of heights in a relief picture, low to high.
    pub enum Tint {
        /// Green lowland over ochre and brown to white summits, as in school atlases.
        Hypsometric = "hypsometric",
        /// Hazy blue-green valleys that clear to warm, bright heights, as in Swiss relief maps.
        Alpine = "alpine",
        /// Pale sand over orange and red rock.
        Desert = "desert",
        /// Paper grey, for shading alone.
        Grey = "grey",
    }
}

crate::choices! {
    /// Colours of values in a map of one layer, low to high.
    pub enum Scale {
        /// Dark blue over green to yellow, lightness rising evenly.
        Meadow = "meadow",
        /// Paper white to deep blue, for depths and flows.
        Water = "water",
        /// Black over red to pale yellow, for amounts eroded.
        Ember = "ember",
        /// Black to white.
        Grey = "grey",
    }
}

impl Tint {
    /// The ramp itself.
    pub fn ramp(self) -> Ramp {
        Ramp::through(match self {
            Self::Hypsometric => {
                &[0x5c_9462, 0x8f_b573, 0xd2_d688, 0xe6_c583, 0xc8_9a6a, 0xb3_8c74, 0xd5_cac2, 0xf1_f0ef]
            }
            Self::Alpine => &[0x6f_9590, 0x8f_ae8e, 0xb9_c68f, 0xdd_d39d, 0xe9_d6b4, 0xea_ddcf, 0xef_ebe6],
            Self::Desert => &[0xe6_d2a0, 0xdd_b274, 0xc8_8450, 0xa8_6044, 0x8a_4f4a],
            Self::Grey => &[0xc6_c6c2, 0xf4_f3ef],
        })
    }
}

impl Scale {
    /// The ramp itself.
    pub fn ramp(self) -> Ramp {
        Ramp::through(match self {
            Self::Meadow => &[0x23_1a4a, 0x2c_4a7c, 0x27_7d80, 0x4f_ac6c, 0xa9_d155, 0xfb_ec6b],
            Self::Water => &[0xf7_f4ec, 0xb5_d3de, 0x68_a6c8, 0x2d_70a8, 0x16_3a73, 0x0b_1a44],
            Self::Ember => &[0x12_0a12, 0x55_1327, 0xa4_2f26, 0xdd_6b2c, 0xf5_b45c, 0xfd_f3c4],
            Self::Grey => &[0x00_0000, 0xff_ffff],
        })
    }
}

/// Pieces of the table that [`Ramp::at`] interpolates.
const PIECES: usize = 1024;

/// Points on each stretch between two stops from which lengths are measured.
const POINTS_A_STRETCH: usize = 512;

/// A continuous ramp of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    table: Vec<Linear>,
}

impl Ramp {
    /// A ramp through two or more sRGB colours, written as `0xrrggbb`.
    pub fn through(stops: &[u32]) -> Self {
        let stops: Vec<Oklab> = stops.iter().map(|&hex| Oklab::of(linear_of_hex(hex))).collect();
        let points = (stops.len() - 1) * POINTS_A_STRETCH;
        let path: Vec<Oklab> =
            (0..=points).map(|i| curve(&stops, i as f64 / POINTS_A_STRETCH as f64)).collect();
        Self { table: evenly(&path) }
    }

    /// The colour at `share`, 0 to 1; beyond, the colour of the nearer end.
    #[inline]
    pub fn at(&self, share: f32) -> Linear {
        let position = share.clamp(0.0, 1.0) * PIECES as f32;
        let piece = (position as usize).min(PIECES - 1);
        mix(self.table[piece], self.table[piece + 1], position - piece as f32)
    }
}

/// Colours at equal distances along a path.
fn evenly(path: &[Oklab]) -> Vec<Linear> {
    let mut lengths = vec![0.0];
    for pair in path.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let whole = lengths[lengths.len() - 1];
    let colour = |piece: usize| {
        let wanted = whole * piece as f64 / PIECES as f64;
        let next = lengths.partition_point(|&length| length < wanted).clamp(1, path.len() - 1);
        let gap = lengths[next] - lengths[next - 1];
        let share = if gap > 0.0 { (wanted - lengths[next - 1]) / gap } else { 0.0 };
        between(path[next - 1], path[next], share).linear()
    };
    (0..=PIECES).map(colour).collect()
}

fn between(from: Oklab, to: Oklab, share: f64) -> Oklab {
    Oklab {
        lightness: from.lightness + (to.lightness - from.lightness) * share,
        a: from.a + (to.a - from.a) * share,
        b: from.b + (to.b - from.b) * share,
    }
}

/// Uniform cubic B-spline over `stops` at `position`, counted in stops: it starts and ends on the outer stops
/// and turns gently near the others, so that none shows as a crease.
fn curve(stops: &[Oklab], position: f64) -> Oklab {
    let last = stops.len() - 1;
    let start = (position as usize).min(last - 1);
    let t = position - start as f64;
    let weights = [
        (1.0 - t) * (1.0 - t) * (1.0 - t),
        (3.0 * t - 6.0) * t * t + 4.0,
        ((3.0 - 3.0 * t) * t + 3.0) * t + 1.0,
        t * t * t,
    ];
    let before = if start == 0 { between(stops[0], stops[1], -1.0) } else { stops[start - 1] };
    let after = if start + 1 == last { between(stops[last], stops[start], -1.0) } else { stops[start + 2] };
    let mut sum = Oklab { lightness: 0.0, a: 0.0, b: 0.0 };
    for (weight, stop) in weights.iter().zip([before, stops[start], stops[start + 1], after]) {
        sum.lightness += weight / 6.0 * stop.lightness;
        sum.a += weight / 6.0 * stop.a;
        sum.b += weight / 6.0 * stop.b;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramps() -> Vec<(&'static str, Ramp)> {
        let tints = [Tint::Hypsometric, Tint::Alpine, Tint::Desert, Tint::Grey];
        let scales = [Scale::Meadow, Scale::Water, Scale::Ember, Scale::Grey];
        let tints = tints.map(|tint| (tint.word(), tint.ramp()));
        tints.into_iter().chain(scales.map(|scale| (scale.word(), scale.ramp()))).collect()
    }

    #[test]
    fn every_step_of_every_ramp_looks_equally_large() {
        for (name, ramp) in ramps() {
            let colours: Vec<_> = (0..=64).map(|i| Oklab::of(ramp.at(i as f32 / 64.0))).collect();
            let steps: Vec<_> = colours.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
            let mean = steps.iter().sum::<f64>() / steps.len() as f64;
            let worst = steps.iter().map(|step| (step / mean - 1.0).abs()).fold(0.0, f64::max);
            assert!(mean > 0.001 && worst < 0.1, "{name}: a step is off by {worst:.3} of the mean");
        }
    }

    #[test]
    fn lightness_rises_or_falls_all_along_every_ramp_but_those_of_natural_ground() {
        for (name, ramp) in ramps().into_iter().filter(|(name, _)| *name != "hypsometric") {
            let light: Vec<_> = (0..=64).map(|i| Oklab::of(ramp.at(i as f32 / 64.0)).lightness).collect();
            let rising = light[64] > light[0];
            assert!(light.windows(2).all(|pair| (pair[1] > pair[0]) == rising), "{name}: {light:?}");
        }
    }
}
