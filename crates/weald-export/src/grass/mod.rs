//! Grass for other programs: a set (a tuft of six blades) of each species as a mesh, and where its sets stand.
//!
//! Engines that grow their own grass want the density and species maps instead: they are layers, `grass` and
//! `grass_reed`, and any raster format holds them.

mod instances;

use std::path::Path;

use super::plants::{MAX_NODES, NODES};
use super::{Export, Finished, Mesh};
use instances::{Scene, Standing};
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName, Nested};
use weald_io::{Part, PartName};
use weald_plants::Vegetation;
use weald_plants::grass::{Area, Instance, Meadow};

weald_core::parameters! {
    /// The grass that a step `grass` grew.
    pub struct GrassSets {
        /// Name of the grass.
        of: LayerName = LayerName::of("grass");
        /// Layer of the heights on which it stands, in metres.
        ground: LayerName = LayerName::of("height");
        /// The keys of the export `mesh` on which the grass is to stand, as in `on = { error = 2 }`. Without it, grass
        /// stands on the ground itself.
        on: Option<Nested<Mesh>> = None;
        /// Rectangle that is written: metres west, north, east and south, from the north-western corner. Without it, the
        /// whole landscape.
        area: Vec<f64> = Vec::new(), range 0.0..=1.0e9, unit "m";
        /// Most sets (tufts of six blades); where there are more the run ends with an error.
        max_sets: u32 = 200_000, range 1..=10_000_000;
    }
}

impl Export for GrassSets {
    fn reads(&self) -> Vec<String> {
        let on = self.on.iter().flat_map(|Nested(mesh)| mesh.reads());
        std::iter::once(self.ground.0.clone()).chain(on).collect()
    }

    fn optional(&self) -> Vec<String> {
        self.on.iter().flat_map(|Nested(mesh)| mesh.optional()).collect()
    }

    fn meadows(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn faults(&self) -> Vec<Fault> {
        let fault = match self.area.as_slice() {
            [] => None,
            [west, north, east, south] if west < east && north < south => None,
            [_, _, _, _] => {
                Some(format!("`area` is {:?}; east must be beyond west and south beyond north", self.area))
            }
            other => Some(format!(
                "`area` has {} numbers; it needs four: metres west, north, east and south",
                other.len()
            )),
        };
        fault.map(|message| Fault::of("area", message)).into_iter().collect()
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let Ok(meadow) = finished.landscape.meadow(&self.of.0) else { return Vec::new() };
        let sets = meadow.expected(&self.area_of(&meadow));
        let many = (sets > MAX_NODES as f64).then(|| {
            format!(
                "some {sets:.0} sets of grass: a `.glb` has instances, and no file of nodes lies beside it"
            )
        });
        let landscape = meadow.area();
        let area = self.area_of(&meadow);
        let is_outside = (0..2)
            .any(|axis| area.high[axis] <= landscape.low[axis] || area.low[axis] >= landscape.high[axis]);
        let outside = is_outside.then(|| {
            let [width, length] = finished.landscape.domain.extent();
            format!("`area` lies outside the landscape of {width} m × {length} m, so the file holds no grass")
        });
        many.into_iter().chain(outside).collect()
    }

    fn names(&self, _: &Path) -> Vec<PartName> {
        vec![PartName::Own, PartName::Sibling(NODES.to_owned())]
    }

    fn check_on(&self, domain: &Domain, file: &Path) -> Result<(), Error> {
        self.on.iter().try_for_each(|Nested(mesh)| mesh.check_on(domain, file))
    }

    fn parts(&self, finished: &Finished<'_>, _: &Path) -> Result<Vec<Part>, Error> {
        let meadow = finished.landscape.meadow(&self.of.0)?;
        let sets = self.standing(finished.landscape, &meadow)?;
        let scene = Scene { name: &self.of.0, meadow: &meadow, sets: &sets, finished };
        let mut parts = vec![Part::own(scene.instanced()?)];
        if sets.len() <= MAX_NODES {
            parts.push(Part::sibling(NODES, scene.nodes()?));
        }
        Ok(parts)
    }
}

impl GrassSets {
    fn area_of(&self, meadow: &Meadow) -> Area {
        match self.area.as_slice() {
            &[west, north, east, south] => Area { low: [west, north], high: [east, south] },
            _ => meadow.area(),
        }
    }

    /// The sets with the heights at which they stand.
    fn standing(&self, landscape: &Landscape, meadow: &Meadow) -> Result<Vec<Standing>, Error> {
        let area = self.area_of(meadow);
        let (expected, most) = (meadow.expected(&area), f64::from(self.max_sets));
        // The count varies a little about what is expected; far beyond the limit nothing is made.
        if expected > 1.2 * most {
            return Err(self.too_many(expected));
        }
        let sets: Vec<_> = meadow.sets(&area).into_iter().map(Instance::unpack).collect();
        if sets.len() as f64 > most {
            return Err(self.too_many(sets.len() as f64));
        }
        let places: Vec<_> = sets.iter().map(|set| set.place.map(f64::from)).collect();
        let ground = landscape.field(&self.ground.0)?;
        let on_mesh = match &self.on {
            Some(Nested(mesh)) => mesh.heights(landscape, &places)?,
            None => vec![None; places.len()],
        };
        let on_ground = |set: &Instance| Meadow::height(ground, landscape.domain.cell, set.place);
        let standing = sets.iter().zip(on_mesh).filter_map(|(set, on_mesh)| {
            let height = on_mesh.map(|height| height as f32).or_else(|| on_ground(set))?;
            Some(Standing { instance: *set, height })
        });
        Ok(standing.collect())
    }

    fn too_many(&self, sets: f64) -> Error {
        let limit = Limit::new(Quantity::GrassSets, sets.ceil() as u64, 0..=self.max_sets.into());
        let remedy = "choose a smaller `area`, fewer `sets` in the step, or a larger `max_sets`";
        limit.of(format!("grass: `{}` in the `area`", self.of.0)).remedy(remedy).into()
    }
}
