//! Several layers in one file of arrays, `NetCDF` or Zarr, on one grid with one CRS.

use std::borrow::Cow;
use std::path::Path;

use super::classes::classes;
use super::{Export, Finished};
use weald_core::choices;
use weald_core::error::Error;
use weald_core::parameter::LayerNames;
use weald_core::parameters;
use weald_io::cf::{self, Names, Sheet};
use weald_io::{Part, PartName, Provenance, netcdf, zarr};

/// Extensions of its files.
pub(super) const EXTENSIONS: &[&str] = &["nc", "zarr"];

choices! {
    /// A reader with names of its own.
    pub enum Reader {
        /// landlab's standard names, such as `topographic__elevation`.
        Landlab = "landlab",
    }
}

parameters! {
    /// Several layers in one file.
    pub struct Layers {
        /// Layers that are written; all of the landscape where none are named.
        layers: LayerNames = LayerNames::default();
        /// Whose names the arrays have, and whose order the rows. Without it, names are those of the layers and
        /// rows begin in the north.
        preset: Option<Reader> = None;
    }
}

impl Export for Layers {
    fn reads(&self) -> Vec<String> {
        self.layers.0.clone()
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let place = finished.landscape.domain.georeference.as_ref();
        let is_omitted = place.is_some_and(|place| !cf::is_readable_by_all(place));
        is_omitted.then(|| cf::OMITTED_CRS_NOTE.to_owned()).into_iter().collect()
    }

    fn names(&self, file: &Path) -> Vec<PartName> {
        vec![if is_zarr(file) { PartName::Inside("zarr.json".to_owned()) } else { PartName::Own }]
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let sheet = self.sheet(finished)?;
        if is_zarr(file) {
            zarr::encode_sheet(&sheet)
        } else {
            Ok(vec![Part::own(netcdf::encode_sheet(&sheet)?)])
        }
    }
}

fn is_zarr(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("zarr"))
}

impl Layers {
    fn sheet<'a>(&self, finished: &Finished<'a>) -> Result<Sheet<'a>, Error> {
        let all = || finished.landscape.layers().map(|(name, _)| name.to_owned()).collect();
        let names: Vec<String> = if self.layers.0.is_empty() { all() } else { self.layers.0.clone() };
        if names.is_empty() {
            return Err(Error::Run("the landscape has no layers to write".to_owned()));
        }
        let domain = &finished.landscape.domain;
        Ok(Sheet {
            cell: Some(domain.cell),
            georeference: domain.georeference.as_ref(),
            valid: domain.valid.as_ref(),
            layers: names.iter().map(|name| layer(finished, name)).collect::<Result<_, _>>()?,
            names: if self.preset.is_some() { Names::Landlab } else { Names::Weald },
        })
    }
}

fn layer<'a>(finished: &Finished<'a>, name: &str) -> Result<cf::Layer<'a>, Error> {
    let layer = finished.landscape.layer(name)?;
    let range = layer.field.range(finished.landscape.domain.valid.as_ref()).unwrap_or_default();
    let provenance = Provenance {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        recipe_blake3: finished.hash.to_owned(),
        seed: finished.seed,
        layer: name.to_owned(),
        unit: layer.unit.clone(),
        range: (range.0.into(), range.1.into()),
        resampled: None,
    };
    let classes = classes(finished.landscape, name)?.map(Cow::Owned);
    Ok(cf::Layer { field: &layer.field, provenance: Some(provenance), unit: None, classes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Field, Mask, Size};
    use weald_core::landscape::Landscape;
    use weald_io::{InMemory, Limits};

    fn landscape() -> Landscape {
        let size = Size { columns: 5, rows: 4 };
        let valid = Mask::new(size, (0..20).map(|cell| cell != 7).collect());
        let mut landscape = Landscape::new(Domain { valid, ..Domain::new(size, 20.0) });
        for (name, unit, start) in [("height", "m", 100.0), ("water", "m", 0.5), ("flux_x", "m³/step", -3.0)]
        {
            landscape.insert(name, unit, Field::from_function(size, |x, y| start + (x + 10 * y) as f32));
        }
        landscape
    }

    /// The files of an export of the layers above.
    fn parts(layers: &[&str], preset: Option<Reader>, file: &str) -> Vec<Part> {
        let landscape = landscape();
        let finished =
            Finished { landscape: &landscape, steps: &[], recipe: "r.toml", hash: "af13", seed: 7 };
        let layers = LayerNames(layers.iter().map(|&name| name.to_owned()).collect());
        Layers { layers, preset }.parts(&finished, Path::new(file)).expect("written")
    }

    #[test]
    fn all_layers_are_written_and_the_height_is_read_again() {
        let expected = landscape();
        let zarr = InMemory::of("all.zarr", parts(&[], None, "all.zarr"));
        let nc = parts(&[], None, "all.nc");
        let rasters =
            [zarr::decode(&zarr, Limits::default()), netcdf::decode(&nc[0].bytes, Limits::default())];
        for raster in rasters.map(|raster| raster.expect("reads")) {
            assert_eq!(raster.valid, expected.domain.valid);
            assert_eq!(raster.field.at(4, 3), expected.field("height").expect("there").at(4, 3));
            assert_eq!((raster.cell, raster.georeference), (Some(20.0), None));
            let provenance = raster.provenance.expect("written");
            assert_eq!((provenance.layer.as_str(), provenance.seed), ("height", 7));
        }
        for name in ["height", "water", "flux_x"] {
            assert!(zarr.files.contains_key(&Path::new("all.zarr").join(name).join("zarr.json")), "{name}");
        }
    }

    #[test]
    fn only_the_named_layers_are_written_under_the_names_of_landlab() {
        let files = parts(&["water", "flux_x"], Some(Reader::Landlab), "some.zarr");
        let is_there = |folder: &str| {
            files.iter().any(|part| matches!(&part.name, PartName::Inside(path) if path == folder))
        };
        assert!(is_there("surface_water__depth/zarr.json") && is_there("flux_x/zarr.json"));
        assert!(!is_there("height/zarr.json") && !is_there("topographic__elevation/zarr.json"));
        let both = netcdf::decode(&parts(&["water", "flux_x"], None, "some.nc")[0].bytes, Limits::default());
        let fault = both.expect_err("neither is the height");
        assert!(fault.to_string().contains("water, flux_x"), "{fault}");
    }
}
