//! Plants: where they stand in a landscape and how each differs from its neighbours.

/// All plants of a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Plants {
    /// What they are: the name of a fractal.
    pub kind: String,
    /// Least distance in metres between two of them.
    pub spacing: f64,
    /// The plants from north to south; the place in this list is a plant's number.
    pub plants: Vec<Plant>,
}

/// One plant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plant {
    /// Metres east and south of the north-western corner of the landscape, and the height of the ground there.
    pub place: [f64; 3],
    /// Unit vector along the stem: east, south, up.
    pub up: [f32; 3],
    /// Height of the plant in metres.
    pub size: f32,
    /// Turn about the stem in radians, from 0 to 2π, clockwise seen from above.
    pub turn: f32,
    /// Where in a gust the plant is, from 0 to 1: neighbours do not sway as one.
    pub phase: f32,
    /// How well the ground suits it, from 0 to 1.
    pub suitability: f32,
}

impl Plant {
    /// What brings an upright plant to where it stands, as a quaternion x, y, z, w: first the turn about the stem, then the
    /// lean. Axes are those of a mesh: x to the right, then east; y up; z towards the viewer, then south.
    pub fn rotation(&self) -> [f32; 4] {
        let (sine, cosine) = libm::sincos(-0.5 * f64::from(self.turn));
        // The shortest way from upright to the stem turns about the horizontal at right angles to both.
        let [east, south, up] = self.up.map(f64::from);
        let [x, z, w] = [south, -east, 1.0 + up];
        let length = (x * x + z * z + w * w).sqrt();
        let [x, z, w] = [x / length, z / length, w / length];
        let turned = [x * cosine - z * sine, w * sine, z * cosine + x * sine, w * cosine];
        turned.map(|number| number as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned([x, y, z, w]: [f32; 4], [a, b, c]: [f32; 3]) -> [f32; 3] {
        let cross = |[a, b, c]: [f32; 3]| [y * c - z * b, z * a - x * c, x * b - y * a];
        let t = cross([a, b, c]).map(|number| 2.0 * number);
        let u = cross(t);
        [a + w * t[0] + u[0], b + w * t[1] + u[1], c + w * t[2] + u[2]]
    }

    fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn a_plant_points_along_its_stem_and_turns_clockwise_seen_from_above() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let upright = Plant { up: [0.0, 0.0, 1.0], turn: quarter, ..Plant::default() };
        // East, up, south: a quarter clockwise brings east to south.
        assert!(apart(turned(upright.rotation(), [1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]) < 1e-6);
        for turn in [0.0, 1.0, 4.0] {
            let leaning = Plant { up: [0.6, -0.48, 0.64], turn, ..Plant::default() };
            assert!(apart(turned(leaning.rotation(), [0.0, 1.0, 0.0]), [0.6, 0.64, -0.48]) < 1e-6);
        }
    }
}
