//! What a raster file says of itself: `weald info`.

use std::fmt::{Display, Formatter};
use std::path::Path;

use serde_json::{Value, json};

use super::{Provenance, Raster, format_of, read};
use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Mask, Size};

/// What a raster file says of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// Name of the format.
    pub format: &'static str,
    /// Columns and rows.
    pub size: Size,
    /// Type of the values in the file.
    pub value_type: &'static str,
    /// Least and greatest value; `None` where no cell holds data.
    pub range: Option<(f32, f32)>,
    /// Side of a cell in metres, where cells are square and not in degrees.
    pub cell: Option<f64>,
    /// Where on Earth it lies.
    pub georeference: Option<Georeference>,
    /// Share of the cells without data, 0 to 1.
    pub no_data_share: f64,
    /// Where the file came from, if Weald wrote it.
    pub provenance: Option<Provenance>,
    /// What the user should know about the file.
    pub notes: Vec<String>,
}

/// Reads a raster file and says what is in it.
///
/// # Errors
/// As [`read`].
pub fn describe(path: &Path) -> Result<Info, Error> {
    let format = format_of(path).map_err(|what| Error::input(path, what))?;
    Ok(Info::of(format.name, read(path)?))
}

impl Info {
    fn of(format: &'static str, mut raster: Raster) -> Self {
        let question =
            raster.likely_degrees().map(|question| format!("{question}, in [landscape] or `load`"));
        raster.notes.extend(question);
        let size = raster.field.size();
        let valid_cells = raster.valid.as_ref().map_or(size.cells(), Mask::valid_cells);
        Self {
            format,
            size,
            value_type: raster.stored,
            range: raster.field.range(raster.valid.as_ref()),
            cell: raster.cell,
            georeference: raster.georeference,
            no_data_share: (size.cells() - valid_cells) as f64 / size.cells() as f64,
            provenance: raster.provenance,
            notes: raster.notes,
        }
    }

    /// All of it for programs; what the file does not say is `null`.
    pub fn to_json(&self) -> Value {
        json!({
            "format": self.format,
            "columns": self.size.columns,
            "rows": self.size.rows,
            "type": self.value_type,
            "range": self.range.map(|(low, high)| [low, high]),
            "cell_metres": self.cell,
            "epsg": self.georeference.as_ref().and_then(|place| place.epsg),
            "geographic": self.georeference.as_ref().map(Georeference::is_geographic),
            "origin": self.georeference.as_ref().map(|place| place.origin),
            "pixel": self.georeference.as_ref().map(|place| place.pixel),
            "no_data_share": self.no_data_share,
            "provenance": self.provenance.as_ref().map(provenance_json),
            "notes": self.notes,
        })
    }

    fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![
            ("format", self.format.to_owned()),
            ("size", format!("{} cells of {}", self.size, self.value_type)),
            (
                "range",
                self.range.map_or("no cell holds data".to_owned(), |(low, high)| format!("{low} to {high}")),
            ),
            ("no-data", format!("{:.1} % of the cells", 100.0 * self.no_data_share)),
        ];
        lines.extend(self.cell.map(|cell| ("cell", format!("{cell} m"))));
        if let Some(place) = &self.georeference {
            lines.extend(place_lines(place));
        }
        lines.extend(self.provenance.as_ref().map(|provenance| ("provenance", provenance.sentence())));
        lines.extend(self.notes.iter().map(|note| ("note", note.clone())));
        lines
    }
}

fn place_lines(place: &Georeference) -> [(&'static str, String); 3] {
    let unit = if place.is_geographic() { "°" } else { " CRS units" };
    [
        ("CRS", place.epsg.map_or("no EPSG code".to_owned(), |code| format!("EPSG:{code}"))),
        ("origin", format!("{}, {}{unit}", place.origin[0], place.origin[1])),
        ("pixel", format!("{} × {}{unit}", place.pixel[0], place.pixel[1])),
    ]
}

fn provenance_json(provenance: &Provenance) -> Value {
    json!({
        "version": provenance.version,
        "recipe_blake3": provenance.recipe_blake3,
        "seed": provenance.seed,
        "layer": provenance.layer,
        "unit": provenance.unit,
        "range": [provenance.range.0, provenance.range.1],
    })
}

impl Display for Info {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        for (name, text) in self.lines() {
            writeln!(formatter, "{name:<11}{text}")?;
        }
        Ok(())
    }
}
