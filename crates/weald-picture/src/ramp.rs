//! Colour ramps whose steps look equally large: a smooth path through a few colours in Oklab, cut into
//! pieces of equal length.

use super::colour::{Linear, Oklab, linear_of_hex, mix};

weald_core::choices! {
    /// Colours of heights in a relief picture, low to high.
    pub enum Tint {
        /// Green lowland over ochre and brown to white summits, as in school atlases.
        Hypsometric = "hypsometric",
        /// Hazy blue-green valleys that clear to warm, bright heights, as in Swiss relief maps.
        Alpine = "alpine",
        /// Deep green over ochre to nearly white, lightness rising all the way: equal steps of height look equal.
        Even = "even",
        /// Pale sand over orange and red rock.
        Desert = "desert",
        /// Paper grey, for shading alone.
        Grey = "grey",
    }
}

weald_core::choices! {
    /// Colours of values in a map of one layer, low to high.
    pub enum Scale {
        /// Dark blue over green to yellow, lightness rising evenly.
        Meadow = "meadow",
        /// Paper white to deep blue, for depths and flows.
        Water = "water",
        /// Black over red to pale yellow, for amounts eroded.
        Ember = "ember",
        /// Deep blue over paper white to deep red, equally far from the middle to both ends: for gains and losses,
        /// hollows and ridges.
        Balance = "balance",
        /// A round from white over blue, dark and red back to white: for directions, north white and south dark.
        Compass = "compass",
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
            Self::Even => &[0x2f_5d62, 0x4f_8a5b, 0xa3_ad5c, 0xdc_b777, 0xef_d9c3, 0xfb_f7f4],
            Self::Desert => &[0xe6_d2a0, 0xdd_b274, 0xc8_8450, 0xa8_6044, 0x8a_4f4a],
            Self::Grey => &[0xc6_c6c2, 0xf4_f3ef],
        })
    }
}

impl Scale {
    /// Whether its middle colour stands for 0.
    pub fn is_centred(self) -> bool {
        self == Self::Balance
    }

    /// The ramp itself.
    pub fn ramp(self) -> Ramp {
        Ramp::through(match self {
            Self::Balance => return Ramp::centred(&BALANCE_LOW, &BALANCE_HIGH),
            Self::Compass => return Ramp::closed(&[0xef_e6dc, 0x6f_93c4, 0x2d_1f4f, 0xb4_554d]),
            Self::Meadow => &[0x23_1a4a, 0x2c_4a7c, 0x27_7d80, 0x4f_ac6c, 0xa9_d155, 0xfb_ec6b],
            Self::Water => &[0xf7_f4ec, 0xb5_d3de, 0x68_a6c8, 0x2d_70a8, 0x16_3a73, 0x0b_1a44],
            Self::Ember => &[0x12_0a12, 0x55_1327, 0xa4_2f26, 0xdd_6b2c, 0xf5_b45c, 0xfd_f3c4],
            Self::Grey => &[0x00_0000, 0xff_ffff],
        })
    }
}

/// The halves of the ramp for gains and losses, of equal length in Oklab.
const BALANCE_LOW: [u32; 4] = [0x14_355e, 0x3f_7fb0, 0xa9_cbd8, 0xf6_f2ea];
const BALANCE_HIGH: [u32; 4] = [0xf6_f2ea, 0xe8_b98a, 0xb9_602f, 0x5c_1f1a];

/// Pieces of the table that [`Ramp::at`] interpolates.
const PIECES: usize = 1024;

/// Points on each stretch between two stops from which lengths are measured.
const POINTS_PER_SEGMENT: usize = 512;

/// A continuous ramp of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    table: Vec<Linear>,
}

impl Ramp {
    /// A ramp through two or more sRGB colours, written as `0xrrggbb`.
    pub fn through(stops: &[u32]) -> Self {
        let (stops, points) = (oklab(stops), (stops.len() - 1) * POINTS_PER_SEGMENT);
        let path: Vec<Oklab> =
            (0..=points).map(|i| curve(&stops, i as f64 / POINTS_PER_SEGMENT as f64)).collect();
        Self { table: evenly(&path, PIECES) }
    }

    /// A ramp of two halves, the last colour of the first of which is the first of the second and lies in the very
    /// middle.
    fn centred(low: &[u32], high: &[u32]) -> Self {
        let half = |stops: &[u32]| {
            let (stops, points) = (oklab(stops), (stops.len() - 1) * POINTS_PER_SEGMENT);
            let path: Vec<Oklab> =
                (0..=points).map(|i| curve(&stops, i as f64 / POINTS_PER_SEGMENT as f64)).collect();
            evenly(&path, PIECES / 2)
        };
        let mut table = half(low);
        table.pop();
        table.extend(half(high));
        Self { table }
    }

