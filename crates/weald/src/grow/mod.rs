//! What grows on the land: plants from the codes of fractals, and where they stand.

pub mod grass;
pub mod ifs;
pub mod scatter;
pub mod wind;

use std::borrow::Cow;

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
    /// The fractal of that name, of those given or else of the built-in ones.
    pub fn named<'a>(fractals: &'a [Self], name: &str) -> Option<Cow<'a, Self>> {
        if let Some(fractal) = fractals.iter().find(|fractal| fractal.name == name) {
            return Some(Cow::Borrowed(fractal));
        }
        let ifs = shapes::find(name)?.ifs();
        Some(Cow::Owned(Self { name: name.to_owned(), ifs, deform: Vec::new() }))
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
