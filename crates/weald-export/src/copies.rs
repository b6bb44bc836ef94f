//! One mesh in many places, in binary glTF: as instances by `EXT_mesh_gpu_instancing` (Khronos Group, 2021), or as nodes
//! that share the mesh. Numbers of each copy are attributes of the instances, or `extras` of the nodes.

use serde_json::{Map, Value, json};

use super::mesh::document::Document;
use weald_core::domain::Domain;

/// The extension.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Where one copy of a mesh is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    /// Metres east, up and south of the middle of the domain.
    pub(super) place: [f32; 3],
    /// A quaternion x, y, z, w.
    pub(super) rotation: [f32; 4],
    /// Times the size of the mesh.
    pub(super) scale: f32,
}

/// All copies of a mesh.
pub(super) struct Copies<'a> {
    /// Name of the node, and the beginning of the names of many.
    pub(super) name: &'a str,
    /// Number of the mesh in the document.
    pub(super) mesh: usize,
    /// Where they are.
    pub(super) placed: Vec<Placed>,
    /// Numbers that are said of each copy, by their names in small letters.
    pub(super) numbers: Vec<(&'static str, Vec<f32>)>,
}

impl Copies<'_> {
    /// Adds a node with an instance for each copy; none where there is no copy.
    pub(super) fn instanced(&self, document: &mut Document) {
        if self.placed.is_empty() {
            return;
        }
        document.require(INSTANCING);
        let mut attributes = Map::new();
        let mut add = |name: &str, accessor: Value| attributes.insert(name.to_owned(), accessor);
        let places: Vec<_> = self.placed.iter().map(|copy| copy.place).collect();
        add("TRANSLATION", document.instances(&places));
        let rotations: Vec<_> = self.placed.iter().map(|copy| copy.rotation).collect();
        add("ROTATION", document.instances(&rotations));
        let scales: Vec<_> = self.placed.iter().map(|copy| [copy.scale; 3]).collect();
        add("SCALE", document.instances(&scales));
        for (name, numbers) in &self.numbers {
            let numbers: Vec<_> = numbers.iter().map(|&number| [number]).collect();
            add(&format!("_{}", name.to_ascii_uppercase()), document.instances(&numbers));
        }
        document.node(json!({
            "name": self.name, "mesh": self.mesh, "extensions": { INSTANCING: { "attributes": attributes } },
        }));
    }

    /// Adds a node for each copy.
    pub(super) fn nodes(&self, document: &mut Document) {
        for (id, Placed { place, rotation, scale }) in self.placed.iter().enumerate() {
            let numbers = self.numbers.iter().map(|(name, numbers)| ((*name).to_owned(), numbers[id].into()));
            let scales = [scale; 3];
            document.node(json!({
                "name": format!("{}-{id}", self.name),
                "mesh": self.mesh,
                "translation": place,
                "rotation": rotation,
                "scale": scales,
                "extras": Value::Object(numbers.collect()),
            }));
        }
    }
}

/// A place in the axes of a mesh, from metres east and south of the north-western corner and a height.
pub(super) fn place_in_mesh(domain: &Domain, [x, y]: [f64; 2], height: f64) -> [f32; 3] {
    let [width, depth] = domain.extent();
    [x - 0.5 * width, height, y - 0.5 * depth].map(|number| number as f32)
}
