//! A field of so many sets of grass with a pond in it, on which drawing is measured, and from where.

use weald::grow::Vegetation;
use weald::grow::grass::{Bend, Maps, Meadow, SPECIES, Species};
use weald::picture::{Camera, LitScene, View};
use weald::{Domain, Error, Field, Landscape, Size};

use super::grass_look::GrassLook;
use super::options::Options;
use super::renderer::Renderer;
use crate::gpu::Gpu;

/// Cells a side.
const CELLS: usize = 64;

/// Sets on a square metre from which on a field of more sets is larger, not denser.
const DENSEST: f64 = 25.0;

/// Least side of a field in metres.
const MIN_SIDE: f64 = 64.0;

/// Metres between the valleys and the hills of the field, and the height up to which there is water.
const RELIEF: f32 = 3.0;
const WATER: f32 = 0.5;

/// Height of a person's eyes in metres, of one who lies, and of the bird that sees the whole field as a share of its side.
const EYES: f32 = 1.6;
const LYING: f32 = 0.4;
const BIRD: f32 = 0.3;

/// From where a field is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrassStandpoint {
    /// From above its southern end, so that all of it is seen.
    Far,
    /// From a person's height at its southern end.
    Eye,
    /// From among the blades in its middle.
    Near,
}

impl GrassStandpoint {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Far => "far",
            Self::Eye => "eye",
            Self::Near => "near",
        }
    }
}

/// A field that is ready to be drawn.
#[derive(Debug)]
pub(super) struct GrassField {
    pub(super) renderer: Renderer,
    scene: LitScene,
    side: f32,
}

impl GrassField {
    /// A field with about so many sets, and with a pond in it or not.
    pub(super) fn new(gpu: &Gpu, sets: u32, has_pond: bool, size: [u32; 2]) -> Result<Self, Error> {
        let [width, height] = size;
        let landscape = field(sets, has_pond)?;
        let view = View { width, height, field_of_view_deg: 50.0, ..View::default() };
        let scene = LitScene::new(&view, &landscape)?;
        let renderer = Renderer::planted(gpu, (&scene, &landscape), Options { size, samples: 4 })?;
        Ok(Self { renderer, scene, side: side(sets) as f32 })
    }

    /// The camera of a standpoint.
    pub(super) fn camera(&self, standpoint: GrassStandpoint) -> Camera {
        let half = self.scene.camera().half;
        let at = |north: f32, above: f32| {
            let place = [0.5 * f64::from(self.side), f64::from((1.0 - north) * self.side)];
            let ground = self.scene.top_at(place).unwrap_or(0.0);
            [place[0] as f32, -place[1] as f32, ground + above]
        };
        let towards = |eye, target| Camera::looking(eye, [0.0, 1.0, 0.0], half).towards(target);
        match standpoint {
            GrassStandpoint::Far => towards(at(-0.35, BIRD * self.side), at(0.5, 0.0)),
            GrassStandpoint::Eye => towards(at(0.04, EYES), at(0.5, 0.5)),
            GrassStandpoint::Near => towards(at(0.5, LYING), at(0.6, 0.3)),
        }
    }

    /// Sets what is shown of the grass.
    pub(super) fn show(&mut self, look: GrassLook) {
        self.renderer.set_grass_look(look);
    }

    /// How many sets there are, and how many are drawn from there.
    pub(super) fn count(&mut self, camera: &Camera) -> Result<[u64; 2], Error> {
        let chosen = self.renderer.chosen(camera)?;
        let drawn = |lists: &[Vec<u32>]| lists.iter().map(|list| list.len() as u64).sum::<u64>();
        Ok(chosen
            .iter()
            .fold([0; 2], |[all, seen], grass| [all + grass.sets.len() as u64, seen + drawn(&grass.lists)]))
    }
}

/// Side in metres of a field of so many sets.
fn side(sets: u32) -> f64 {
    MIN_SIDE.max((f64::from(sets) / DENSEST).sqrt())
}

/// Gentle hills and hollows, with water in the deepest or without.
fn field(sets: u32, has_pond: bool) -> Result<Landscape, Error> {
    let size = Size::square(CELLS)?;
    let cell = side(sets) / CELLS as f64;
    let height = Field::from_function(size, |x, y| {
        RELIEF * (0.5 * wave(x + 9, 2.0) + 0.5 * wave(y, 1.5) * wave(x, 1.0))
    });
    let water = Field::from_function(size, |x, y| (WATER - height.at(x, y)).max(0.0));
    let water = has_pond.then_some(water);
    let mut landscape = Landscape::new(Domain::new(size, cell));
    landscape.insert("height", "m", height);
    if let Some(water) = &water {
        landscape.insert("water", "m", water.clone());
    }
    landscape.sow("grass", meadow(sets, cell, water));
    Ok(landscape)
}

/// About so many sets, beside the water.
fn meadow(sets: u32, cell: f64, water: Option<Field>) -> Meadow {
    let size = Size { columns: CELLS, rows: CELLS };
    let filled = |value| Field::filled(size, value);
    let (density, soil, light, shares) = (filled(1.0), filled(0.8), filled(0.7), vec![filled(1.0)]);
    let maps = Maps { cell, valid: None, density, soil, light, shares, water, mown: None, trodden: None };
    let mut meadow = Meadow {
        species: vec![Species { splay: 0.0, ..SPECIES[0].clone() }],
        bend: Bend::Total,
        seed: 1,
        densest: f64::from(sets) / side(sets).powi(2),
        level: 4.0,
        mown_height: 0.05,
        deepest: 0.0,
        tussocks: 0.6,
        maps,
    };
    // None stand in the water and beyond the centres of the outermost cells.
    let found = meadow.sets(&meadow.area()).len();
    meadow.densest *= f64::from(sets) / found.max(1) as f64;
    meadow
}

/// Goes smoothly from 1 to 0 and back, so many times along a side.
fn wave(at: usize, times: f32) -> f32 {
    let off = (2.0 * (times * at as f32 / CELLS as f32).fract() - 1.0).abs();
    off * off * (3.0 - 2.0 * off)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_goes_from_one_to_nothing_and_back() {
        assert_eq!([0, CELLS / 2, CELLS].map(|at| wave(at, 1.0)), [1.0, 0.0, 1.0]);
        assert_eq!(wave(CELLS / 4, 1.0), 0.5);
    }
}
