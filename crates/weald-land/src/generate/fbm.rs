//! Fractional Brownian motion: noise at shrinking wavelengths, added.
//!
//! ```text
//! z = relief (1/2 + Σ gain^k n(p lacunarity^k / wavelength) / (6 σ))
//! ```
//!
//! where `σ` is the standard deviation of the sum, a number that follows from the octaves alone. So `relief`
//! is not stretched to each landscape's own extremes: it is six standard deviations, about what a landscape
//! of some wavelengths spans, and the same ground comes at any size and resolution.
//!
//! Mandelbrot and Van Ness 1968, doi 10.1137/1010093; Musgrave, Kolb, Mace 1989, doi 10.1145/74333.74337.

use std::ops::Range;

use super::noise::Window;
use super::octaves::{OctavePass, Spectrum, fill_rows, part, window};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::on_device::OnDevice;
use weald_engine::program::Uniforms;
use weald_engine::step::{Entry, Stage};
use weald_engine::uniform;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Fbm>(
    "fbm",
    Stage::Generate,
    "rolling ground: noise at shrinking wavelengths, added",
    "Musgrave, Kolb, Mace 1989",
);

/// Standard deviations that stand for the whole relief.
pub const DEVIATIONS: f64 = 6.0;

parameters! {
    /// Fractional Brownian motion.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::fbm::Fbm;
    /// let fbm = Fbm { relief: 500.0, wavelength: 400.0, ..Fbm::default() };
    /// let mut part = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// let mut whole = Landscape::new(Domain::new(Size::new(80, 60)?, 10.0));
    /// fbm.run(&mut part, &Job::unwatched(7))?; // 7 is the seed
    /// fbm.run(&mut whole, &Job::unwatched(7))?;
    /// assert_eq!(part.field("height")?.at(5, 3), whole.field("height")?.at(5, 3), "the same ground at any size");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Fbm {
        /// Height that a landscape of some wavelengths spans: six standard deviations, around a mean of half.
        relief: f64 = 1000.0, range 0.0..=1.0e6, unit "m";
        /// Length of the largest hills and valleys.
        wavelength: f64 = 5000.0, range 1.0e-3..=1.0e9, unit "m";
        /// Number of wavelengths added.
        octaves: u32 = 8, range 1..=16;
        /// Height of each octave relative to the one before: 0.5 is rolling, 0.7 rugged.
        gain: f64 = 0.5, range 0.0..=1.0;
        /// How many times shorter each octave's wavelength is than the one before.
        lacunarity: f64 = 2.0, range 1.0..=8.0;
        /// A seed of its own. Without it the landscape's is used, varied for each step.
        seed: Option<u64> = None, range 0..=9_007_199_254_740_991_i64;
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

uniform! {
    /// What the shader has to know.
    struct FbmConstants {
        octaves: u32,
        rows: u32,
        middle: f32,
        scale: f32,
    }
}

impl Generator for Fbm {
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error> {
        Ok(self.over(domain, &window(domain), seed))
    }

    fn fill_rows(&self, domain: &Domain, seed: u64, rows: Range<usize>) -> Option<Field> {
        let (part, window) = part(domain, rows);
        Some(self.over(&part, &window, seed))
    }

    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        let pass = OctavePass {
            name: "fbm",
            shaders: &[include_str!("fbm.wgsl")],
            constants: Uniforms::of(&self.constants(domain)),
            octaves: self.spectrum().over(&window(domain), seed),
        };
        Some(pass.on_device(domain))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }

    fn own_seed(&self) -> Option<u64> {
        self.seed
    }

    fn iterations(&self) -> u64 {
        u64::from(self.octaves)
    }
}

impl Fbm {
    fn over(&self, domain: &Domain, window: &Window, seed: u64) -> Field {
        let octaves = self.spectrum().over(window, seed);
        let FbmConstants { middle, scale, .. } = self.constants(domain);
        fill_rows(
            domain,
            #[inline(always)]
            |y, row| {
                for (octave, amplitude) in &octaves {
                    octave.add_row(y, *amplitude, row);
                }
                for value in row {
                    *value = middle + scale * *value;
                }
            },
        )
    }

    fn spectrum(&self) -> Spectrum {
        let Self { octaves, wavelength, gain, lacunarity, .. } = *self;
        Spectrum { octaves, wavelength, gain, lacunarity }
    }

    fn constants(&self, domain: &Domain) -> FbmConstants {
        let middle = (self.relief / 2.0) as f32;
        let scale = (self.relief / (DEVIATIONS * self.spectrum().deviation())) as f32;
        FbmConstants { octaves: self.octaves, rows: domain.size.rows as u32, middle, scale }
    }
}
