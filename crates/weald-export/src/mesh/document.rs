//! A glTF document in one binary file.
//!
//! Khronos Group, "glTF 2.0 Specification", revision 2.0.1 (2021), ISO/IEC 12113:2022. A `.glb` is a header of twelve
//! bytes, a chunk of JSON, padded with spaces, and a chunk of bytes to which accessors of the JSON point, padded with
//! zeros; all numbers are little-endian.

use serde_json::{Map, Value, json};

use weald_core::error::{Error, Limit, Quantity};

/// Codes of the specification.
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const CLAMP_TO_EDGE: u32 = 33071;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// Vertices that 16-bit indices can name: the last number restarts a strip.
const MAX_SHORT_INDEX: usize = 65_535;

/// A document as it grows.
#[derive(Debug, Default)]
pub(crate) struct Document {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    /// Extensions without which the file means nothing.
    extensions: Vec<&'static str>,
}

/// A mesh to be added.
#[derive(Debug)]
pub(crate) struct Part<'a> {
    /// Name of its node.
    pub(crate) name: &'a str,
    /// Names of attributes and their accessors.
    pub(crate) attributes: Map<String, Value>,
    /// Vertices of each triangle.
    pub(crate) triangles: &'a [[u32; 3]],
    /// Number of vertices.
    pub(crate) vertices: usize,
    /// Its material.
    pub(crate) material: usize,
}

impl Document {
    /// Adds an accessor to vectors, one a vertex, and gives its number.
    pub(crate) fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> Value {
        self.numbers(vectors, Some(ARRAY_BUFFER))
    }

    /// The same, one an instance.
    pub(crate) fn instances<const N: usize>(&mut self, vectors: &[[f32; N]]) -> Value {
        self.numbers(vectors, None)
    }

    fn numbers<const N: usize>(&mut self, vectors: &[[f32; N]], target: Option<u32>) -> Value {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = self.view(&bytes, target);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.accessors.push(
            json!({ "bufferView": view, "componentType": FLOAT, "count": vectors.len(), "type": kind }),
        );
        (self.accessors.len() - 1).into()
    }

    /// The same with the bounds that positions must have.
    pub(crate) fn positions(&mut self, vectors: &[[f32; 3]]) -> Value {
        let bound = |pick: fn(f32, f32) -> f32| {
            let first = vectors.first().copied().unwrap_or_default();
            vectors
                .iter()
                .fold(first, |bound, vector| std::array::from_fn(|axis| pick(bound[axis], vector[axis])))
        };
        let (low, high) = (bound(f32::min), bound(f32::max));
        let accessor = self.vectors(vectors);
        let object = self.accessors.last_mut().and_then(Value::as_object_mut).expect("one was added");
        object.insert("min".to_owned(), json!(low));
        object.insert("max".to_owned(), json!(high));
        accessor
    }

    /// Adds an image with a texture of it and gives the texture's number.
    pub(crate) fn texture(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.view(png, None);
        self.images.push(json!({ "name": name, "mimeType": "image/png", "bufferView": view }));
        self.textures.push(json!({ "name": name, "sampler": 0, "source": self.images.len() - 1 }));
        self.textures.len() - 1
    }

    /// Adds a material and gives its number.
    pub(crate) fn material(&mut self, material: Value) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a mesh with a node of its name.
    pub(crate) fn add(&mut self, part: &Part<'_>) {
        let mesh = self.mesh(part);
        self.node(json!({ "name": part.name, "mesh": mesh }));
    }

    /// Adds a node.
    pub(crate) fn node(&mut self, node: Value) {
        self.nodes.push(node);
    }

    /// Names an extension that a reader must know; once, however often it is asked for.
    pub(crate) fn require(&mut self, extension: &'static str) {
        if !self.extensions.contains(&extension) {
            self.extensions.push(extension);
        }
    }

    /// Adds a mesh without a node and gives its number.
    pub(crate) fn mesh(&mut self, part: &Part<'_>) -> usize {
        let indices = self.indices(part.triangles, part.vertices);
        let primitive =
            json!({ "attributes": part.attributes, "indices": indices, "material": part.material });
        self.meshes.push(json!({ "name": part.name, "primitives": [primitive] }));
        self.meshes.len() - 1
    }

    fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> usize {
        let numbers = triangles.as_flattened().iter();
        let (bytes, component): (Vec<u8>, u32) = if vertices <= MAX_SHORT_INDEX {
            (numbers.flat_map(|&number| (number as u16).to_le_bytes()).collect(), UNSIGNED_SHORT)
        } else {
            (numbers.flat_map(|number| number.to_le_bytes()).collect(), UNSIGNED_INT)
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let count = 3 * triangles.len();
        self.accessors.push(
            json!({ "bufferView": view, "componentType": component, "count": count, "type": "SCALAR" }),
        );
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let (Some(target), Some(view)) = (target, view.as_object_mut()) {
            view.insert("target".to_owned(), target.into());
        }
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    /// The bytes of the file. `extras` are said of the whole.
    ///
    /// # Errors
    /// [`Error::Limit`] where it would be longer than 4 GiB, which its header cannot say.
    pub(crate) fn finish(self, extras: &Value) -> Result<Vec<u8>, Error> {
        let nodes: Vec<_> = (0..self.nodes.len()).collect();
        let mut document = Map::new();
        let generator = format!("Weald {}", env!("CARGO_PKG_VERSION"));
        let asset = json!({ "version": "2.0", "generator": generator, "extras": extras });
        document.insert("asset".to_owned(), asset);
        document.insert("scene".to_owned(), 0.into());
        let mut scene = json!({ "name": "landscape" });
        if !nodes.is_empty() {
            scene["nodes"] = nodes.into();
        }
        document.insert("scenes".to_owned(), json!([scene]));
        document.insert("buffers".to_owned(), json!([{ "byteLength": self.bytes.len() }]));
        let sampler = json!({
            "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE
        });
        let samplers = if self.textures.is_empty() { Vec::new() } else { vec![sampler] };
        for (key, list) in [
            ("extensionsUsed", self.extensions.iter().map(|&name| name.into()).collect()),
            ("extensionsRequired", self.extensions.iter().map(|&name| name.into()).collect()),
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("textures", self.textures),
            ("images", self.images),
            ("samplers", samplers),
            ("accessors", self.accessors),
            ("bufferViews", self.views),
        ] {
            // An empty list is not allowed.
            if !list.is_empty() {
                document.insert(key.to_owned(), list.into());
            }
        }
        container(Value::Object(document).to_string().into_bytes(), self.bytes)
    }
}

/// What makes a file of meshes shorter.
const REMEDY: &str = "choose a larger `error`, a smaller `texture`, or fewer plants";

fn container(mut json: Vec<u8>, bytes: Vec<u8>) -> Result<Vec<u8>, Error> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let whole = 12 + 8 + json.len() + 8 + bytes.len();
    let length = u32::try_from(whole).map_err(|_| {
        let limit = Limit::new(Quantity::FileBytes, whole as u64, 0..=u64::from(u32::MAX));
        limit.of("a .glb, whose header says how long it is").remedy(REMEDY)
    })?;
    let mut file = Vec::with_capacity(whole);
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend(length.to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", bytes)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}
