//! Colours of fractals: ramps in Oklab from the oldest to the youngest part, far parts paler with distance.

use super::super::colour::{Linear, mix};
use super::super::ramp::Ramp;

weald_core::choices! {
    /// Colours from the stem of a plant, or the first map of a set, to the last.
    pub enum Palette {
        /// Fresh greens: dark in the stem and along the ribs, yellow-green in the youngest leaflets.
        Fern = "fern",
        /// The blue-greens of a spruce.
        Spruce = "spruce",
        /// Leaves in October, from brown over red to gold.
        Autumn = "autumn",
        /// Browns and greys of bark and winter twigs.
        Bark = "bark",
        /// Deep violet over red to pale yellow.
        Ember = "ember",
        /// Deep blue over turquoise to nearly white.
        Ice = "ice",
        /// All hues at even lightness, to tell maps apart.
        Hues = "hues",
        /// Near black alone.
        Ink = "ink",
    }
}

impl Palette {
    fn ramp(self) -> Ramp {
        Ramp::through(match self {
            Self::Fern => &[0x2a_2e14, 0x14_3f20, 0x20_662a, 0x41_8f2f, 0x7c_b637, 0xb8_d352],
            Self::Spruce => &[0x3a_2c1e, 0x14_3a34, 0x1f_5a48, 0x3a_7d61, 0x70_a384, 0xb0_cbaa],
            Self::Autumn => &[0x3a_2014, 0x7a_2418, 0xb5_3a1a, 0xd9_6a1e, 0xe8_a22c, 0xf2_d25a],
            Self::Bark => &[0x22_1a16, 0x4a_382c, 0x75_5e4a, 0x9c_8770, 0xc4_b49e],
            Self::Ember => &[0x2a_0f3a, 0x6d_1a4d, 0xb5_2a3e, 0xe4_6a2e, 0xf6_b04a, 0xfc_e89a],
            Self::Ice => &[0x12_1f5a, 0x1d_4c9a, 0x2a_86c0, 0x54_b8cf, 0x9c_dcdc, 0xe2_f4f0],
            Self::Hues => &[0xd6_4a4a, 0xc9_8a1e, 0x6f_a838, 0x1f_a890, 0x3a_86d0, 0x8f_62c8, 0xd0_4f9a],
            Self::Ink => &[0x14_1412, 0x1a_1a18],
        })
    }
}

/// Places on a palette.
pub(super) const PLACES: usize = 256;

/// Steps from the farthest to the nearest.
pub(super) const STEPS: usize = 16;

/// Share of the haze in the colour of the farthest part.
const HAZE: f32 = 0.15;

/// A colour of a [`Table`]: a place on the palette, and how near.
pub(super) type PaletteIndex = u16;

/// The colour at a place, a 16-bit share, and a nearness of 0 to 1.
#[inline]
pub(super) fn palette_index(place: u16, nearness: f64) -> PaletteIndex {
    (place >> 8) * STEPS as u16 + (nearness * (STEPS as f64 - 1.0) + 0.5) as u16
}

/// All colours of a picture, in linear light.
#[derive(Clone, Debug)]
pub(super) struct Table(Vec<Linear>);

impl Table {
    /// A palette, or one ink, whose far parts fade into `haze`.
    pub(super) fn new(palette: Palette, ink: Option<Linear>, haze: Linear) -> Self {
        let ramp = palette.ramp();
        let colour = |place: usize| ink.unwrap_or_else(|| ramp.at(place as f32 / (PLACES - 1) as f32));
        let faded = |place: usize, step: usize| {
            let far = 1.0 - step as f32 / (STEPS - 1) as f32;
            mix(colour(place), haze, HAZE * far)
        };
        Self(
            (0..PLACES)
                .flat_map(|place| (0..STEPS).map(move |step| (place, step)))
                .map(|(p, s)| faded(p, s))
                .collect(),
        )
    }

    #[inline]
    pub(super) fn colour(&self, palette_index: PaletteIndex) -> Linear {
        self.0[usize::from(palette_index)]
    }

    /// The same in 16 bits a channel, for sums.
    pub(super) fn whole_numbers(&self) -> Vec<[u16; 3]> {
        self.0.iter().map(|colour| colour.map(|channel| (channel * 65535.0 + 0.5) as u16)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_part_has_the_colour_of_the_palette_and_the_farthest_a_little_of_the_haze() {
        let white = [1.0; 3];
        let table = Table::new(Palette::Fern, None, white);
        let ramp = Palette::Fern.ramp();
        assert_eq!(table.colour(palette_index(0, 1.0)), ramp.at(0.0));
        assert_eq!(table.colour(palette_index(u16::MAX, 1.0)), ramp.at(1.0));
        let far = table.colour(palette_index(0, 0.0));
        assert!(far.iter().all(|channel| (0.15..0.20).contains(channel)), "{far:?}");
    }

    #[test]
    fn an_ink_is_one_colour() {
        let table = Table::new(Palette::Fern, Some([0.25, 0.5, 0.75]), [0.0; 3]);
        assert!(
            [0, 300, 40_000]
                .iter()
                .all(|&place| table.colour(palette_index(place, 1.0)) == [0.25, 0.5, 0.75])
        );
    }
}
