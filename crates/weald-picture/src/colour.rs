//! Colour spaces: sRGB as files hold it, linear light for mixing, Oklab for ramps that look even.
//!
//! Oklab: `lms = M1 · rgb`, `lab = M2 · cbrt(lms)` (Björn Ottosson 2020, "A perceptual color space for image
//! processing", public domain). Equal distances in it look equally far apart.

use std::sync::LazyLock;

/// Red, green and blue in linear light, 0 to 1, sRGB primaries.
pub type Linear = [f32; 3];

/// Warm white: the sheet where there is no data.
pub const PAPER: Linear = [0.923, 0.896, 0.830];

/// A colour by lightness and two opponent axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oklab {
    /// 0 black to 1 white.
    pub lightness: f64,
    /// Green (negative) to red.
    pub a: f64,
    /// Blue (negative) to yellow.
    pub b: f64,
}

impl Oklab {
    /// From linear light.
    pub fn of(colour: Linear) -> Self {
        let [r, g, b] = colour.map(f64::from);
        let l = libm::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
        let m = libm::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
        let s = libm::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
        Self {
            lightness: 0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            a: 1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            b: 0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        }
    }

    /// To linear light; what a screen cannot show is cut off.
    pub fn linear(self) -> Linear {
        let Self { lightness, a, b } = self;
        let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
        let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
        let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
        let channels = [
            4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
            -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
            -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
        ];
        channels.map(|channel| channel.clamp(0.0, 1.0) as f32)
    }

    /// How far apart two colours look; 0.02 is about the least difference that the eye sees.
    pub fn distance(self, other: Self) -> f64 {
        let [l, a, b] = [self.lightness - other.lightness, self.a - other.a, self.b - other.b];
        (l * l + a * a + b * b).sqrt()
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// Linear light of an sRGB colour written as `0xrrggbb`.
pub fn linear_of_hex(hex: u32) -> Linear {
    [16, 8, 0].map(|shift| linear_of_channel(f64::from((hex >> shift) & 0xff) / 255.0))
}

/// Linear light of an sRGB colour, 0 to 1.
pub fn linear_of_srgb(colour: [f32; 3]) -> Linear {
    colour.map(|channel| linear_of_channel(f64::from(channel)))
}

fn linear_of_channel(encoded: f64) -> f32 {
    let linear =
        if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
    linear as f32
}

/// `from` at `share` 0, `to` at 1, mixed as light mixes.
#[inline]
pub(super) fn mix(from: Linear, to: Linear, share: f32) -> Linear {
    std::array::from_fn(|c| from[c] + (to[c] - from[c]) * share)
}

/// Entries of the encoding table: fine enough that no step of sRGB's dark end is skipped.
const ENCODED: usize = 1 << 14;

static ENCODE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encode = |index: usize| {
        let linear = index as f64 / (ENCODED - 1) as f64;
        let encoded =
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 };
        (encoded * 255.0 + 0.5) as u8
    };
    (0..ENCODED).map(encode).collect()
});

/// The sRGB bytes of a colour in linear light; a NaN comes out black.
#[inline]
pub fn encode(colour: Linear) -> [u8; 3] {
    let table = &*ENCODE;
    colour.map(|channel| table[(channel.clamp(0.0, 1.0) * (ENCODED - 1) as f32 + 0.5) as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grey_byte_survives_linear_light() {
        for byte in 0..=255_u32 {
            let colour = linear_of_hex(byte << 16 | byte << 8 | byte);
            assert_eq!(encode(colour), [byte as u8; 3]);
        }
    }

    #[test]
    fn oklab_of_white_is_one_and_without_hue() {
        let white = Oklab::of([1.0; 3]);
        assert!((white.lightness - 1.0).abs() < 1e-6 && white.a.abs() < 1e-6 && white.b.abs() < 1e-6);
    }

    #[test]
    fn oklab_and_back_is_the_same_colour() {
        for hex in [0x00ff_0000, 0x0012_3456, 0x00c0_ffee, 0x0080_4020] {
            assert_eq!(encode(Oklab::of(linear_of_hex(hex)).linear()), encode(linear_of_hex(hex)));
        }
    }
}
