//! What goes into a file: one grid and the layers on it.

use super::super::{Provenance, Raster};
use super::Names;
use weald_core::domain::Georeference;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

/// Layers of one grid that become one file.
#[derive(Clone, Debug)]
pub struct Sheet<'a> {
    /// Side of a cell in metres, where it is known.
    pub cell: Option<f64>,
    /// Where on Earth it lies.
    pub georeference: Option<&'a Georeference>,
    /// Cells with data; `None` where all have.
    pub valid: Option<&'a Mask>,
    /// At least one; all of one size.
    pub layers: Vec<Layer<'a>>,
    /// What the arrays are called.
    pub names: Names,
}

/// A field and where it came from.
#[derive(Clone, Debug)]
pub struct Layer<'a> {
    /// The field.
    pub field: &'a Field,
    /// Where it came from.
    pub provenance: Option<Provenance>,
}

impl<'a> Sheet<'a> {
    /// One raster.
    pub fn of(raster: &'a Raster, names: Names) -> Self {
        Self {
            cell: raster.cell,
            georeference: raster.georeference.as_ref(),
            valid: raster.valid.as_ref(),
            layers: vec![Layer { field: &raster.field, provenance: raster.provenance.clone() }],
            names,
        }
    }

    /// Whether the first row of the file is the southern one, as landlab counts its nodes; others go by the
    /// coordinates.
    pub(super) fn is_south_up(&self) -> bool {
        self.names == Names::Landlab
    }

    pub(super) fn size(&self) -> Size {
        self.layers[0].field.size()
    }

    /// Whether all values can be written.
    ///
    /// # Errors
    /// [`Error::Run`] naming the first cell with data that holds a NaN or an infinity.
    pub(super) fn ensure_finite(&self) -> Result<(), Error> {
        for layer in &self.layers {
            if let Some((x, y)) = layer.field.first_not_finite(self.valid) {
                let name = layer.name().map_or_else(String::new, |name| format!(" of layer `{name}`"));
                return Err(Error::Run(format!(
                    "column {x}, row {y}{name} holds {}, which no file may carry as data",
                    layer.field.at(x, y)
                )));
            }
        }
        Ok(())
    }
}

impl Layer<'_> {
    /// Its name, where that is known.
    pub(super) fn name(&self) -> Option<&str> {
        self.provenance.as_ref().map(|provenance| provenance.layer.as_str())
    }
}
