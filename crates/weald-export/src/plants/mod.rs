//! Plants for other programs: as instances of a mesh, as a table, as points of a map, as a cloud of points.
//!
//! The extension says which. A `.glb` has the axes and the origin of the exported ground, so that plants stand on it; a
//! `.ply` the same with z up and y north; a `.csv` and a `.geojson` the coordinates of the CRS where there is one.

mod cloud;
mod features;
mod instances;
mod table;

use std::path::Path;
use std::sync::Arc;

use super::vector::geojson::Edition;
use super::vector::place::Place;
use super::vector::style;
use super::{Export, Finished, Mesh};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Colour, LayerName, Nested};
use weald_core::plants::Plants;
use weald_io::{Part, PartName};
use weald_plants::Vegetation;
use weald_plants::ifs::Ifs;
use weald_plants::ifs::foliage::{self, Foliage, Habit, Texture};

weald_core::parameters! {
    /// The plants that a step `scatter` set.
    pub struct PlantSet {
        /// Name of the plants.
        of: LayerName = LayerName::of("plants");
        /// The keys of the export `mesh` on which the plants are to stand, as in `on = { error = 2 }`: the mesh is off
        /// the ground by its error. Without it, plants stand on the ground itself.
        on: Option<Nested<Mesh>> = None;
        /// Fronds or planes of a plant. By default 8 fronds for a fern and 3 crossed planes for other 2D shapes; 3D
        /// shapes are not repeated.
        fronds: Option<u32> = None, range 1..=64, for "glb";
        /// Height of the leaf texture (albedo and alpha); its width follows from the shape.
        texture: u32 = 512, range 32..=4096, unit "px", for "glb";
        /// Colour of leaves.
        leaf: Colour = Colour(foliage::Colours::USUAL.leaf), for "glb";
        /// Colour of stems.
        stem: Colour = Colour(foliage::Colours::USUAL.stem), for "glb";
        /// Whether a `.geojson` is of RFC 7946: longitude and latitude in WGS 84, without heights of its points and without the
        /// member `crs`. The landscape must be in EPSG:4326.
        rfc7946: bool = false, for "geojson";
    }
}

/// Most plants of which a file of nodes is written: some 20 MB.
pub(super) const MAX_NODES: usize = 100_000;

/// What the name of a file of nodes has more than that of the instances, without its extension.
pub(super) const NODES: &str = ".nodes.glb";

/// What an extension stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Instances,
    Table,
    Features,
    Cloud,
}

impl Export for PlantSet {
    fn reads(&self) -> Vec<String> {
        self.on.iter().flat_map(|Nested(mesh)| mesh.reads()).collect()
    }

    fn optional(&self) -> Vec<String> {
        self.on.iter().flat_map(|Nested(mesh)| mesh.optional()).collect()
    }

    fn plants(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    /// Textures, and some 2 kB a plant: 20,000 of them are counted. The mesh on which they stand is
    /// made, and not written, which takes half.
    fn working_bytes(&self, cells: u64) -> u64 {
        let mesh: u64 = self.on.iter().map(|Nested(mesh)| mesh.working_bytes(cells)).sum();
        (48 << 20) + 8 * cells + mesh / 2
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let Ok(plants) = finished.landscape.plants(&self.of.0) else { return Vec::new() };
        let none = plants.plants.is_empty().then(|| {
            format!(
                "there is not one plant of `{}`; milder conditions in its `scatter` step may help",
                self.of.0
            )
        });
        let many = (plants.plants.len() > MAX_NODES).then(|| {
            format!(
                "more than {MAX_NODES} plants: a `.glb` has instances, and no file of nodes lies beside it"
            )
        });
        none.into_iter().chain(many).collect()
    }

    fn names(&self, file: &Path) -> Vec<PartName> {
        let beside = match kind(file) {
            Kind::Instances => Some(PartName::Sibling(NODES.to_owned())),
            Kind::Features => Some(style::name()),
            Kind::Table | Kind::Cloud => None,
        };
        std::iter::once(PartName::Own).chain(beside).collect()
    }

    fn check_on(&self, domain: &Domain, file: &Path) -> Result<(), Error> {
        Edition::of(self.rfc7946, Place(domain))?;
        self.on.iter().try_for_each(|Nested(mesh)| mesh.check_on(domain, file))
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let plants = &self.standing(finished.landscape)?;
        let place = Place(&finished.landscape.domain);
        match kind(file) {
            Kind::Instances => self.meshes(finished, plants),
            Kind::Table => Ok(vec![Part::own(table::of(plants, place))]),
            Kind::Features => {
                let edition = Edition::of(self.rfc7946, place)?;
                let points = features::of(plants, (&self.of.0, edition), place, finished);
                Ok(vec![Part::own(points), style::of_plants()])
            }
            Kind::Cloud => Ok(vec![Part::own(cloud::of(plants, finished))]),
        }
    }
}

fn kind(file: &Path) -> Kind {
    let is = |wanted: &str| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted));
    let others = [("csv", Kind::Table), ("geojson", Kind::Features), ("ply", Kind::Cloud)];
    others.into_iter().find(|(extension, _)| is(extension)).map_or(Kind::Instances, |(_, kind)| kind)
}

impl PlantSet {
    /// The file with instances and, beside it, that with nodes.
    fn meshes(&self, finished: &Finished<'_>, plants: &Arc<Plants>) -> Result<Vec<Part>, Error> {
        let fractal = finished.landscape.fractal(&plants.kind)?;
        let model = self.model(&fractal.ifs);
        let scene = instances::Scene { name: &self.of.0, model: &model, plants: &plants.plants, finished };
        let mut parts = vec![Part::own(scene.instanced()?)];
        if plants.plants.len() <= MAX_NODES {
            parts.push(Part::sibling(NODES, scene.nodes()?));
        }
        Ok(parts)
    }

    /// The plants, on the mesh that is asked for.
    fn standing(&self, landscape: &Landscape) -> Result<Arc<Plants>, Error> {
        let plants = landscape.plants(&self.of.0)?;
        let Some(Nested(mesh)) = &self.on else { return Ok(plants.clone()) };
        let places: Vec<_> = plants.plants.iter().map(|plant| [plant.place[0], plant.place[1]]).collect();
        let mut plants = Plants::clone(plants);
        for (plant, height) in plants.plants.iter_mut().zip(mesh.heights(landscape, &places)?) {
            plant.place[2] = height.unwrap_or(plant.place[2]);
        }
        Ok(Arc::new(plants))
    }

    fn model(&self, ifs: &Ifs) -> instances::Model {
        let colours = foliage::Colours { leaf: self.leaf.0, stem: self.stem.0 };
        instances::Model {
            foliage: Foliage::of(ifs, Habit::of(ifs, self.fronds)),
            texture: Texture::of(ifs, self.texture as usize, colours),
        }
    }
}
