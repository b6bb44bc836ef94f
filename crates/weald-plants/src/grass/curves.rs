//! What soil and light do to a blade: curves from 0 to 1 with control points that can be moved.
//!
//! ```text
//! f1(g)        = y0 (1-g)² + 2 y1 (1-g) g + y2 g²
//! f2(l), f3(l) = the same through y0, y1, y2 with t = l / 0.3          where l ≤ 0.3
//!                             and y2, y3, y4 with t = (l - 0.3) / 0.7  beyond
//! ```
//!
//! Kim and Cho 2009, eq. 2 to 4. The source prints l itself in both arcs, which jumps at 0.3, for the curve of width from
//! 0.19 to 0.65; with t the arcs meet in y2. They meet without a kink where (y2 - y1) / 0.3 = (y3 - y2) / 0.7. The
//! source's control values are lost; ours keep the shapes of its figures 2 and 3: growth rises with soil, width with light,
//! and height is greatest in weak light.

/// Light at which the two arcs of a curve meet.
pub const JOINT: f32 = 0.3;

/// The answer to soil, f1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilCurve([f32; 3]);

/// An answer to light, f2 for width or f3 for height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightCurve([f32; 5]);

/// All that soil and light do to a species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curves {
    /// f1, by soil.
    pub soil: SoilCurve,
    /// f2, by light: for width.
    pub width: LightCurve,
    /// f3, by light: for height.
    pub height: LightCurve,
}

impl SoilCurve {
    /// A curve through three control values, for soil 0, between, and 1.
    ///
    /// # Errors
    /// A sentence for the user where a value is not within 0 to 1.
    pub fn new(values: [f32; 3]) -> Result<Self, String> {
        checked(&values).map(|()| Self(values))
    }

    /// The values at 0, between, and at 1.
    pub fn values(&self) -> [f32; 3] {
        self.0
    }

    /// The answer to soil, both from 0 to 1. What is beyond counts as the nearer end.
    #[inline]
    pub fn at(&self, soil: f32) -> f32 {
        arc(self.0, soil.clamp(0.0, 1.0))
    }
}

impl LightCurve {
    /// A curve through five control values: for light 0, between, [`JOINT`], between, and 1.
    ///
    /// # Errors
    /// A sentence for the user where a value is not within 0 to 1.
    pub fn new(values: [f32; 5]) -> Result<Self, String> {
        checked(&values).map(|()| Self(values))
    }

    /// The values at 0, between, at [`JOINT`], between, and at 1.
    pub fn values(&self) -> [f32; 5] {
        self.0
    }

    /// The answer to light, both from 0 to 1. What is beyond counts as the nearer end.
    #[inline]
    pub fn at(&self, light: f32) -> f32 {
        let [a, b, c, d, e] = self.0;
        let light = light.clamp(0.0, 1.0);
        if light <= JOINT {
            arc([a, b, c], (light * (1.0 / JOINT)).min(1.0))
        } else {
            arc([c, d, e], ((light - JOINT) * (1.0 / (1.0 - JOINT))).min(1.0))
        }
    }

    /// The answer as the source prints it, with light itself in both arcs: it jumps at [`JOINT`].
    pub fn printed(&self, light: f32) -> f32 {
        let [a, b, c, d, e] = self.0;
        if light <= JOINT { arc([a, b, c], light) } else { arc([c, d, e], light) }
    }

    /// By how much the slope changes where the arcs meet.
    pub fn kink(&self) -> f32 {
        let [_, b, c, d, _] = self.0;
        2.0 * ((d - c) / (1.0 - JOINT) - (c - b) / JOINT)
    }
}

impl Curves {
    /// Curves with the shapes of the source's figures 2 and 3.
    pub const OF_THE_SOURCE: Self =
        Self::fixed([0.1, 0.6, 1.0], [0.1, 0.25, 0.45, 0.8, 1.0], [0.55, 1.0, 1.0, 0.9, 0.35]);

    /// Curves of built-in species, whose values are known to be legal.
    pub(super) const fn fixed(soil: [f32; 3], width: [f32; 5], height: [f32; 5]) -> Self {
        Self { soil: SoilCurve(soil), width: LightCurve(width), height: LightCurve(height) }
    }
}

/// The quadratic arc of three control values, by repeated interpolation, which never leaves their range.
#[inline]
fn arc([a, b, c]: [f32; 3], t: f32) -> f32 {
    mix(mix(a, b, t), mix(b, c, t), t)
}

/// From one number to another.
#[inline]
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

fn checked(values: &[f32]) -> Result<(), String> {
    match values.iter().position(|value| !(0.0..=1.0).contains(value)) {
        None => Ok(()),
        Some(place) => Err(format!(
            "control value {} of the curve is {}; the values of a curve are within 0 to 1",
            place + 1,
            values[place]
        )),
    }
}