    /// A ramp that comes back to its first colour, which it passes near.
    fn closed(stops: &[u32]) -> Self {
        let round = oklab(stops);
        let points = stops.len() * POINTS_PER_SEGMENT;
        let path: Vec<Oklab> = (0..=points)
            .map(|i| {
                let place = i as f64 / POINTS_PER_SEGMENT as f64;
                let start = (place as usize).min(stops.len() - 1);
                blend(
                    &[0, 1, 2, 3].map(|k| round[(start + stops.len() + k - 1) % stops.len()]),
                    place - start as f64,
                )
            })
            .collect();
        Self { table: evenly(&path, PIECES) }
    }

    /// The colour at `share`, 0 to 1; beyond, the colour of the nearer end.
    #[inline]
    pub fn at(&self, share: f32) -> Linear {
        let position = share.clamp(0.0, 1.0) * PIECES as f32;
        let piece = (position as usize).min(PIECES - 1);
        mix(self.table[piece], self.table[piece + 1], position - piece as f32)
    }
}

fn oklab(stops: &[u32]) -> Vec<Oklab> {
    stops.iter().map(|&hex| Oklab::of(linear_of_hex(hex))).collect()
}

/// Colours at `pieces` + 1 equal distances along a path.
fn evenly(path: &[Oklab], pieces: usize) -> Vec<Linear> {
    let mut lengths = vec![0.0];
    for pair in path.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let whole = lengths[lengths.len() - 1];
    let colour = |piece: usize| {
        let wanted = whole * piece as f64 / pieces as f64;
        let next = lengths.partition_point(|&length| length < wanted).clamp(1, path.len() - 1);
        let gap = lengths[next] - lengths[next - 1];
        let share = if gap > 0.0 { (wanted - lengths[next - 1]) / gap } else { 0.0 };
        between(path[next - 1], path[next], share).linear()
    };
    (0..=pieces).map(colour).collect()
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
    let before = if start == 0 { between(stops[0], stops[1], -1.0) } else { stops[start - 1] };
    let after = if start + 1 == last { between(stops[last], stops[start], -1.0) } else { stops[start + 2] };
    blend(&[before, stops[start], stops[start + 1], after], t)
}

/// The uniform cubic B-spline of four colours.
fn blend(stops: &[Oklab; 4], t: f64) -> Oklab {
    let weights = [
        (1.0 - t) * (1.0 - t) * (1.0 - t),
        (3.0 * t - 6.0) * t * t + 4.0,
        ((3.0 - 3.0 * t) * t + 3.0) * t + 1.0,
        t * t * t,
    ];
    let mut sum = Oklab { lightness: 0.0, a: 0.0, b: 0.0 };
    for (weight, stop) in weights.iter().zip(stops) {
        sum.lightness += weight / 6.0 * stop.lightness;
        sum.a += weight / 6.0 * stop.a;
        sum.b += weight / 6.0 * stop.b;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::colour::encode;
    use super::*;

    fn ramps() -> Vec<(&'static str, Ramp)> {
        let tints = [Tint::Hypsometric, Tint::Alpine, Tint::Even, Tint::Desert, Tint::Grey];
        let scales = [Scale::Meadow, Scale::Water, Scale::Ember, Scale::Balance, Scale::Compass, Scale::Grey];
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
        for (name, ramp) in ramps() {
            if ["hypsometric", "balance", "compass"].contains(&name) {
                continue;
            }
            let light: Vec<_> = (0..=64).map(|i| Oklab::of(ramp.at(i as f32 / 64.0)).lightness).collect();
            let rising = light[64] > light[0];
            assert!(light.windows(2).all(|pair| (pair[1] > pair[0]) == rising), "{name}: {light:?}");
        }
    }

    #[test]
    fn the_balance_is_lightest_in_its_middle_and_as_dark_at_one_end_as_at_the_other() {
        let ramp = Scale::Balance.ramp();
        let light = |share: f32| Oklab::of(ramp.at(share)).lightness;
        assert!((0..32).all(|i| light(i as f32 / 64.0) < light((i + 1) as f32 / 64.0)));
        assert!((32..64).all(|i| light(i as f32 / 64.0) > light((i + 1) as f32 / 64.0)));
        let ends = [0.0, 0.25].map(|share| light(share) - light(1.0 - share));
        assert!(ends.iter().all(|difference| difference.abs() < 0.03), "{ends:?}");
        assert_eq!(encode(ramp.at(0.5)), [0xf6, 0xf2, 0xea]);
    }

    #[test]
    fn the_compass_ends_where_it_begins_and_tells_opposite_directions_apart() {
        let ramp = Scale::Compass.ramp();
        assert_eq!(encode(ramp.at(0.0)), encode(ramp.at(1.0)));
        for i in 0..32 {
            let [here, opposite] = [0.0, 0.5].map(|turn| Oklab::of(ramp.at(i as f32 / 64.0 + turn)));
            let apart = here.distance(opposite);
            assert!(apart > 0.12, "{apart} at {i} of 64");
        }
    }
}
