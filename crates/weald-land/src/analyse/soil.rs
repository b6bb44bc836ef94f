//! How deep the soil is, and how well it feeds plants.
//!
//! ```text
//! dh/dt = P exp(-h / h₀) - ∇·q + (deposition - recent · erosion) / T          q = -K ∇z / (1 - (|∇z| / S)²)
//! ```
//!
//! over the age T of the soil: rock weathers the slower the deeper it is buried (Heimsath et al. 1997, doi
//! 10.1038/41056), soil creeps downhill the faster the nearer the ground is to its critical slope S (Roering, Kirchner
//! and Dietrich 1999, doi 10.1029/1998WR900090), and what water laid down or took away came and went evenly. The
//! land keeps its shape meanwhile, so that in each cell the rate g of all but weathering is constant; with u =
//! exp(h / h₀) the equation is linear and its solution exact:
//!
//! ```text
//! u(T) = u(0) eᵃ + (P T / h₀) (eᵃ - 1) / a          a = g T / h₀
//! h(T) / h₀ = max(a, 0) + ln(exp(h(0) / h₀ + min(a, 0)) + (P T / h₀) (1 - e⁻ⁿ) / n)          n = |a|
//! ```
//!
//! The second is the first without numbers that grow beyond bounds; it is worked out for rows of cells in vectors.
//!
//! Ridges and worn ground come to the depth h₀ ln(P / -g), or to bare rock where -g exceeds P; hollows and
//! flood plains gather soil. Ground at or beyond its critical slope bears none. Fertility is Weald's own product of
//! what limits plants, each factor 0 to 1 and 1 where its layer is not given:
//!
//! ```text
//! (1 - exp(-h / rooting)) · moisture, from `dry` over 1 to `wet` · nutrients, from `old` to 1 with fresh deposits
//! ```

use std::f64::consts::{LN_2, LOG2_E};

use super::cells::fields_by_rows;
use super::quadric::{LOOKS, Quadric, Surface, window};
use crate::exponential::{exp2, log2};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::vectors;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Soil>(
    "soil",
    Stage::Analyse,
    "how deep the soil is by weathering, creep, erosion and deposits, and how fertile",
    "Heimsath et al. 1997, doi 10.1038/41056; Roering, Kirchner and Dietrich 1999, doi 10.1029/1998WR900090",
);

parameters! {
    /// Soil. Writes `soil_depth` in metres and `fertility` from 0 to 1. What it takes into account beside the
    /// ground is what the recipe names.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::soil::Soil;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// Soil::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let depth = f64::from(landscape.field("soil_depth")?.at(4, 3));
    /// let weathered = 0.42 * (1.0 + 0.000_077 * 10_000.0 / 0.42_f64).ln(); // on flat ground nothing else counts
    /// assert!((depth - weathered).abs() < 1.0e-5, "{depth} m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Soil {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Layer of what water took away, in metres, such as `erosion`. Without it, nothing.
        erosion: Option<LayerName> = None;
        /// Share of it that fell in the time in which the soil formed: a simulation soon wears what takes land a
        /// hundred times as long.
        recent_erosion: f64 = 0.01, range 0.0..=1.0, with erosion;
        /// Layer of what water laid down and left, in metres, such as `deposition`. Without it, nothing.
        deposition: Option<LayerName> = None;
        /// Layer of moisture from 0 to 1. Without it, moisture limits nothing.
        moisture: Option<LayerName> = None;
        /// Layer of loose ground that lay there before, in metres, such as `regolith` or a material. Without it,
        /// the soil begins on bare rock.
        loose: Option<LayerName> = None;
        /// Time for which the soil has formed. The default is that since the last ice age.
        age: f64 = 10_000.0, range 1.0..=10_000_000.0, unit "yr";
        /// Soil production rate on bare rock (P). The default is that of Heimsath et al.
        weathering: f64 = 0.000_077, range 0.0..=0.1, unit "m/yr";
        /// e-folding depth of soil production: under that depth of soil it is 1/e, or 37 %, of that on bare rock
        /// (h₀). The default is that of Heimsath et al.
        weathering_depth: f64 = 0.42, range 0.01..=10.0, unit "m";
        /// Soil transport coefficient of creep downhill (K). The default is that of Roering et al.
        creep: f64 = 0.003, range 0.0..=10.0, unit "m²/yr";
        /// Slope at which all soil slides off (S).
        critical_slope_deg: f64 = 50.0, range 5.0..=85.0, unit "deg";
        /// Metres from a cell to the edge of the window in which slope and curvature are measured: soil does not
        /// follow forms smaller than that. The least is one cell.
        scale: f64 = 0.0, range 0.0..=1.0e6, unit "m";
        /// Greatest depth that is reported; more than roots reach makes no difference.
        deepest: f64 = 20.0, range 0.1..=1000.0, unit "m";
        /// Depth that holds about two thirds of the roots.
        rooting: f64 = 0.4, range 0.01..=10.0, unit "m";
        /// Moisture at which plants grow best.
        best_moisture: f64 = 0.6, range 0.05..=0.95, with moisture;
        /// Factor of fertility where moisture is 0.
        dry: f64 = 0.2, range 0.0..=1.0, with moisture;
        /// Factor of fertility where moisture is 1, and roots lack air.
        wet: f64 = 0.5, range 0.0..=1.0, with moisture;
        /// Factor of fertility where there are no fresh deposits; with half a metre of them it is most of the way
        /// to 1.
        old: f64 = 0.6, range 0.0..=1.0, with deposition;
    }
}

