//! The ground as a mesh of triangles, in one binary glTF file.
//!
//! The mesh is as coarse as a stated error allows, and a normal map gives it back the relief of all cells. Its axes
//! are those of glTF, in metres: x east, y up, z south, so that north is -z; the origin is the middle of the domain
//! at height 0, because 32-bit floats hold no millimetres at coordinates of a CRS. Vertices stand on the centres of
//! cells: the mesh reaches from the first centre to the last, one cell less than the domain. Textures cover all cells
//! to their outer edges.
//!
//! Ground without data is left open; a cell with data that is no corner of half a square of such cells has no area
//! and is left out. The file says under `asset.extras` which recipe made it, how far the mesh is from the ground, and
//! where its origin lies in the CRS.

mod delaunay;
pub(super) mod document;
pub(super) mod extras;
mod frame;
mod greedy;
mod normal_map;
mod plane;
mod sampling;
mod scan;
mod skirt;
mod slopes;
mod standing;
mod surface;
mod tangent;
#[cfg(test)]
mod tests;
mod textures;
mod tin;
mod vector;
mod vertices;
mod water;

use std::path::Path;

use serde_json::{Map, Value, json};

use self::document::Document;
use self::frame::Frame;
use self::greedy::follow;
use self::skirt::Skirt;
use self::slopes::Slopes;
use self::surface::Surface;
use self::textures::normal_png;
use self::tin::Tin;
use self::vertices::{Vertices, signed, single};
use self::water::Water;
use super::{Export, Finished};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::LayerName;
use weald_io::Part;
use weald_picture::{GroundColour, Image, Tint, View, albedo, fits_on_sheet, linear_of_srgb, tinted};

weald_core::choices! {
    /// Colours of a mesh.
    pub enum Colours {
        /// Meadow, forest, scree, rock and snow, as in a picture `view`.
        Natural = "natural",
        /// Those of the materials at the surface, as in a picture `view`.
        Materials = "materials",
        /// By height, in the tints of `ramp`.
        Tints = "tints",
        /// One colour, that of the bedrock, and no texture.
        Plain = "plain",
    }
}

weald_core::parameters! {
    /// A terrain mesh.
    pub struct Mesh {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Greatest distance, straight up or down, of the mesh from the ground at the centre of any cell. The mesh
        /// has as few triangles as greedy insertion finds for it.
        error: f64 = 1.0, range 0.001..=10000.0, unit "m";
        /// Colours of the ground, without light and shade. By default `materials` where the recipe names materials of
        /// its own, else `natural`.
        colours: Option<Colours> = None;
        /// Elevation from which snow lies on natural ground that is not too steep. By default there is none.
        snow_line: Option<f64> = None, unit "m", unless colours = "materials" | "tints" | "plain";
        /// Colours of heights.
        ramp: Tint = Tint::Hypsometric, when colours = "tints";
        /// Width of the colour texture; its height follows from the landscape's shape. By default its longer side has one
        /// texel a cell, but 1024 at least and 4096 at most.
        texture: Option<u32> = None, range 16..=16384, unit "px", unless colours = "plain";
        /// Whether a normal map of one texel a cell, at most 4096 a side, gives the mesh the relief that the error
        /// allowed it to leave out.
        normal_map: bool = true;
        /// Whether water (layer `water`, or `lake_depth` where there is none) becomes a mesh of its own, "water". The
        /// ground beside it is followed more closely, to a fifth of `error` at most, so that shores stay shores.
        water: bool = true;
        /// Depth from which water is drawn: rain lies on all slopes as a film.
        shallowest: f64 = 0.5, range 0.001..=1000.0, unit "m", when water = true;
        /// Depth of walls below the lowest point that close the edges of the mesh; 0 leaves them open.
        skirt: f64 = 0.0, range 0.0..=100_000.0, unit "m";
    }
}

/// Most vertices of a mesh: 2^24, some 800 MB in a file.
const MAX_VERTICES: usize = 1 << 24;

