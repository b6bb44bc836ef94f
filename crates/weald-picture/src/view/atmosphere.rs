//! Clear air lit by the sun: how much sunlight comes through, and how bright and of what colour the sky is.
//!
//! Rayleigh and Mie scattering and absorption by ozone in shells around the Earth, `σ(h) = σ₀ e^(-h/H)`. Light that
//! was scattered once is integrated along each direction; light that was scattered more often is taken as even in
//! direction and summed as a geometric series: Sébastien Hillaire 2020, "A scalable and production ready sky and
//! atmosphere rendering technique", doi 10.1111/cgf.14050, with his coefficients (after Bruneton and Neyret 2008,
//! doi 10.1111/j.1467-8659.2008.01245.x). What differs: there is six times
//! as much haze, the optical depth 0.03 of a clear day over land; the integrals depend on the elevation of a direction alone,
//! being taken at right angles to the sun, and the phase functions are applied where the sky is looked up; the
//! ground sends nothing back into the air.

use super::vector::Vector;

type Colour = [f64; 3];

/// Radius of the Earth and depth of the air, in metres.
const EARTH: f64 = 6_360_000.0;
const AIR: f64 = 100_000.0;

/// Scattering by molecules at sea level, a metre, and its scale height.
const RAYLEIGH: Colour = [5.802e-6, 13.558e-6, 33.1e-6];
const RAYLEIGH_HEIGHT: f64 = 8000.0;

/// Scattering and extinction by haze at sea level, a metre, and their scale height.
const MIE: f64 = 2.4e-5;
const MIE_EXTINCTION: f64 = 2.7e-5;
const MIE_HEIGHT: f64 = 1200.0;

/// Absorption by ozone at 25 km, a metre.
const OZONE: Colour = [0.65e-6, 1.881e-6, 0.085e-6];

/// Steps of an integral through the air.
const STEPS: usize = 32;

/// Radiance of a direction for sunlight of 1, before the phase functions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scattered {
    /// Scattered once by molecules; to be multiplied by their phase function.
    pub(super) rayleigh: Vector,
    /// Scattered once by haze; to be multiplied by its phase function.
    pub(super) mie: Vector,
    /// Scattered more often.
    pub(super) multiple: Vector,
}

/// The air under a sun.
#[derive(Debug)]
pub(super) struct Atmosphere {
    /// Sine of the sun's altitude.
    sun: f64,
    /// Light scattered twice or more that passes a point, by height.
    often: Vec<Colour>,
}

/// Heights at which light scattered more often is known.
const HEIGHTS: usize = 16;

impl Atmosphere {
    /// The air under a sun whose altitude has this sine.
    pub(super) fn new(sun: f64) -> Self {
        let often = (0..HEIGHTS).map(|level| scattered_often(height_of(level as f64), sun)).collect();
        Self { sun, often }
    }

    /// Share of the sunlight that comes down to the ground.
    pub(super) fn sunlight(&self) -> Vector {
        transmittance(0.0, self.sun).map(|share| share as f32)
    }

    /// Light from a direction whose altitude has this sine, 0 to 1.
    pub(super) fn scattered(&self, up: f64) -> Scattered {
        let (mut rayleigh, mut mie, mut multiple) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        along(0.0, up, |height, step, through| {
            let sunlit = transmittance(height, self.sun);
            let [r, m] = densities(height);
            let often = self.often_at(height);
            for c in 0..3 {
                rayleigh[c] += through[c] * step * r * RAYLEIGH[c] * sunlit[c];
                mie[c] += through[c] * step * m * MIE * sunlit[c];
                multiple[c] += through[c] * step * (r * RAYLEIGH[c] + m * MIE) * often[c];
            }
        });
        let [rayleigh, mie, multiple] = [rayleigh, mie, multiple].map(|colour| colour.map(|c| c as f32));
        Scattered { rayleigh, mie, multiple }
    }

    fn often_at(&self, height: f64) -> Colour {
        let level = (height / AIR).sqrt() * (HEIGHTS - 1) as f64;
        let below = (level as usize).min(HEIGHTS - 2);
        let share = level - below as f64;
        std::array::from_fn(|c| self.often[below][c] * (1.0 - share) + self.often[below + 1][c] * share)
    }
}

fn height_of(level: f64) -> f64 {
    let share = level / (HEIGHTS - 1) as f64;
    share * share * AIR
}

/// Densities of molecules and of haze at a height, relative to sea level.
fn densities(height: f64) -> [f64; 2] {
    [libm::exp(-height / RAYLEIGH_HEIGHT), libm::exp(-height / MIE_HEIGHT)]
}

