//! Plants as one mesh in many places, in binary glTF: by `EXT_mesh_gpu_instancing` (Khronos Group, 2021), which a GPU
//! draws in one call, and by nodes that share the mesh, which every reader knows.
//!
//! For the wind a vertex has three more texture coordinates: `TEXCOORD_1` is how far it bends with the whole plant and in
//! which phase, `TEXCOORD_2` the same with its leaf, `TEXCOORD_3` the number of branchings below it and its stiffness
//! ([`foliage`](weald_plants::ifs::foliage)). An instance has `_PHASE`, to be added to both phases; a node has it under
//! `extras`.

use png::{BitDepth, ColorType};
use serde_json::{Map, Value, json};

use crate::Finished;
use crate::copies::{Copies, Placed, place_in_mesh};
use crate::mesh::document::{Document, Part};
use crate::mesh::extras::source;
use weald_core::error::Error;
use weald_core::plants::Plant;
use weald_io::png::Pixels;
use weald_plants::ifs::foliage::{Foliage, Texture};

/// Opacity from which a texel is leaf.
const CUTOFF: f32 = 0.3;

/// Leaves scatter light almost evenly.
const ROUGHNESS: f32 = 0.85;

/// One plant, one metre high.
pub(super) struct Model {
    pub(super) foliage: Foliage,
    pub(super) texture: Texture,
}

/// All that is in a file.
pub(super) struct Scene<'a> {
    pub(super) name: &'a str,
    pub(super) model: &'a Model,
    pub(super) plants: &'a [Plant],
    pub(super) finished: &'a Finished<'a>,
}

impl Scene<'_> {
    /// The file with one node for all plants.
    pub(super) fn instanced(&self) -> Result<Vec<u8>, Error> {
        let mut document = Document::default();
        self.copies(&mut document)?.instanced(&mut document);
        document.finish(&self.extras())
    }

    /// The file with a node for each plant.
    pub(super) fn nodes(&self) -> Result<Vec<u8>, Error> {
        let mut document = Document::default();
        self.copies(&mut document)?.nodes(&mut document);
        document.finish(&self.extras())
    }

    fn copies(&self, document: &mut Document) -> Result<Copies<'_>, Error> {
        let placed = self.plants.iter().map(|plant| {
            let [x, y, z] = plant.place;
            let place = place_in_mesh(&self.finished.landscape.domain, [x, y], z);
            Placed { place, rotation: plant.rotation(), scale: plant.size }
        });
        let phases = self.plants.iter().map(|plant| plant.phase).collect();
        let (name, mesh) = (self.name, self.mesh(document)?);
        Ok(Copies { name, mesh, placed: placed.collect(), numbers: vec![("phase", phases)] })
    }

    fn extras(&self) -> Value {
        let mut extras = source(self.finished);
        extras["plants"] = self.plants.len().into();
        extras
    }

    fn mesh(&self, document: &mut Document) -> Result<usize, Error> {
        let Model { foliage, texture } = self.model;
        let texture = document.texture("leaves", &png(texture)?);
        let material = document.material(json!({
            "name": self.name,
            "doubleSided": true,
            "alphaMode": "MASK",
            "alphaCutoff": CUTOFF,
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": texture }, "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS,
            },
        }));
        let mut attributes = Map::new();
        let mut add = |name: &str, accessor: Value| attributes.insert(name.to_owned(), accessor);
        add("POSITION", document.positions(&foliage.positions));
        add("NORMAL", document.vectors(&foliage.normals));
        for (number, pairs) in
            [&foliage.textures, &foliage.bends, &foliage.flutters, &foliage.branches].into_iter().enumerate()
        {
            add(&format!("TEXCOORD_{number}"), document.vectors(pairs));
        }
        let (triangles, vertices) = (foliage.triangles.as_slice(), foliage.positions.len());
        Ok(document.mesh(&Part { name: self.name, attributes, triangles, vertices, material }))
    }
}

fn png(texture: &Texture) -> Result<Vec<u8>, Error> {
    let Texture { width, height, rgba } = texture;
    let pixels =
        Pixels { sides: [*width, *height], channels: ColorType::Rgba, depth: BitDepth::Eight, bytes: rgba };
    pixels.marked(|encoder| {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        Ok(())
    })
}