/// Deposit that brings nutrients two thirds of the way to their greatest, in metres.
const ENRICHING: f64 = 0.5;

impl Step for Soil {
    fn reads(&self) -> Vec<String> {
        let others = [&self.erosion, &self.deposition, &self.moisture, &self.loose].into_iter().flatten();
        std::iter::once(&self.of).chain(others).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![("soil_depth".to_owned(), "m"), ("fertility".to_owned(), "1")]
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some((0.0, if layer == "fertility" { 1.0 } else { self.deepest }))
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        window(domain, self.scale).map(drop)
    }

    fn reach(&self) -> Option<Reach> {
        Some(Reach { metres: self.scale, cells: LOOKS })
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let ground = Ground::of(self);
        let surface = Surface::new(landscape.field(&self.of.0)?, domain).reaching(self.scale)?;
        let [crept] = surface.fields(
            #[inline(always)]
            |_, shape| [ground.crept(shape)],
        );
        let given = self.given(landscape)?;
        let [depth, fertility] = fields_by_rows(domain.size, |y, [depth, fertility]| {
            let rows = given.each_ref().map(|given| given.row(y));
            vectors::widest(
                #[inline(always)]
                || ground.row(crept.row(y), rows, depth, fertility),
            );
            if let Some(valid) = &domain.valid {
                for x in (0..domain.size.columns).filter(|&x| !valid.is_valid(x, y)) {
                    (depth[x], fertility[x]) = (0.0, 0.0);
                }
            }
        });
        landscape.insert("soil_depth", "m", depth);
        landscape.insert("fertility", "1", fertility);
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

impl Soil {
    /// Loose ground, erosion, deposits and moisture. Where a recipe leaves one out it is what changes nothing.
    fn given<'a>(&self, landscape: &'a Landscape) -> Result<[Given<'a>; 4], Error> {
        let layer = |name: &Option<LayerName>, otherwise: f64| -> Result<Given<'a>, Error> {
            let field = name.as_ref().map(|name| landscape.field(&name.0)).transpose()?;
            let columns = if field.is_none() { landscape.domain.size.columns } else { 0 };
            Ok(Given { field, otherwise: vec![otherwise as f32; columns] })
        };
        Ok([
            layer(&self.loose, 0.0)?,
            layer(&self.erosion, 0.0)?,
            layer(&self.deposition, 0.0)?,
            layer(&self.moisture, self.best_moisture)?,
        ])
    }
}

/// A layer, or a row that stands for all of those of one that is left out.
struct Given<'a> {
    field: Option<&'a Field>,
    otherwise: Vec<f32>,
}

impl Given<'_> {
    fn row(&self, y: usize) -> &[f32] {
        self.field.map_or(&self.otherwise, |field| field.row(y))
    }
}

/// What of a soil is the same everywhere.
struct Ground<'a> {
    soil: &'a Soil,
    /// Square of the tangent of the critical slope.
    critical: f64,
    /// What weathers from bare rock in the age of the soil, by the depth of weathering.
    weathered: f64,
    /// Factor of fertility where there are no fresh deposits; 1 where nothing is known of deposits.
    old: f64,
}

impl<'a> Ground<'a> {
    fn of(soil: &'a Soil) -> Self {
        let tangent = libm::tan(soil.critical_slope_deg.to_radians());
        let weathered = soil.weathering * soil.age / soil.weathering_depth;
        let old = if soil.deposition.is_some() { soil.old } else { 1.0 };
        Self { soil, critical: tangent * tangent, weathered, old }
    }

