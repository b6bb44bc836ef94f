//! Grass as one mesh a species in many places, in binary glTF: by `EXT_mesh_gpu_instancing` (Khronos Group, 2021), and by
//! nodes that share the meshes.
//!
//! The mesh is a set of six blades of level 4 on the mean of the soil and the light where the species stands. An instance is
//! turned as its set is and as high as its blades are; `_SOIL`, `_LIGHT`, `_LEVEL`, `_CUT`, `_TRODDEN` and `_BLEND`, the
//! share of the good colour, let a shader grow it better, and `_PHASE` is its place in the wind. A node has them under
//! `extras`. For the wind a vertex has `TEXCOORD_1`: how far it bends, 0 at the root to 1 at the tip, and its blade's phase.

use serde_json::{Map, Value, json};

use crate::Finished;
use crate::copies::{Copies, Placed, place_in_mesh};
use crate::mesh::document::{Document, Part};
use crate::mesh::extras::source;
use weald_core::error::Error;
use weald_plants::grass::{BLADES, Blade, Growth, Instance, LEVELS, Meadow, Set, blade};

/// Blades scatter light almost evenly.
const ROUGHNESS: f32 = 0.8;

/// A set, and the height of the ground there.
pub(super) struct Standing {
    pub(super) instance: Instance,
    pub(super) height: f32,
}

/// All that is in a file.
pub(super) struct Scene<'a> {
    pub(super) name: &'a str,
    pub(super) meadow: &'a Meadow,
    pub(super) sets: &'a [Standing],
    pub(super) finished: &'a Finished<'a>,
}

/// The sets of a species, and what its mesh is made of.
struct Kind<'a> {
    name: String,
    sets: Vec<&'a Standing>,
    mesh: usize,
    /// Height in metres of the set that the mesh shows.
    height: f32,
}

/// The vertices of a set.
#[derive(Default)]
struct Ribbons {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    colours: Vec<[f32; 3]>,
    textures: Vec<[f32; 2]>,
    bends: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl Scene<'_> {
    /// The file with a node for each species.
    pub(super) fn instanced(&self) -> Result<Vec<u8>, Error> {
        let mut document = Document::default();
        for kind in self.kinds(&mut document) {
            self.copies(&kind).instanced(&mut document);
        }
        document.finish(&self.extras())
    }

    /// The file with a node for each set.
    pub(super) fn nodes(&self) -> Result<Vec<u8>, Error> {
        let mut document = Document::default();
        for kind in self.kinds(&mut document) {
            self.copies(&kind).nodes(&mut document);
        }
        document.finish(&self.extras())
    }

    fn copies<'b>(&self, kind: &'b Kind<'_>) -> Copies<'b> {
        let domain = &self.finished.landscape.domain;
        let placed = kind.sets.iter().map(|set| Placed {
            place: place_in_mesh(domain, set.instance.place.map(f64::from), f64::from(set.height)),
            rotation: rotation(set),
            scale: self.scale(set, kind),
        });
        let numbers = ATTRIBUTES
            .iter()
            .map(|(name, number)| (*name, kind.sets.iter().map(|set| number(self, set)).collect()));
        Copies { name: &kind.name, mesh: kind.mesh, placed: placed.collect(), numbers: numbers.collect() }
    }

    fn extras(&self) -> Value {
        let mut extras = source(self.finished);
        extras["sets"] = self.sets.len().into();
        extras["blades_of_a_set"] = BLADES.into();
        extras
    }

    /// The species that stand there, with their meshes.
    fn kinds(&self, document: &mut Document) -> Vec<Kind<'_>> {
        let mut kinds = Vec::new();
        for number in 0..self.meadow.species.len() {
            let of_kind = |set: &&Standing| set.instance.species as usize == number;
            let sets: Vec<_> = self.sets.iter().filter(of_kind).collect();
            if sets.is_empty() {
                continue;
            }
            let mean = |of: fn(&Set) -> f32| {
                sets.iter().map(|set| f64::from(of(&set.instance.tuft))).sum::<f64>() as f32
                    / sets.len() as f32
            };
            let (soil, light) = (mean(|set| set.soil), mean(|set| set.light));
            let tuft = Set { soil, light, level: LEVELS as f32, cut: 1.0, trodden: 0.0, seed: 0 };
            let name = format!("{}-{}", self.name, self.meadow.species[number].name);
            let mesh = self.mesh(document, &name, number, &tuft);
            kinds.push(Kind { name, sets, mesh, height: self.height(number, &tuft) });
        }
        kinds
    }

    fn height(&self, species: usize, tuft: &Set) -> f32 {
        tuft.height(&self.meadow.species[species], self.meadow.bend)
    }

    /// How many times the mesh's size a set has.
    fn scale(&self, set: &Standing, kind: &Kind<'_>) -> f32 {
        // Bare ground is a very small set: a scale of 0 has no inverse.
        (self.height(set.instance.species as usize, &set.instance.tuft) / kind.height.max(1e-6)).max(1e-3)
    }

    fn blend(&self, set: &Standing) -> f32 {
        let Instance { species, tuft, .. } = set.instance;
        Growth::at(&self.meadow.species[species as usize].curves, tuft.soil, tuft.light).blend
    }

    fn mesh(&self, document: &mut Document, name: &str, species: usize, tuft: &Set) -> usize {
        let ribbons = self.ribbons(species, tuft);
        let material = document.material(json!({
            "name": name,
            "doubleSided": true,
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS },
        }));
        let mut attributes = Map::new();
        let mut add = |name: &str, accessor: Value| attributes.insert(name.to_owned(), accessor);
        add("POSITION", document.positions(&ribbons.positions));
        add("NORMAL", document.vectors(&ribbons.normals));
        add("COLOR_0", document.vectors(&ribbons.colours));
        add("TEXCOORD_0", document.vectors(&ribbons.textures));
        add("TEXCOORD_1", document.vectors(&ribbons.bends));
        let (triangles, vertices) = (ribbons.triangles.as_slice(), ribbons.positions.len());
        document.mesh(&Part { name, attributes, triangles, vertices, material })
    }

    fn ribbons(&self, species: usize, tuft: &Set) -> Ribbons {
        let species = &self.meadow.species[species];
        let rows = blade::rows(tuft.level);
        let mut ribbons = Ribbons::default();
        for number in 0..BLADES {
            let first = ribbons.positions.len() as u32;
            let vertices = Blade::of(species, tuft, number, self.meadow.bend).vertices(rows);
            for (place, vertex) in vertices.enumerate() {
                ribbons.positions.push(vertex.place);
                ribbons.normals.push(vertex.normal);
                ribbons.colours.push(species.colour(vertex.blend, vertex.head));
                ribbons.textures.push([(place % 2) as f32, 1.0 - vertex.along]);
                ribbons.bends.push([vertex.along * vertex.along, number as f32 / BLADES as f32]);
            }
            for row in 0..rows as u32 - 1 {
                let corner = first + 2 * row;
                ribbons.triangles.push([corner, corner + 1, corner + 2]);
                ribbons.triangles.push([corner + 2, corner + 1, corner + 3]);
            }
        }
        ribbons
    }
}