fn extinction(height: f64) -> Colour {
    let [rayleigh, mie] = densities(height);
    let ozone = (1.0 - (height - 25_000.0).abs() / 15_000.0).max(0.0);
    std::array::from_fn(|c| rayleigh * RAYLEIGH[c] + mie * MIE_EXTINCTION + ozone * OZONE[c])
}

/// Distance to the end of the air, or to the ground, from a height in a direction whose altitude has this sine.
fn reach(height: f64, up: f64) -> f64 {
    let radius = EARTH + height;
    let root = |sphere: f64| radius * radius * (up * up - 1.0) + sphere * sphere;
    let ground = root(EARTH);
    if up < 0.0 && ground >= 0.0 && height > 0.0 {
        return -radius * up - ground.sqrt();
    }
    -radius * up + root(EARTH + AIR).max(0.0).sqrt()
}

/// Walks through the air: calls `visit` with the height, the length of the step and the share of light that comes
/// from there. Steps grow with the square of the way, since the air is densest near its start.
fn along(height: f64, up: f64, mut visit: impl FnMut(f64, f64, Colour)) {
    let reach = reach(height, up);
    let mut depth = [0.0; 3];
    let ray_length = |step: usize| {
        let share = step as f64 / STEPS as f64;
        reach * share * share
    };
    for step in 0..STEPS {
        let (middle, length) =
            (0.5 * (ray_length(step) + ray_length(step + 1)), ray_length(step + 1) - ray_length(step));
        let radius = EARTH + height;
        let above = (radius * radius + middle * middle + 2.0 * radius * middle * up).sqrt() - EARTH;
        let here = extinction(above.max(0.0));
        let through = std::array::from_fn(|c| libm::exp(-depth[c] - 0.5 * here[c] * length));
        visit(above.max(0.0), length, through);
        (0..3).for_each(|c| depth[c] += here[c] * length);
    }
}

/// Share of light that comes from outside the air down to a height; 0 from below the horizon.
fn transmittance(height: f64, up: f64) -> Colour {
    let radius = EARTH + height;
    if up < 0.0 && radius * radius * (1.0 - up * up) < EARTH * EARTH {
        return [0.0; 3];
    }
    let mut depth = [0.0; 3];
    along(height, up, |above, length, _| {
        let here = extinction(above);
        (0..3).for_each(|c| depth[c] += here[c] * length);
    });
    depth.map(|depth| libm::exp(-depth))
}

/// Light scattered twice or more that passes a height, for sunlight of 1: what is scattered for the second time,
/// summed over all directions, over what each further scattering takes away.
fn scattered_often(height: f64, sun: f64) -> Colour {
    const DIRECTIONS: usize = 12;
    let (mut second, mut again) = ([0.0; 3], [0.0; 3]);
    for direction in 0..DIRECTIONS {
        let up = -1.0 + (2.0 * direction as f64 + 1.0) / DIRECTIONS as f64;
        along(height, up, |above, length, through| {
            let sunlit = transmittance(above, sun);
            let [rayleigh, mie] = densities(above);
            for c in 0..3 {
                let scattering =
                    through[c] * length * (rayleigh * RAYLEIGH[c] + mie * MIE) / DIRECTIONS as f64;
                second[c] += scattering * sunlit[c] / (4.0 * std::f64::consts::PI);
                again[c] += scattering;
            }
        });
    }
    std::array::from_fn(|c| second[c] / (1.0 - again[c]).max(1e-3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_overhead_loses_the_shares_of_a_vertical_column() {
        let depth: Colour = std::array::from_fn(|c| {
            RAYLEIGH[c] * RAYLEIGH_HEIGHT + MIE_EXTINCTION * MIE_HEIGHT + OZONE[c] * 15_000.0
        });
        for (share, depth) in transmittance(0.0, 1.0).into_iter().zip(depth) {
            assert!((share / libm::exp(-depth) - 1.0).abs() < 0.01, "{share} for a depth of {depth}");
        }
    }

    #[test]
    fn a_low_sun_is_red_and_the_zenith_blue() {
        let air = Atmosphere::new(libm::sin(5_f64.to_radians()));
        let [r, _, b] = air.sunlight();
        assert!(r > 3.0 * b && b > 0.0, "{r} {b}");
        let zenith = Atmosphere::new(0.7).scattered(1.0);
        assert!(zenith.rayleigh[2] > 3.0 * zenith.rayleigh[0]);
        assert!(zenith.multiple.iter().all(|&light| light > 0.0));
    }

    #[test]
    fn no_light_comes_through_the_earth() {
        assert_eq!(transmittance(10.0, -0.2), [0.0; 3]);
        let level = transmittance(10.0, 0.0);
        assert!(level.iter().all(|&share| share > 0.0 && share < 1.0), "{level:?} from the horizon");
    }
}
