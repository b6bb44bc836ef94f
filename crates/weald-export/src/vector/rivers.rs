//! Rivers as lines.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::geojson::{Edition, Feature, Geometry, rounded, write};
use super::place::Place;
use super::style;
use crate::{Export, Finished};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_io::{Part, PartName};
use weald_land::analyse::rivers::{End, Reach, RiverPoint, Rivers, Start};

weald_core::parameters! {
    /// Rivers as lines, a feature for each reach between confluences.
    ///
    /// A point is where the river runs in its valley, between the centres of cells, and the height of its water. A feature has
    /// its `id`, the Strahler `order`, and at its lower end `width` and `depth` in metres, `discharge` in m³/s and
    /// `upstream_area` in m²; its `length` in metres; where it begins (`start`: "head", "confluence" or "lake") and ends (`end`: "outlet", "lake", "sea" or
    /// "confluence"), with the numbers of the lakes `from_lake` and `to_lake`; `downstream`, the `id` of the reach that
    /// carries its water on; and `river`, the same number for all reaches of one river from its head to its mouth, 0
    /// for the longest. A style for QGIS lies beside the file, by which rivers are the wider the higher their order is.
    pub struct RiverLines {
        /// Least Strahler order of the reaches that are written.
        order: u32 = 1, range 1..=20;
        /// Whether the file is of RFC 7946: longitude and latitude in WGS 84, without heights and without the member `crs`. The
        /// landscape must be in EPSG:4326.
        rfc7946: bool = false;
    }
}

impl Export for RiverLines {
    fn reads(&self) -> Vec<String> {
        let layers = [
            "river",
            "river_width",
            "river_depth",
            "river_level",
            "discharge",
            "strahler",
            "flow_direction",
            "accumulation",
        ];
        layers.map(str::to_owned).to_vec()
    }

    fn optional(&self) -> Vec<String> {
        vec!["lake".to_owned(), "height".to_owned()]
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
        let rivers = Rivers::of(finished.landscape)?;
        let place = Place(&finished.landscape.domain);
        let stems = stem_of_each(&rivers);
        let reaches = rivers.reaches.iter().zip(stems).enumerate();
        let features = reaches
            .filter(|(_, (reach, _))| reach.order >= self.order)
            .map(|(id, (reach, stem))| feature(place, id, reach, stem));
        let edition = Edition::of(self.rfc7946, place)?;
        let greatest = rivers.reaches.iter().map(|reach| reach.order).fold(self.order, u32::max);
        let style = style::of_rivers(self.order..=greatest);
        Ok(vec![Part::own(write("rivers", (place, edition), features, finished)), style])
    }
}

/// For each reach the number of the river that it is part of.
fn stem_of_each(rivers: &Rivers) -> Vec<usize> {
    let mut stems = vec![0; rivers.reaches.len()];
    for (number, stem) in rivers.stems().into_iter().enumerate() {
        for reach in stem {
            stems[reach] = number;
        }
    }
    stems
}

/// The reach as a line, which has two points: one of a single cell goes on to the edge of the cell.
fn drawn(domain: &Domain, reach: &Reach) -> Reach {
    let mut reach = reach.clone();
    if let [only] = reach.points.as_slice() {
        let edge = at_the_edge(domain, only);
        reach.points.push(edge);
    }
    reach
}

/// The point moved by half a cell towards the nearest edge of the grid, where a river of one cell leaves it.
fn at_the_edge(domain: &Domain, point: &RiverPoint) -> RiverPoint {
    let half = 0.5 * domain.cell;
    let [width, height] = domain.extent();
    let edges = [
        (point.x, [-half, 0.0]),
        (width - point.x, [half, 0.0]),
        (point.y, [0.0, -half]),
        (height - point.y, [0.0, half]),
    ];
    let nearest = edges.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, [east, south]) = nearest.expect("a grid has four edges");
    RiverPoint { x: point.x + east, y: point.y + south, ..*point }
}

fn feature(place: Place<'_>, id: usize, reach: &Reach, stem: usize) -> Feature {
    let reach = &drawn(place.0, reach);
    let position = |point: &RiverPoint| {
        let [x, y] = place.at([point.x, point.y]);
        [x, y, point.z]
    };
    let geometry = Geometry::Line(reach.points.iter().map(position).collect());
    let mut properties = properties(id, reach);
    properties.insert("river".to_owned(), stem.into());
    Feature { id: id as u64, geometry, properties }
}

fn properties(id: usize, reach: &Reach) -> Map<String, Value> {
    let (start, from_lake) = match reach.start {
        Start::Head => ("head", None),
        Start::Confluence => ("confluence", None),
        Start::Lake(lake) => ("lake", Some(lake)),
    };
    let (end, to_lake) = match reach.end {
        End::Outlet => ("outlet", None),
        End::Sea => ("sea", None),
        End::Confluence => ("confluence", None),
        End::Lake(lake) => ("lake", Some(lake)),
    };
    // Where the reach joins another or a lake, this is still as large as the reach itself.
    let lowest = reach.points[reach.points.len() - 1];
    let properties = json!({
        "id": id,
        "order": reach.order,
        "length": rounded(reach.length(), 3),
        "width": rounded(lowest.width, 3),
        "depth": rounded(lowest.depth, 3),
        "discharge": rounded(lowest.discharge, 6),
        "upstream_area": rounded(lowest.area, 3),
        "start": start,
        "from_lake": from_lake,
        "end": end,
        "to_lake": to_lake,
        "downstream": reach.downstream,
    });
    properties.as_object().cloned().unwrap_or_default()
}