    /// What creep brings to a cell, in m/yr: on ground at its critical slope or beyond it takes all away.
    #[inline(always)]
    fn crept(&self, shape: Quadric) -> f64 {
        let steepness = shape.steepness() / self.critical;
        let rate = self.soil.creep * gathering(shape, steepness, self.critical);
        if steepness < 1.0 { rate } else { f64::NEG_INFINITY }
    }

    /// Depth and fertility of a row, from what creep brings and the rows of [`Soil::given`].
    #[inline(always)]
    fn row(&self, crept: &[f32], given: [&[f32]; 4], depth: &mut [f32], fertility: &mut [f32]) {
        let [loose, erosion, deposition, moisture] = given;
        let cells = depth.iter_mut().zip(fertility).zip(crept);
        let given = loose.iter().zip(erosion).zip(deposition).zip(moisture);
        for (((depth, fertility), &crept), (((&loose, &erosion), &deposit), &moisture)) in cells.zip(given) {
            let gain = f64::from(deposit) - self.soil.recent_erosion * f64::from(erosion);
            let deep = self.depth(f64::from(crept), f64::from(loose), gain);
            *depth = deep as f32;
            *fertility = self.fertility(deep, f64::from(moisture), f64::from(deposit)) as f32;
        }
    }

    /// Depth in metres where creep brings so much, from what lay there and what came and went, both in metres.
    #[inline(always)]
    fn depth(&self, crept: f64, loose: f64, gain: f64) -> f64 {
        self.grown(loose.max(0.0), crept + gain / self.soil.age).max(0.0).min(self.soil.deepest)
    }

    /// The solution of the equation of depth after the age of the soil, from a depth at the start and a rate of all
    /// but weathering, in m/yr.
    #[inline(always)]
    fn grown(&self, start: f64, rate: f64) -> f64 {
        let scale = self.soil.weathering_depth;
        let a = rate * self.soil.age / scale;
        let kept = start / scale + a.min(0.0);
        let sum = exp2(kept * LOG2_E) + self.weathered * mean_decay(a.abs());
        // Beyond what `exp2` reaches what was kept is all there is.
        scale * (log2(sum) * LN_2 + (kept - MAX_EXPONENT).max(0.0) + a.max(0.0))
    }

    #[inline(always)]
    fn fertility(&self, depth: f64, moisture: f64, deposit: f64) -> f64 {
        let rooted = 1.0 - exp2(-depth / self.soil.rooting * LOG2_E);
        let fed = 1.0 - (1.0 - self.old) * exp2(-deposit.max(0.0) / ENRICHING * LOG2_E);
        (rooted * self.soil.watered(moisture.clamp(0.0, 1.0)) * fed).clamp(0.0, 1.0)
    }
}

/// Exponent from which on [`exp2`] is the same, as a natural one.
const MAX_EXPONENT: f64 = 1000.0 * LN_2;

impl Soil {
    #[inline(always)]
    fn watered(&self, moisture: f64) -> f64 {
        let best = self.best_moisture;
        let (end, fraction) = if moisture < best {
            (self.dry, moisture / best)
        } else {
            (self.wet, (1.0 - moisture) / (1.0 - best))
        };
        end + (1.0 - end) * fraction * fraction * (3.0 - 2.0 * fraction)
    }
}

/// `∇·(f ∇z)` with `f = 1 / (1 - steepness)`, in 1/m: what creep brings to a cell, for K = 1. `critical` is the square of the
/// critical slope.
#[inline(always)]
fn gathering(Quadric { p, q, r, s, t }: Quadric, steepness: f64, critical: f64) -> f64 {
    let faster = 1.0 / (1.0 - steepness);
    let along = p * p * r + 2.0 * p * q * s + q * q * t;
    faster * (r + t) + 2.0 * faster * faster / critical * along
}

