//! Names of files in a recipe.

use std::path::{Path, PathBuf};

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use crate::source::Node;

/// A raster file that is read when the recipe runs. The plan makes its path start at the recipe's folder and
/// checks that its extension names a format that is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RasterFile(pub String);

impl RasterFile {
    /// The default of a key that must be given.
    pub fn needed() -> Self {
        Self::default()
    }

    /// Where the file is.
    pub fn path(&self) -> PathBuf {
        Path::new(&self.0).to_owned()
    }
}

impl ParameterValue for RasterFile {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Raster
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        String::read(node, range, diagnostics).map(Self)
    }

    fn shown(&self) -> Option<String> {
        (!self.0.is_empty()).then(|| format!("{:?}", self.0))
    }

    fn must_be_given(&self) -> bool {
        self.0.is_empty()
    }
}

/// A script of edits that is read when the recipe runs. The plan makes its path start at the recipe's folder
/// and checks that its extension names a layout.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScriptFile(pub String);

impl ScriptFile {
    /// Where the file is.
    pub fn path(&self) -> PathBuf {
        Path::new(&self.0).to_owned()
    }
}

impl ParameterValue for ScriptFile {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Script
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        String::read(node, range, diagnostics).map(Self)
    }

    fn shown(&self) -> Option<String> {
        (!self.0.is_empty()).then(|| format!("{:?}", self.0))
    }
}

/// A file of flames, of which a fractal takes the affine parts. The plan makes its path start at the recipe's folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FlameFile(pub String);

impl FlameFile {
    /// Where the file is.
    pub fn path(&self) -> PathBuf {
        Path::new(&self.0).to_owned()
    }
}

impl ParameterValue for FlameFile {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Flame
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        String::read(node, range, diagnostics).map(Self)
    }

    fn shown(&self) -> Option<String> {
        (!self.0.is_empty()).then(|| format!("{:?}", self.0))
    }
}
