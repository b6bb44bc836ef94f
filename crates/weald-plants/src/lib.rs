//! What grows on the land: plants from the codes of fractals, and where they stand.

pub mod grass;
pub mod ifs;
pub mod scatter;
mod vegetation;
pub mod wind;

pub use vegetation::Vegetation;

use self::ifs::deform::DeformKeys;
use self::ifs::device::Shader;
use self::ifs::{Deformation, Ifs, shapes};

/// All shaders of plants.
pub const SHADERS: [Shader; 4] = [ifs::device::PLAY, ifs::wind::SWAY, grass::device::GROW, ifs::limbs::BEND];

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