/// `(1 - e⁻ⁿ) / n`, whatever the size of `n`, which is not negative.
#[inline(always)]
fn mean_decay(n: f64) -> f64 {
    let series = 1.0 - n * (0.5 - n * (1.0 / 6.0));
    let closed = (1.0 - exp2(-n * LOG2_E)) / n;
    // Where the difference has few digits left; the next term of the series is a twenty-fourth of n³.
    if n < 1e-3 { series } else { closed }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent(r: f64) -> Quadric {
        Quadric { r, ..Quadric::default() }
    }

    fn depth(soil: &Soil, shape: Quadric, loose: f64, gain: f64) -> f64 {
        let ground = Ground::of(soil);
        ground.depth(ground.crept(shape), loose, gain)
    }

    /// The depth by small steps of the equation itself.
    fn stepped(soil: &Soil, start: f64, rate: f64) -> f64 {
        let steps = 200_000;
        let time = soil.age / f64::from(steps);
        (0..steps).fold(start, |depth, _| {
            let weathered = soil.weathering * (-depth / soil.weathering_depth).exp();
            (depth + time * (weathered + rate)).max(0.0)
        })
    }

    #[test]
    fn the_closed_form_solves_the_equation_of_depth() {
        let soil = Soil::default();
        for (start, rate) in [(0.0, 0.0), (0.0, -3e-5), (1.5, -6e-5), (0.2, 5e-5), (0.0, 1e-3), (3.0, -2e-3)]
        {
            let (found, expected) =
                (Ground::of(&soil).grown(start, rate).max(0.0), stepped(&soil, start, rate));
            assert!((found - expected).abs() < 2e-4, "{start} m, {rate} m/yr: {found} instead of {expected}");
        }
    }

    #[test]
    fn on_old_ridges_weathering_keeps_up_with_creep_at_the_depth_of_heimsath() {
        let soil = Soil { age: 1.0e7, ..Soil::default() };
        let curvature = -0.01;
        let expected = soil.weathering_depth * (soil.weathering / (soil.creep * 0.01)).ln();
        let found = depth(&soil, bent(curvature), 0.0, 0.0);
        assert!(expected > 0.3 && (found - expected).abs() < 1e-6, "{found} instead of {expected}");
    }

    #[test]
    fn sharp_ridges_steep_walls_and_worn_ground_are_bare_and_hollows_are_deep() {
        let soil = Soil::default();
        assert_eq!(depth(&soil, bent(-0.1), 0.0, 0.0), 0.0);
        assert_eq!(depth(&soil, Quadric { p: 2.0, ..Quadric::default() }, 5.0, 0.0), 0.0);
        assert_eq!(depth(&soil, bent(0.0), 0.0, -50.0), 0.0);
        let [level, hollow, plain] =
            [(0.0, 0.0), (0.01, 0.0), (0.0, 3.0)].map(|(bend, gain)| depth(&soil, bent(bend), 0.0, gain));
        assert!(level > 0.3 && hollow > level && plain > 3.0, "{level} {hollow} {plain}");
        assert_eq!(depth(&soil, bent(0.0), 0.0, 1.0e6), soil.deepest);
        let buried = Soil { deepest: 1000.0, weathering_depth: 0.01, ..soil };
        assert!(
            (depth(&buried, bent(0.0), 900.0, -300.0) - 600.0).abs() < 1e-6,
            "beyond what exponentials reach"
        );
    }

    #[test]
    fn creep_is_faster_the_nearer_the_ground_is_to_its_critical_slope() {
        let soil = Soil::default();
        let shoulder = |p: f64| depth(&soil, Quadric { p, ..bent(-0.004) }, 0.0, 0.0);
        assert!(shoulder(0.0) > shoulder(0.5) && shoulder(0.5) > shoulder(0.8), "{}", shoulder(0.5));
    }

    #[test]
    fn fertility_is_greatest_on_deep_moist_fresh_soil() {
        let soil = Soil { deposition: Some(LayerName::of("deposition")), ..Soil::default() };
        let ground = Ground::of(&soil);
        let best = ground.fertility(10.0, 0.6, 10.0);
        assert!((best - 1.0).abs() < 1e-6, "{best}");
        for (depth, moisture, deposit) in
            [(0.1, 0.6, 10.0), (10.0, 0.0, 10.0), (10.0, 1.0, 10.0), (10.0, 0.6, 0.0)]
        {
            assert!(ground.fertility(depth, moisture, deposit) < 0.7);
        }
        let unknown = Soil::default();
        let ground = Ground::of(&unknown);
        assert_eq!(ground.fertility(0.0, unknown.best_moisture, 0.0), 0.0);
        assert!(ground.fertility(10.0, unknown.best_moisture, 0.0) > 0.99);
    }

    #[test]
    fn the_mean_of_a_decay_is_that_of_the_library() {
        for n in [0.0, 1e-9, 9.9e-4, 1.01e-3, 0.3, 7.0, 800.0, f64::INFINITY] {
            let exact = if n == 0.0 { 1.0 } else { -libm::expm1(-n) / n };
            assert!((mean_decay(n) - exact).abs() < 1e-8 * exact.max(1e-12), "{n}: {}", mean_decay(n));
        }
    }
}
