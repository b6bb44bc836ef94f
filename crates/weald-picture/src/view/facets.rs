//! How much facets of rock face the sun, as far as others leave it to them: in all about as much light falls on them as on the even wall.
//! Without that, facets of walls that the sun grazes are strips, bright ones beside dark ones.
//!
//! Chiang, Li and Burley 2019, "Taming the shadow terminator", doi 10.1145/3306307.3328172: of a facet of normal s on a surface of
//! normal g, the share G = g · l / ((s · l) (g · s)), at most 1, as G + G² - G³. What differs: on walls alone, since crowns and
//! blades let light through between them, and facets fade where the sun grazes the wall as a whole.

use super::vector::{Vector, dot, ramp};

/// Slopes from which on a surface is a wall, of facets without gaps between them, and by which it is for certain.
const WALLS: [f32; 2] = [0.9, 1.8];

/// How much a wall faces the sun where its facets are seen as such.
const FACETS_SEEN: f32 = 0.4;

/// How much a facet of a surface of such a slope faces the sun, by the normals of the surface and of the facet and the direction of
/// the sun, all of unit length.
pub(super) fn facing_sun([even, facet, sun]: [Vector; 3], slope: f32) -> f32 {
    let [wall, facing] = [even, facet].map(|normal| dot(normal, sun).max(0.0));
    let seen = (wall / (facing * dot(even, facet)).max(1e-3)).clamp(0.0, 1.0);
    let left = facing * seen * (1.0 + seen * (1.0 - seen));
    let on_wall = wall + (left - wall) * ramp(wall, 0.0, FACETS_SEEN);
    facing + (on_wall - facing) * ramp(slope, WALLS[0], WALLS[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Facets of a wall that look to the south, turned by so much to the east or west, and of the even wall, in the sun from a
    /// direction so far off the wall's own.
    fn in_sun(turned: f32, off: f32) -> [f32; 2] {
        let level = |angle: f32| [angle.sin(), -angle.cos(), 0.0];
        let [even, facet, sun] = [0.0, turned, off].map(level);
        [facing_sun([even, facet, sun], 5.0), facing_sun([even, even, sun], 5.0)]
    }

    #[test]
    fn no_facet_of_a_wall_that_the_sun_grazes_is_much_brighter_than_the_wall() {
        for turned in [-0.6, -0.3, 0.3, 0.6] {
            let [facet, wall] = in_sun(turned, 1.45);
            assert!((facet - wall).abs() < 0.4 * wall, "{turned}: {facet} where the wall has {wall}");
        }
        // A facet alone would have nearly five times the light of the wall.
        assert!((1.45_f32 - 0.6).cos() > 4.8 * in_sun(0.6, 1.45)[1]);
    }

    #[test]
    fn facets_in_full_sun_and_on_slopes_are_as_bright_as_they_face_it() {
        for turned in [-0.5, 0.2, 0.5] {
            let [facet, _] = in_sun(turned, 0.1);
            assert!((facet - (turned - 0.1_f32).cos()).abs() < 0.02, "{turned}: {facet}");
            let [even, facet, sun] =
                [[0.0, 0.0, 1.0], [turned.sin(), 0.0, turned.cos()], [0.99_f32.sin(), 0.0, 0.99_f32.cos()]];
            assert_eq!(facing_sun([even, facet, sun], 0.5), dot(facet, sun));
        }
    }
}
