//! A fractal by its name, as landscapes and recipes know it.

use crate::ifs::deform::DeformKeys;
use crate::ifs::{Deformation, Ifs, shapes};

/// A fractal by its name, with what deforms it: a `[[fractal]]` table of a recipe.
#[derive(Clone, Debug, PartialEq)]
pub struct Fractal {
    /// Its name.
    pub name: String,
    /// The fractal.
    pub ifs: Ifs,
    /// Its deformations.
    pub deform: Vec<DeformKeys>,
}

impl Fractal {
    /// The built-in fractal of that name.
    pub fn built_in(name: &str) -> Option<Self> {
        let ifs = shapes::find(name)?.ifs();
        Some(Self { name: name.to_owned(), ifs, deform: Vec::new() })
    }

    /// All its deformations in their order.
    ///
    /// # Errors
    /// A sentence for the user for each that does not fit.
    pub fn deformation(&self) -> Result<Deformation<'_>, Vec<String>> {
        let deforms: Result<Vec<_>, String> = self.deform.iter().map(|keys| keys.of(&self.ifs)).collect();
        Deformation::new(&self.ifs, deforms.map_err(|fault| vec![fault])?)
    }
}
