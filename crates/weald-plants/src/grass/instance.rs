//! A set where it stands, in 16 bytes, as it goes to a device.
//!
//! ```text
//! word 0       metres east of the north-western corner, as f32
//! word 1       metres south of it, as f32
//! word 2       soil: bits 0 to 9,  light: 10 to 19,  level of growth: 20 to 31
//! word 3       seed: bits 0 to 15,  species: 16 to 19,  cut: 20 to 25,  trodden: 26 to 31
//! ```
//!
//! A share is rounded to the nearest of its steps, 0 being 0 and all bits set being the whole: soil and light to 1/1023,
//! cut and trodden to 1/63, the level to 4/4095. Heights are those of the ground, which a device has anyway.

use super::blade::Set;

/// A set where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Metres east and south of the north-western corner of the landscape.
    pub place: [f32; 2],
    /// Number of its species among those of the grass, 0 to 15.
    pub species: u32,
    /// What grows there.
    pub tuft: Set,
}

/// An instance in 16 bytes.
pub type Packed = [u32; 4];

const TEN_BITS: f32 = 1023.0;
const SIX_BITS: f32 = 63.0;
const TWELVE_BITS: f32 = 4095.0;

impl Instance {
    /// The instance in 16 bytes.
    #[inline]
    pub fn pack(&self) -> Packed {
        let Set { soil, light, level, cut, trodden, seed } = self.tuft;
        let [east, south] = self.place;
        let ground =
            steps(soil, TEN_BITS) | steps(light, TEN_BITS) << 10 | steps(level * 0.25, TWELVE_BITS) << 20;
        let kind = seed & 0xffff | (self.species & 15) << 16;
        let wear = steps(cut, SIX_BITS) << 20 | steps(trodden, SIX_BITS) << 26;
        [east.to_bits(), south.to_bits(), ground, kind | wear]
    }

    /// What the bytes say.
    #[inline]
    pub fn unpack([east, south, ground, rest]: Packed) -> Self {
        Self {
            place: [f32::from_bits(east), f32::from_bits(south)],
            species: rest >> 16 & 15,
            tuft: Set {
                soil: (ground & 1023) as f32 * (1.0 / TEN_BITS),
                light: (ground >> 10 & 1023) as f32 * (1.0 / TEN_BITS),
                level: (ground >> 20) as f32 * (4.0 / TWELVE_BITS),
                cut: (rest >> 20 & 63) as f32 * (1.0 / SIX_BITS),
                trodden: (rest >> 26) as f32 * (1.0 / SIX_BITS),
                seed: rest & 0xffff,
            },
        }
    }
}

/// A share in whole steps.
#[inline]
fn steps(share: f32, most: f32) -> u32 {
    (share * most + 0.5).clamp(0.0, most) as u32
}
