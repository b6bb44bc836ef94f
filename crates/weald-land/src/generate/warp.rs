//! Domain-warped noise: fBm looked up at places that are themselves displaced by noise, which bends and folds
//! its forms as rock is folded.
//!
//! ```text
//! z(p) = fbm(p + strength wavelength (a(p), b(p)))
//! ```
//!
//! with `a` and `b` sums of noise of the first [`WARP_OCTAVES`] wavelengths and standard deviation 1. Quilez
//! 2002, "Domain warping"; Ebert et al., "Texturing and Modeling", 3rd ed. 2003. Heights are scaled as in
//! [`fbm`](super::fbm).

use super::fbm::DEVIATIONS;
use super::noise::Octave;
use super::octaves::{OctavePass, Spectrum, fill_rows, window};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::random::splitmix64;
use weald_engine::generator::Generator;
use weald_engine::on_device::OnDevice;
use weald_engine::program::Uniforms;
use weald_engine::step::{Entry, Stage};
use weald_engine::uniform;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Warp>(
    "warp",
    Stage::Generate,
    "folded ground: noise at places displaced by noise",
    "Quilez 2002; Ebert et al. 2003",
);

/// Octaves of the displacement. More would fray the forms instead of bending them.
pub const WARP_OCTAVES: u32 = 2;

parameters! {
    /// Domain-warped noise.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::{fbm::Fbm, warp::Warp};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(48, 32)?, 10.0)); // columns, rows, metres
    /// let job = Job::unwatched(7); // the seed
    /// Fbm { into: LayerName::of("plain"), ..Fbm::default() }.run(&mut landscape, &job)?;
    /// Warp { strength: 0.0, into: LayerName::of("still"), ..Warp::default() }.run(&mut landscape, &job)?;
    /// Warp::default().run(&mut landscape, &job)?;
    /// assert_eq!(landscape.field("still")?, landscape.field("plain")?, "what is not bent is fBm");
    /// assert_ne!(landscape.field("height")?, landscape.field("plain")?);
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Warp {
        /// Height that a landscape of some wavelengths spans: six standard deviations, around a mean of half.
        relief: f64 = 1000.0, range 0.0..=1.0e6, unit "m";
        /// Length of the largest hills and valleys before they are bent.
        wavelength: f64 = 5000.0, range 1.0e-3..=1.0e9, unit "m";
        /// Number of wavelengths added.
        octaves: u32 = 8, range 1..=16;
        /// Height of each octave relative to the one before.
        gain: f64 = 0.5, range 0.0..=1.0;
        /// How many times shorter each octave's wavelength is than the one before.
        lacunarity: f64 = 2.0, range 1.0..=8.0;
        /// Standard deviation of the displacement in wavelengths: 0 is plain fBm, 0.05 bends, 0.2 folds.
        strength: f64 = 0.1, range 0.0..=4.0;
        /// A seed of its own. Without it the landscape's is used, varied for each step.
        seed: Option<u64> = None, range 0..=9_007_199_254_740_991_i64;
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

uniform! {
    /// What the shader has to know.
    struct WarpConstants {
        octaves: u32,
        bends: u32,
        rows: u32,
        middle: f32,
        scale: f32,
    }
}

impl Warp {
    fn spectrum(&self) -> Spectrum {
        let Self { octaves, wavelength, gain, lacunarity, .. } = *self;
        Spectrum { octaves, wavelength, gain, lacunarity }
    }

    /// The octaves of the displacements to the east and to the south, in metres.
    fn bends(&self, domain: &Domain, seed: u64) -> [Vec<(Octave, f32)>; 2] {
        let bends = Spectrum { octaves: WARP_OCTAVES, ..self.spectrum() };
        let metres = (self.strength * self.wavelength / bends.deviation()) as f32;
        [1, 2].map(|axis| {
            let octaves = bends.over(&window(domain), splitmix64(seed ^ axis)).into_iter();
            octaves.map(|(octave, amplitude)| (octave, amplitude * metres)).collect()
        })
    }

    fn constants(&self, domain: &Domain) -> WarpConstants {
        let middle = (self.relief / 2.0) as f32;
        let scale = (self.relief / (DEVIATIONS * self.spectrum().deviation())) as f32;
        let rows = domain.size.rows as u32;
        WarpConstants { octaves: self.octaves, bends: WARP_OCTAVES, rows, middle, scale }
    }
}

impl Generator for Warp {
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error> {
        let octaves = self.spectrum().over(&window(domain), seed);
        let [east, south] = self.bends(domain, seed);
        let WarpConstants { middle, scale, .. } = self.constants(domain);
        let columns = domain.size.columns;
        Ok(fill_rows(
            domain,
            #[inline(always)]
            |y, row| {
                let [mut dx, mut dy] = [vec![0.0; columns], vec![0.0; columns]];
                for (bends, displacement) in [(&east, &mut dx), (&south, &mut dy)] {
                    for (octave, amplitude) in bends {
                        octave.add_row(y, *amplitude, displacement);
                    }
                }
                for (octave, amplitude) in &octaves {
                    octave.add_displaced_row(y, *amplitude, [&dx, &dy], row);
                }
                for value in row {
                    *value = middle + scale * *value;
                }
            },
        ))
    }

    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        let octaves = self.spectrum().over(&window(domain), seed);
        let pass = OctavePass {
            name: "warp",
            shaders: &[include_str!("octaves/displaced.wgsl"), include_str!("warp.wgsl")],
            constants: Uniforms::of(&self.constants(domain)),
            octaves: octaves.into_iter().chain(self.bends(domain, seed).into_iter().flatten()).collect(),
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
