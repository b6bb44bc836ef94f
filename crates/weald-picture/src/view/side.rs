//! The cut sides of a landscape: its materials, or beds of rock, below the surface.

use super::site::hidden;
use super::sky::Sky;
use super::surface::Surface;
use super::vector::{Vector, add, dot, ramp, scale};
use crate::colour::{Linear, linear_of_hex, mix};
use weald_core::grain::{Octaves, grain};

/// Normals of upright sides for which the light of the sky is known.
pub(super) const NORMALS: usize = 32;

/// Light of the open sky on upright sides.
#[derive(Debug)]
pub(super) struct SideLight {
    pub(super) light: [Vector; NORMALS],
}

impl SideLight {
    /// Light of the sky above the horizon, and of a plain of that radiance below it.
    pub(super) fn new(sky: &Sky, plain: Vector) -> Self {
        let light = std::array::from_fn(|turn| {
            let around = std::f32::consts::TAU * turn as f32 / NORMALS as f32;
            let normal = [libm::sinf(around), libm::cosf(around), 0.0];
            add(sky_on(sky, normal), scale(plain, 0.5 * std::f32::consts::PI))
        });
        Self { light }
    }

    /// The light on a side of that level normal.
    pub(super) fn on(&self, normal: Vector) -> Vector {
        let turn = libm::atan2f(normal[0], normal[1]) / std::f32::consts::TAU;
        let place = (turn - turn.floor()) * NORMALS as f32;
        let first = place as usize;
        mix(self.light[first % NORMALS], self.light[(first + 1) % NORMALS], place - first as f32)
    }
}

fn sky_on(sky: &Sky, normal: Vector) -> Vector {
    const UP: usize = 12;
    const AROUND: usize = 32;
    let mut sum = [0.0; 3];
    for patch in 0..UP * AROUND {
        let up = ((patch / AROUND) as f32 + 0.5) / UP as f32;
        let turn = std::f32::consts::TAU * ((patch % AROUND) as f32 + 0.5) / AROUND as f32;
        let across = (1.0 - up * up).sqrt();
        let direction = [across * libm::sinf(turn), across * libm::cosf(turn), up];
        let share = dot(direction, normal).max(0.0) * std::f32::consts::TAU / (UP * AROUND) as f32;
        sum = add(sum, scale(sky.radiance(direction), share));
    }
    sum
}

/// What the ground is made of, where it is cut.
#[derive(Debug)]
pub(super) struct Strata {
    /// Materials above the bedrock, lowest first: thickness in metres and colour.
    pub(super) materials: Vec<(Surface, Linear)>,
    pub(super) bedrock: Linear,
    /// Height of the bedrock in metres above the lowest ground, where materials lie on it.
    pub(super) floor: Option<Surface>,
    /// Usual thickness of a bed, in metres.
    pub(super) bed: f32,
    pub(super) soil: Linear,
    /// Thickness of the dark band of soil, in metres.
    pub(super) soil_thickness: f32,
}

impl Strata {
    /// Materials with their thickness and colour over bedrock of a colour, in ground of that relief.
    pub(super) fn new(
        materials: Vec<(Surface, Linear)>,
        (bedrock, floor): (Linear, Option<Surface>),
        relief: f32,
    ) -> Self {
        let soil = linear_of_hex(0x4a_3b2b);
        Self { materials, bedrock, floor, bed: 0.06 * relief.max(1e-3), soil, soil_thickness: 0.012 * relief }
    }

    /// The same for places that are counted in finer cells.
    #[must_use]
    pub(super) fn on_finer(self, fineness: usize) -> Self {
        let materials = self.materials.into_iter();
        let materials = materials.map(|(thickness, colour)| (thickness.on_finer(fineness), colour)).collect();
        Self { materials, floor: self.floor.map(|floor| floor.on_finer(fineness)), ..self }
    }

    /// Colour of the ground at a place and a height in metres, whose surface is at `surface`.
    pub(super) fn albedo(&self, place: [f32; 2], point: Vector, [height, surface]: [f32; 2]) -> Linear {
        let mut roof = surface;
        for (at, (thickness, colour)) in self.materials.iter().enumerate().rev() {
            roof -= thickness.at(place).max(0.0);
            if height >= roof {
                return self.bedded(*colour, point, height, at as u32 + 1);
            }
        }
        let rock = self.bedded(self.bedrock, point, height, 0);
        if !self.materials.is_empty() {
            return rock;
        }
        let deep = (surface - height) / self.soil_thickness.max(1e-6);
        mix(self.soil, rock, (2.0 * deep - 1.0).clamp(0.0, 1.0))
    }

    /// Colour of the material that lies at a place and a height in metres, where edges between materials are so many metres
    /// soft, and the height of the uppermost there.
    pub(super) fn material(&self, place: [f32; 2], height: f32, soft: f32) -> (Linear, f32) {
        let mut bottom = self.floor.as_ref().map_or(0.0, |floor| floor.at(place));
        let mut colour = self.bedrock;
        for (thickness, own) in &self.materials {
            let thickness = thickness.at(place).max(0.0);
            let share = ramp(height - bottom, -soft, soft) * hidden(thickness);
            colour = mix(colour, *own, share);
            bottom += thickness;
        }
        (colour, bottom)
    }

    /// A rock's colour with its beds, which are gently folded.
    fn bedded(&self, colour: Linear, point: Vector, height: f32, seed: u32) -> Linear {
        let fold =
            Octaves { wavelength: 60.0 * self.bed, count: 2, gain: 0.4, seed: 0x71 }.at(point, 0.0).value;
        let level = height / self.bed + 5.0 * fold;
        let thick = grain([0.7 * level, 0.37], 0x72 + seed).value;
        let thin = grain([3.1 * level, 0.61], 0x73 + seed).value;
        let tone = 0.82 + 0.7 * thick + 0.35 * thin;
        let warmth = 0.16 * grain([0.9 * level, 5.3], 0x74).value;
        std::array::from_fn(|c| (colour[c] * tone * (1.0 + warmth * (1.0 - c as f32))).clamp(0.01, 0.9))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};

    const COLOURS: [Linear; 4] = [[0.1; 3], [0.2; 3], [0.3; 3], [0.4; 3]];

    /// Bedrock up to 100 m, then 50 m, 30 m and a film of three materials.
    fn strata() -> Strata {
        let even = |height: f32| Surface::new(&Field::filled(Size::square(5).expect("small"), height));
        let materials =
            [(1, 50.0), (2, 30.0), (3, 0.0)].map(|(at, thickness)| (even(thickness), COLOURS[at]));
        Strata::new(materials.into(), (COLOURS[0], Some(even(100.0))), 200.0)
    }

    #[test]
    fn a_material_lies_between_its_bottom_and_the_next_and_a_film_hides_nothing() {
        for (height, expected) in [(90.0, 0), (99.0, 0), (101.0, 1), (149.0, 1), (151.0, 2), (185.0, 2)] {
            let (found, top) = strata().material([2.0, 3.0], height, 0.2);
            assert!((found[0] - COLOURS[expected][0]).abs() < 1e-3, "{found:?} at {height} m");
            assert!((top - 180.0).abs() < 1e-3, "{top} m");
        }
    }

    #[test]
    fn edges_between_materials_are_as_soft_as_is_asked() {
        let at = |height: f32| strata().material([2.0, 3.0], height, 4.0).0[0];
        assert!((at(150.0) - 0.25).abs() < 1e-3 && at(145.9) == at(130.0) && at(154.1) == at(160.0));
        assert!(at(148.0) < at(149.0) && at(151.0) < at(152.0));
    }
}