impl Export for Mesh {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        let water: &[&str] = if self.water { &["water", "lake_depth", "flux_x", "flux_y"] } else { &[] };
        ["soil_depth", "moisture", "deposition"].iter().chain(water).map(|name| (*name).to_owned()).collect()
    }

    /// Errors of all points, triangles and textures, on rough ground with water; smooth ground takes a third.
    fn working_bytes(&self, cells: u64) -> u64 {
        200 * cells
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let placed = finished.landscape.domain.georeference.is_some();
        let note = "the mesh is in metres around the middle of the domain; `asset.extras.origin` in the file says \
                    where that lies in the CRS";
        placed.then(|| note.to_owned()).into_iter().collect()
    }

    fn check_on(&self, domain: &Domain, _: &Path) -> Result<(), Error> {
        ensure_cells(domain.size)?;
        let has_texture = !matches!(self.colours, Some(Colours::Plain));
        if has_texture { fits_on_sheet(domain, self.texture) } else { Ok(()) }
    }

    fn parts(&self, finished: &Finished<'_>, _: &Path) -> Result<Vec<Part>, Error> {
        let landscape = finished.landscape;
        let ground = ground_of(landscape, &self.of.0)?;
        let water = self.water.then(|| Water::of(landscape, ground, self.shallowest as f32)).flatten();
        let surface = self.surface(landscape, ground, water.as_ref());
        let mesh = follow(&surface, MAX_VERTICES)?;
        if mesh.triangles.is_empty() {
            return Err(Error::Run(
                "no three cells with data are neighbours: there is no ground to mesh".to_owned(),
            ));
        }
        let mut document = Document::default();
        self.add_ground(&mut document, landscape, ground, &mesh)?;
        if let Some(water) = &water {
            self.add_water(&mut document, landscape, water)?;
        }
        let extras = extras::of(finished, &self.of.0, self.error, mesh.deviation(&surface));
        Ok(vec![Part::own(document.finish(&extras)?)])
    }
}

fn ensure_cells(size: Size) -> Result<(), Error> {
    if size.columns >= 2 && size.rows >= 2 {
        return Ok(());
    }
    Err(Error::Run(format!("a mesh needs 2 × 2 cells or more; the landscape has {size}")))
}

/// The heights, where they can become a mesh.
fn ground_of<'a>(landscape: &'a Landscape, name: &str) -> Result<&'a Field, Error> {
    let ground = landscape.field(name)?;
    ensure_cells(landscape.domain.size)?;
    if let Some((x, y)) = ground.first_not_finite(landscape.domain.valid.as_ref()) {
        let height = ground.at(x, y);
        return Err(Error::Run(format!(
            "the layer `{name}` holds {height} in column {x}, row {y}, which is no height; mend it, or mark the cell \
             as no-data"
        )));
    }
    Ok(ground)
}

impl Mesh {
    /// What the triangles are to follow: the ground, and beside water more closely.
    fn surface<'a>(&self, landscape: &'a Landscape, ground: &'a Field, water: Option<&Water>) -> Surface<'a> {
        let land = landscape.domain.valid.as_ref();
        match water {
            Some(water) => water.spared(ground, land, self.error),
            None => Surface::new(ground, land, self.error),
        }
    }

    fn add_ground(
        &self,
        document: &mut Document,
        landscape: &Landscape,
        ground: &Field,
        mesh: &Tin,
    ) -> Result<(), Error> {
        let domain = &landscape.domain;
        let slopes = Slopes::of(ground, domain.valid.as_ref(), domain.cell);
        let vertices = Vertices::of(mesh, ground, &slopes, &Frame::of(domain));
        let normal_map = self.normal_map.then(|| {
            let png = normal_png(mesh, &vertices, &slopes, domain.valid.as_ref());
            document.texture("normals", &png)
        });
        let mut attributes = attributes(document, &vertices);
        if normal_map.is_some() {
            attributes.insert("TANGENT".to_owned(), document.vectors(&signed(&vertices.tangents)));
        }
        let material = self.ground_material(document, landscape, normal_map)?;
        document.add(&document::Part {
            name: "terrain",
            attributes,
            triangles: &mesh.triangles,
            vertices: mesh.points.len(),
            material,
        });
        if self.skirt > 0.0 {
            self.add_skirt(document, landscape, mesh, &vertices);
        }
        Ok(())
    }

    fn ground_material(
        &self,
        document: &mut Document,
        landscape: &Landscape,
        normal_map: Option<usize>,
    ) -> Result<usize, Error> {
        let Some(image) = self.image(landscape)? else {
            let colour = bedrock_colour(&landscape.materials);
            return Ok(document.material(rough(
                "terrain",
                &json!({ "baseColorFactor": colour }),
                normal_map,
            )));
        };
        let texture = document.texture("colours", &image.to_png(&[]));
        let colour = json!({ "baseColorTexture": { "index": texture } });
        Ok(document.material(rough("terrain", &colour, normal_map)))
    }

