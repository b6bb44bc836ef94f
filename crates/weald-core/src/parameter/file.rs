//! Names of files in a recipe, and the CRS of one that names none.

use std::path::{Path, PathBuf};

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use super::values::wrong;
use crate::source::{Node, Value};

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

/// The coordinate reference system of a file that names none, by its code: `"EPSG:4326"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrsCode(pub u32);

impl ParameterValue for CrsCode {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Crs
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let code = match &node.value {
            Value::Text(text) => text.strip_prefix("EPSG:").filter(|code| !code.starts_with('+')),
            _ => None,
        };
        let code = code.and_then(|code| code.parse().ok());
        code.map(Self)
            .ok_or_else(|| wrong(node, "a code of EPSG, as \"EPSG:4326\" for longitude and latitude"))
    }

    fn shown(&self) -> Option<String> {
        Some(format!("\"EPSG:{}\"", self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crs_is_shown_as_it_was_read() {
        let read = |text: &str| {
            let node = Node { line: 1, value: Value::Text(text.to_owned()) };
            CrsCode::read(&node, (0.0, 0.0), &mut Diagnostics::default())
        };
        assert_eq!(read("EPSG:32616").map(|code| code.shown()), Ok(Some("\"EPSG:32616\"".to_owned())));
        for text in ["4326", "EPSG:", "epsg:4326", "EPSG:+1", "EPSG:-1", "WGS84", ""] {
            assert!(read(text).is_err_and(|problem| problem.contains("\"EPSG:4326\"")), "{text}");
        }
    }
}
