//! A brush: where it touches the ground, how strongly, and what it does there.

use super::canvas::{Area, Canvas};
use weald_core::grid::Size;

weald_core::choices! {
    /// How the effect of a brush falls off from the middle of a stroke to its edge.
    pub enum Falloff {
        /// Not at all: full strength up to the edge.
        Hard = "hard",
        /// Evenly.
        Linear = "linear",
        /// Gently at the middle and at the edge: `1 - u² (3 - 2 u)`.
        Smooth = "smooth",
        /// As a bell, `exp(-4.5 u²)`, which is 1 % at the edge.
        Gaussian = "gaussian",
    }
}

impl Falloff {
    /// Share of the strength at `u` radii from the middle, 0 to 1.
    pub fn share(self, u: f64) -> f64 {
        match self {
            Self::Hard => 1.0,
            Self::Linear => 1.0 - u,
            Self::Smooth => 1.0 - u * u * (3.0 - 2.0 * u),
            Self::Gaussian => libm::exp(-4.5 * u * u),
        }
    }
}

/// What a brush does where its weight is 1; in between it does its share.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Adds a material at its place among the layers.
    Add {
        /// Name of the material, or `bedrock`.
        material: String,
        /// Metres added.
        thickness: f64,
    },
    /// Takes a material away, as far as there is any; of bedrock there always is.
    Remove {
        /// Name of the material, or `bedrock`.
        material: String,
        /// Most metres taken.
        thickness: f64,
    },
    /// Pours water.
    AddWater {
        /// Metres added.
        depth: f64,
    },
    /// Takes water away, as far as there is any.
    RemoveWater {
        /// Most metres taken.
        depth: f64,
    },
    /// Brings the ground to the mean of its surroundings: it takes from the topmost material downward, and
    /// gives to the topmost one.
    Smooth {
        /// How many times.
        times: u32,
    },
    /// Brings the ground to a height, as `Smooth` does.
    Flatten {
        /// Height in metres.
        height: f64,
    },
    /// Lets water rise.
    Source {
        /// Metres per iteration.
        rate: f64,
    },
    /// Lets water run off, with the sediment that it carries.
    Drain {
        /// Most metres per iteration.
        rate: f64,
    },
    /// Changes the rain.
    Rain {
        /// Factor on the rain.
        factor: f64,
    },
    /// Holds the simulation still where the weight is at least a half.
    Freeze,
    /// Lets it go on there.
    Thaw,
    /// Protects the ground from later strokes, as far as the weight says; what runs there goes on.
    Mask,
    /// Takes that protection away.
    Unmask,
}

impl Effect {
    /// Whether it paints the mask, which limits what all other strokes do.
    pub(crate) fn masks(&self) -> bool {
        matches!(self, Self::Mask | Self::Unmask)
    }
}

/// A stroke of a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct Brush {
    /// Places in metres from the north-western corner of the landscape, east and south: one for a dab, several
    /// for a line through them. A place is touched once, however often the line passes it.
    pub path: Vec<[f64; 2]>,
    /// Metres from the line to the edge of the stroke.
    pub radius: f64,
    /// How the effect falls off towards the edge.
    pub falloff: Falloff,
    /// Weight in the middle, 0 to 1.
    pub strength: f64,
    /// What it does.
    pub effect: Effect,
}

impl Brush {
    /// A round dab at a place in metres east and south of the north-western corner, of full strength in the middle and
    /// gently falling off to `radius` metres.
    pub fn dab(effect: Effect, place: [f64; 2], radius: f64) -> Self {
        Self::line(effect, &[place], radius)
    }

    /// The same along a line through several places.
    pub fn line(effect: Effect, path: &[[f64; 2]], radius: f64) -> Self {
        Self { path: path.to_vec(), radius, falloff: Falloff::Smooth, strength: 1.0, effect }
    }

    /// The cells that a canvas must hold for the stroke to come out as on the whole landscape; `None` where it
    /// touches no cell of a landscape of this size.
    pub fn area(&self, size: Size, cell: f64) -> Option<Area> {
        // Smoothing looks at the cells next to those it changes.
        let margin = f64::from(u8::from(matches!(self.effect, Effect::Smooth { .. })));
        let axis = |axis: usize, count: usize| {
            let places = || self.path.iter().map(|place| place[axis]);
            let low = places().fold(f64::INFINITY, f64::min) - self.radius;
            let high = places().fold(f64::NEG_INFINITY, f64::max) + self.radius;
            span([low / cell - margin, high / cell + margin], count)
        };
        let ([west, east], [north, south]) = axis(0, size.columns).zip(axis(1, size.rows))?;
        let size = Size { columns: east - west, rows: south - north };
        Some(Area { first: [west, north], size })
    }