    /// The colours, where there is more than one.
    fn image(&self, landscape: &Landscape) -> Result<Option<Image>, Error> {
        let ground = match self.colours {
            Some(Colours::Plain) => return Ok(None),
            Some(Colours::Tints) => return tinted(landscape, &self.of.0, self.ramp, self.texture).map(Some),
            Some(Colours::Natural) => Some(GroundColour::Natural),
            Some(Colours::Materials) => Some(GroundColour::Materials),
            None => None,
        };
        let view = View {
            of: self.of.clone(),
            ground,
            snow_line: self.snow_line,
            water: self.water,
            ..View::default()
        };
        albedo(&view, landscape, self.texture).map(Some)
    }

    fn add_skirt(&self, document: &mut Document, landscape: &Landscape, mesh: &Tin, vertices: &Vertices) {
        let lowest = vertices.positions.iter().map(|place| place[1]).fold(f64::INFINITY, f64::min);
        let skirt = Skirt::of(mesh, &vertices.positions, lowest - self.skirt);
        let colour = json!({ "baseColorFactor": bedrock_colour(&landscape.materials) });
        let material = document.material(rough("skirt", &colour, None));
        let mut attributes = Map::new();
        attributes.insert("POSITION".to_owned(), document.positions(&single(&skirt.positions)));
        attributes.insert("NORMAL".to_owned(), document.vectors(&single(&skirt.normals)));
        document.add(&document::Part {
            name: "skirt",
            attributes,
            triangles: &skirt.triangles,
            vertices: skirt.positions.len(),
            material,
        });
    }

    fn add_water(&self, document: &mut Document, landscape: &Landscape, water: &Water) -> Result<(), Error> {
        let error = self.error.min(self.shallowest);
        let mesh = follow(&Surface::new(&water.level, Some(&water.sheet), error), MAX_VERTICES)?;
        if mesh.triangles.is_empty() {
            return Ok(());
        }
        let domain = &landscape.domain;
        let slopes = Slopes::of(&water.level, Some(&water.sheet), domain.cell);
        let vertices = Vertices::of(&mesh, &water.level, &slopes, &Frame::of(domain));
        let attributes = attributes(document, &vertices);
        let material = document.material(json!({
            "name": "water",
            "alphaMode": "BLEND",
            "pbrMetallicRoughness": {
                "baseColorFactor": WATER, "metallicFactor": 0.0, "roughnessFactor": WATER_ROUGHNESS
            },
        }));
        let (triangles, vertices) = (mesh.triangles.as_slice(), mesh.points.len());
        document.add(&document::Part { name: "water", attributes, triangles, vertices, material });
        Ok(())
    }
}

/// Linear red, green, blue and opacity of water that is deep enough to hide its bed.
const WATER: [f32; 4] = [0.02, 0.10, 0.16, 0.85];

/// Ripples, too small for a mesh.
const WATER_ROUGHNESS: f32 = 0.12;

/// Dry ground scatters light evenly.
const GROUND_ROUGHNESS: f32 = 0.95;

fn attributes(document: &mut Document, vertices: &Vertices) -> Map<String, Value> {
    let mut attributes = Map::new();
    attributes.insert("POSITION".to_owned(), document.positions(&single(&vertices.positions)));
    attributes.insert("NORMAL".to_owned(), document.vectors(&single(&vertices.normals)));
    attributes.insert("TEXCOORD_0".to_owned(), document.vectors(&vertices.textures));
    attributes
}

/// A material that scatters light, of this colour.
fn rough(name: &str, colour: &Value, normal_map: Option<usize>) -> Value {
    let mut surface = json!({ "metallicFactor": 0.0, "roughnessFactor": GROUND_ROUGHNESS });
    let mut material = json!({ "name": name });
    for (key, value) in colour.as_object().into_iter().flatten() {
        surface[key] = value.clone();
    }
    material["pbrMetallicRoughness"] = surface;
    if let Some(index) = normal_map {
        material["normalTexture"] = json!({ "index": index });
    }
    material
}

/// Linear red, green, blue and opacity.
fn bedrock_colour(materials: &[Material]) -> [f32; 4] {
    let [red, green, blue] = linear_of_srgb(materials.first().map_or([0.5; 3], |rock| rock.colour));
    [red, green, blue, 1.0]
}