/// A number that is said of an instance.
type Attribute = (&'static str, fn(&Scene<'_>, &Standing) -> f32);

/// What is said of an instance beside where it stands.
const ATTRIBUTES: [Attribute; 7] = [
    ("soil", |_, set| set.instance.tuft.soil),
    ("light", |_, set| set.instance.tuft.light),
    ("level", |_, set| set.instance.tuft.level),
    ("cut", |_, set| set.instance.tuft.cut),
    ("trodden", |_, set| set.instance.tuft.trodden),
    ("blend", |scene, set| scene.blend(set)),
    ("phase", |_, set| set.instance.tuft.phase()),
];

/// The turn of a set about the vertical, beyond that of the mesh, as a quaternion x, y, z, w.
fn rotation(set: &Standing) -> [f32; 4] {
    let turns = set.instance.tuft.turns() - Set { seed: 0, ..set.instance.tuft }.turns();
    let (sine, cosine) = libm::sincos(-std::f64::consts::PI * f64::from(turns));
    [0.0, sine as f32, 0.0, cosine as f32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::parameter::Nested;
    use weald_engine::Job;
    use weald_engine::step::Step;
    use weald_plants::Vegetation;
    use weald_plants::grass_step::{Grass, Kind};

    #[test]
    fn a_set_is_turned_by_as_much_as_its_blades_are_turned_beyond_those_of_the_mesh() {
        for seed in 0..50 {
            let tuft = Set { soil: 0.5, light: 0.5, level: 4.0, cut: 1.0, trodden: 0.0, seed };
            let standing = Standing { instance: Instance { place: [0.0; 2], species: 0, tuft }, height: 0.0 };
            let [x, y, z, w] = rotation(&standing).map(f64::from);
            assert_eq!([x, z], [0.0; 2], "about the vertical");
            let turns = f64::from(tuft.turns() - Set { seed: 0, ..tuft }.turns());
            // A quaternion and its negative are the same turn.
            let off = 2.0 * libm::atan2(y, w) / std::f64::consts::TAU + turns;
            assert!((off - libm::round(off)).abs() < 1e-6, "seed {seed} is off by {off} of a turn");
        }
    }

    #[test]
    fn an_instance_is_as_much_smaller_than_the_mesh_as_its_blades_are() {
        let size = weald_core::grid::Size::square(8).expect("small");
        let mut landscape = weald_core::landscape::Landscape::new(weald_core::domain::Domain::new(size, 2.0));
        for name in ["height", "fertility", "light", "moisture"] {
            landscape.insert(name, "1", weald_core::grid::Field::filled(size, 0.5));
        }
        let fescue = Kind { name: "fescue".to_owned(), ..Kind::default() };
        let grass = Grass { species: vec![Nested(fescue)], ..Grass::default() };
        grass.run(&mut landscape, &Job::unwatched(3)).expect("grows");
        let finished = Finished { landscape: &landscape, steps: &[], recipe: "r", hash: "", seed: 0 };
        let meadow = landscape.meadow("grass").expect("grown");
        let scene = Scene { name: "grass", meadow: &meadow, sets: &[], finished: &finished };
        let standing = |level: f32| {
            let tuft = Set { soil: 0.5, light: 0.5, level, cut: 1.0, trodden: 0.0, seed: 7 };
            Standing { instance: Instance { place: [4.0; 2], species: 0, tuft }, height: 0.0 }
        };
        let [grown, young] = [4.0, 1.0].map(standing);
        let kind = super::Kind {
            name: String::new(),
            sets: Vec::new(),
            mesh: 0,
            height: scene.height(0, &grown.instance.tuft),
        };
        assert_eq!(scene.scale(&grown, &kind), 1.0);
        let scale = scene.scale(&young, &kind);
        assert!((0.01..0.9).contains(&scale), "{scale} of the height at the first level");
    }
}