    /// Weight of the brush in each cell of a canvas: 0 beyond the radius.
    pub(super) fn weights(&self, canvas: &Canvas) -> Vec<f64> {
        let mut nearest = vec![f64::INFINITY; canvas.size().cells()];
        let last = self.path.len().saturating_sub(2);
        for segment in 0..=last {
            if let Some(&from) = self.path.get(segment) {
                let to = self.path.get(segment + 1).copied().unwrap_or(from);
                self.approach(canvas, [from, to], &mut nearest);
            }
        }
        let weight = |square: f64| {
            let outside = square > self.radius * self.radius;
            if outside { 0.0 } else { self.strength * self.falloff.share(square.sqrt() / self.radius) }
        };
        nearest.into_iter().map(weight).collect()
    }

    /// Lowers the squares of the distances to those from a piece of the line, for cells that it can reach.
    fn approach(&self, canvas: &Canvas, [from, to]: [[f64; 2]; 2], nearest: &mut [f64]) {
        let size = canvas.size();
        let axis = |axis: usize, count: usize| {
            let [low, high] = [from[axis].min(to[axis]), from[axis].max(to[axis])];
            let first = canvas.first[axis] as f64;
            span(
                [(low - self.radius) / canvas.cell - first, (high + self.radius) / canvas.cell - first],
                count,
            )
        };
        let (Some([west, east]), Some([north, south])) = (axis(0, size.columns), axis(1, size.rows)) else {
            return;
        };
        let centre = |axis: usize, place: usize| ((canvas.first[axis] + place) as f64 + 0.5) * canvas.cell;
        for y in north..south {
            for x in west..east {
                let square = square_of_distance([centre(0, x), centre(1, y)], from, to);
                let cell = &mut nearest[size.index(x, y)];
                *cell = cell.min(square);
            }
        }
    }
}

/// The cells between two places along an axis of `count` cells, one more on each side against rounding.
fn span([low, high]: [f64; 2], count: usize) -> Option<[usize; 2]> {
    let first = (libm::floor(low) - 1.0).max(0.0);
    let end = (libm::ceil(high) + 1.0).min(count as f64);
    (first < end).then_some([first as usize, end as usize])
}

fn square_of_distance(place: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [along, across] = [to[0] - from[0], to[1] - from[1]];
    let [dx, dy] = [place[0] - from[0], place[1] - from[1]];
    let length = along * along + across * across;
    let share = if length > 0.0 { ((dx * along + dy * across) / length).clamp(0.0, 1.0) } else { 0.0 };
    let [dx, dy] = [dx - share * along, dy - share * across];
    dx * dx + dy * dy
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::material::Material;

    #[test]
    fn every_falloff_is_whole_in_the_middle_and_sinks_to_the_edge() {
        for falloff in [Falloff::Hard, Falloff::Linear, Falloff::Smooth, Falloff::Gaussian] {
            let shares: Vec<_> = (0..=100).map(|i| falloff.share(f64::from(i) / 100.0)).collect();
            assert_eq!(shares[0], 1.0);
            assert!(shares.windows(2).all(|pair| pair[1] <= pair[0]), "{falloff:?}");
            assert!(falloff == Falloff::Hard || shares[100] < 0.012, "{falloff:?}");
        }
    }

    #[test]
    fn a_line_is_touched_evenly_and_once_however_it_is_cut() {
        let area = Area { first: [0, 0], size: Size::new(40, 20).expect("small") };
        let canvas = Canvas::level(area, 5.0, &Material::default_stack());
        let weights = |path: &[[f64; 2]]| {
            let (falloff, effect) = (Falloff::Smooth, Effect::Freeze);
            Brush { path: path.to_vec(), radius: 20.0, falloff, strength: 0.5, effect }.weights(&canvas)
        };
        let whole = weights(&[[40.0, 50.0], [160.0, 50.0]]);
        let back = weights(&[[40.0, 50.0], [100.0, 50.0], [70.0, 50.0], [160.0, 50.0]]);
        for (one, other) in whole.iter().zip(&back) {
            assert!((one - other).abs() < 1e-12);
        }
        let on_the_line: Vec<_> = (10..30).map(|x| whole[area.size.index(x, 10)]).collect();
        assert!(
            on_the_line.iter().all(|weight| *weight == on_the_line[0] && *weight > 0.45),
            "{on_the_line:?}"
        );
        assert_eq!(whole[area.size.index(20, 15)], 0.0, "beyond the radius");
    }
}
