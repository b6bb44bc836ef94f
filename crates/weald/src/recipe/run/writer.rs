//! Layers and pictures become files, each with its provenance.

use std::path::Path;

use crate::error::Error;
use crate::grid::Field;
use crate::io::{Provenance, Raster, write_whole};
use crate::landscape::Landscape;
use crate::recipe::plan::{Content, Output, Recipe};
use crate::recipe::report::OutputReport;

/// Turns layers into files.
pub(super) struct Writer<'a> {
    pub(super) recipe: &'a Recipe,
    pub(super) landscape: &'a Landscape,
    pub(super) hash: &'a str,
}

impl Writer<'_> {
    pub(super) fn write(&self, output: &Output, folder: &Path) -> Result<OutputReport, Error> {
        let path = folder.join(&output.file);
        let file = output.file.display().to_string();
        match &output.content {
            Content::Picture { name, picture } => {
                let text = [
                    ("Software".to_owned(), format!("Weald {}", env!("CARGO_PKG_VERSION"))),
                    ("WEALD_RECIPE_BLAKE3".to_owned(), self.hash.to_owned()),
                    ("WEALD_SEED".to_owned(), self.recipe.seed.to_string()),
                ];
                write_whole(&path, &picture.render(self.landscape)?.to_png(&text))?;
                let picture = Some((*name).to_owned());
                Ok(OutputReport { file, layer: None, picture, unit: None, range: None })
            }
            Content::Layer { name, format } => {
                let raster = self.raster(name)?;
                let encode = format.encode.expect("the plan takes only formats that are written");
                write_whole(&path, &encode(&raster)?)?;
                let provenance = raster.provenance.expect("every raster of a run says where it is from");
                let range = self.range(name)?;
                Ok(OutputReport {
                    file,
                    layer: Some(provenance.layer),
                    picture: None,
                    unit: Some(provenance.unit),
                    range,
                })
            }
        }
    }

    fn range(&self, name: &str) -> Result<Option<(f64, f64)>, Error> {
        let range = self.landscape.field(name)?.range(self.landscape.domain.land.as_ref());
        Ok(range.map(|(low, high)| (low.into(), high.into())))
    }

    /// The layer with 0 in its no-data cells.
    pub(super) fn raster(&self, name: &str) -> Result<Raster, Error> {
        let layer = self.landscape.layer(name)?;
        let domain = &self.landscape.domain;
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe_blake3: self.hash.to_owned(),
            seed: self.recipe.seed,
            layer: name.to_owned(),
            unit: layer.unit.clone(),
            range: self.range(name)?.unwrap_or((0.0, 0.0)),
        };
        let mut field: Field = layer.field.clone();
        if let Some(land) = &domain.land {
            for (value, &is_land) in field.values_mut().iter_mut().zip(land.flags()) {
                *value = if is_land { *value } else { 0.0 };
            }
        }
        Ok(Raster {
            land: domain.land.clone(),
            cell: Some(domain.cell),
            georeference: domain.georeference.clone(),
            provenance: Some(provenance),
            ..Raster::from(field)
        })
    }
}
