//! Lakes as areas.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::geojson::{Edition, Feature, Geometry, Position, rounded, write};
use super::place::Place;
use super::style;
use crate::{Export, Finished};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_io::{Part, PartName};
use weald_land::analyse::lakes::{Lake, Lakes, Polygon};

weald_core::parameters! {
    /// Lakes as areas, with islands left open.
    ///
    /// A point is a corner of the shore at the height of the water. A feature has its number in the layer `lake` as
    /// `id`, its `level` and greatest `depth` in metres, `area` in m², `volume` in m³, and `outlet`, where the cell that
    /// it drains over has its middle, as a list of two coordinates. A style for QGIS lies beside the file.
    pub struct LakeAreas {
        /// Smaller lakes are left out.
        smallest: f64 = 0.0, range 0.0..=1.0e15, unit "m²";
        /// Whether the file is of RFC 7946: longitude and latitude in WGS 84, without heights and without the member `crs`. The
        /// landscape must be in EPSG:4326.
        rfc7946: bool = false;
    }
}

impl Export for LakeAreas {
    fn reads(&self) -> Vec<String> {
        ["lake", "lake_level", "lake_depth", "height"].map(str::to_owned).to_vec()
    }

    fn optional(&self) -> Vec<String> {
        vec!["flow_direction".to_owned()]
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        Place(&finished.landscape.domain).note().into_iter().collect()
    }

    fn names(&self, _: &Path) -> Vec<PartName> {
        vec![PartName::Own, style::name()]
    }

    fn check_on(&self, domain: &Domain, _: &Path) -> Result<(), Error> {
        Edition::of(self.rfc7946, Place(domain)).map(drop)
    }

    fn parts(&self, finished: &Finished<'_>, _: &Path) -> Result<Vec<Part>, Error> {
        let domain = &finished.landscape.domain;
        let place = Place(domain);
        let lakes = Lakes::of(finished.landscape)?.lakes;
        let written = lakes.iter().filter(|lake| lake.area >= self.smallest);
        let features = written.map(|lake| feature(place, domain.cell, lake));
        let edition = Edition::of(self.rfc7946, place)?;
        Ok(vec![Part::own(write("lakes", (place, edition), features, finished)), style::of_lakes()])
    }
}

fn feature(place: Place<'_>, cell: f64, lake: &Lake) -> Feature {
    let ring = |corners: &Vec<[f64; 2]>| -> Vec<Position> {
        let corner = |&corner: &[f64; 2]| {
            let [x, y] = place.at(corner);
            [x, y, lake.level]
        };
        corners.iter().map(corner).collect()
    };
    let area =
        |polygon: &Polygon| std::iter::once(&polygon.shore).chain(&polygon.islands).map(ring).collect();
    let geometry = Geometry::Areas(lake.polygons.iter().map(area).collect());
    let outlet = lake.outlet.map(|outlet| {
        let middle = place.at(outlet.map(|at| (at as f64 + 0.5) * cell));
        middle.map(|coordinate| rounded(coordinate, place.digits()))
    });
    Feature { id: lake.number.into(), geometry, properties: properties(lake, outlet) }
}

fn properties(lake: &Lake, outlet: Option<[f64; 2]>) -> Map<String, Value> {
    let properties = json!({
        "id": lake.number,
        "level": rounded(lake.level, 3),
        "depth": rounded(lake.deepest, 3),
        "area": rounded(lake.area, 3),
        "volume": rounded(lake.volume, 3),
        "outlet": outlet,
    });
    properties.as_object().cloned().unwrap_or_default()
}
