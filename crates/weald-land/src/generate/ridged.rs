//! Ridged multifractal: noise folded at 0, so that its zero lines become crests; an octave shows where the
//! one before is high, so that crests are rough and valleys smooth.
//!
//! ```text
//! s_k = w_k (1 - |n_k|)²     w_0 = 1, w_k = clamp(sharpness s_{k-1}, 0, 1)     z = relief Σ gain^k s_k / Σ gain^k
//! ```
//!
//! Musgrave, in Ebert et al., "Texturing and Modeling", 3rd ed. 2003, chapter 16 (`RidgedMultifractal`,
//! offset 1). Heights lie between 0 and `relief` by construction. What differs: amplitudes are given by
//! `gain` in place of the exponent `H`, as for `fbm`.

use std::ops::Range;

use super::noise::{Octave, Window};
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
pub const ENTRY: Entry = Entry::of::<Ridged>(
    "ridged",
    Stage::Generate,
    "mountain crests: noise folded at zero, rough on top and smooth below",
    "Musgrave, in Ebert et al. 2003, chapter 16",
);

parameters! {
    /// Ridged multifractal.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::ridged::Ridged;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(64, 64)?, 10.0)); // columns, rows, metres
    /// let ridged = Ridged { relief: 400.0, wavelength: 200.0, ..Ridged::default() };
    /// ridged.run(&mut landscape, &Job::unwatched(7))?; // 7 is the seed
    /// let (lowest, highest) = landscape.field("height")?.range(None).expect("there are cells");
    /// assert!(lowest >= 0.0 && highest <= 400.0 && highest - lowest > 200.0, "from {lowest} to {highest} m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Ridged {
        /// Height between the lowest and the highest point that can be; a landscape spans most of it.
        relief: f64 = 1000.0, range 0.0..=1.0e6, unit "m";
        /// Length of the largest forms; crests lie about half as far apart.
        wavelength: f64 = 8000.0, range 1.0e-3..=1.0e9, unit "m";
        /// Number of wavelengths added.
        octaves: u32 = 8, range 1..=16;
        /// Height of each octave relative to the one before.
        gain: f64 = 0.5, range 0.0..=1.0;
        /// How many times shorter each octave's wavelength is than the one before.
        lacunarity: f64 = 2.0, range 1.0..=8.0;
        /// How far down from the crests the finer octaves show.
        sharpness: f64 = 2.0, range 0.0..=8.0;
        /// A seed of its own. Without it the landscape's is used, varied for each step.
        seed: Option<u64> = None, range 0..=9_007_199_254_740_991_i64;
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

uniform! {
    /// What the shader has to know.
    struct RidgedConstants {
        octaves: u32,
        rows: u32,
        sharpness: f32,
    }
}

impl Ridged {
    /// The octaves, each with the height of its crests.
    fn scaled_octaves(&self, window: &Window, seed: u64) -> Vec<(Octave, f32)> {
        let Self { octaves, wavelength, gain, lacunarity, .. } = *self;
        let spectrum = Spectrum { octaves, wavelength, gain, lacunarity };
        let scale = (self.relief / spectrum.bound()) as f32;
        let octaves = spectrum.over(window, seed).into_iter();
        octaves.map(|(octave, amplitude)| (octave, scale * amplitude)).collect()
    }

    fn over(&self, domain: &Domain, window: &Window, seed: u64) -> Field {
        let octaves = self.scaled_octaves(window, seed);
        let sharpness = self.sharpness as f32;
        let columns = domain.size.columns;
        fill_rows(
            domain,
            #[inline(always)]
            |y, row| {
                let mut weight = vec![1.0; columns];
                let mut noise = vec![0.0; columns];
                for (octave, amplitude) in &octaves {
                    noise.fill(0.0);
                    octave.add_row(y, 1.0, &mut noise);
                    add_crests(&noise, sharpness, *amplitude, &mut weight, row);
                }
            },
        )
    }
}

impl Generator for Ridged {
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error> {
        Ok(self.over(domain, &window(domain), seed))
    }

    fn fill_rows(&self, domain: &Domain, seed: u64, rows: Range<usize>) -> Option<Field> {
        let (part, window) = part(domain, rows);
        Some(self.over(&part, &window, seed))
    }

    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        let constants = RidgedConstants {
            octaves: self.octaves,
            rows: domain.size.rows as u32,
            sharpness: self.sharpness as f32,
        };
        let pass = OctavePass {
            name: "ridged",
            shaders: &[include_str!("ridged.wgsl")],
            constants: Uniforms::of(&constants),
            octaves: self.scaled_octaves(&window(domain), seed),
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

#[inline(always)]
fn add_crests(noise: &[f32], sharpness: f32, amplitude: f32, weight: &mut [f32], row: &mut [f32]) {
    for ((cell, weight), noise) in row.iter_mut().zip(weight).zip(noise) {
        let fold = 1.0 - noise.abs();
        let crest = *weight * fold * fold;
        *cell += amplitude * crest;
        *weight = (sharpness * crest).clamp(0.0, 1.0);
    }
}
