//! What a picture is: what it needs, how it is drawn, and how the registry knows it.

use std::fmt::Debug;

use super::{Cutout, Image, Render, View};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Diagnostics, Parameter, Parameters};
use weald_core::source::Table;

/// A kind of picture with its parameters, checked and ready to draw.
pub trait Picture: Debug + Send + Sync {
    /// Names of the layers it needs.
    fn reads(&self) -> Vec<String>;

    /// Names of the layers it draws where they exist.
    fn optional(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the fractals it draws.
    fn fractals(&self) -> Vec<String> {
        Vec::new()
    }

    /// The same picture at a share, 0 to 1, of a film of so many seconds: from a camera that has gone that share of a
    /// turn around the landscape, clockwise from above, or in the wind of that moment; `None` for a picture that does
    /// not move.
    fn turned(&self, share: f64, seconds: f64) -> Option<Box<dyn Picture>> {
        let _ = (share, seconds);
        None
    }

    /// The view that this picture is, for those that have a scene which a renderer on a device can draw.
    fn as_view(&self) -> Option<&View> {
        None
    }

    /// What of it a device draws; `None` for a picture that the processor draws.
    fn as_render(&self) -> Option<&Render> {
        None
    }

    /// What the user should know of the picture.
    fn notes(&self, landscape: &Landscape) -> Vec<String> {
        let _ = landscape;
        Vec::new()
    }

    /// What stands against the picture of a landscape on such a grid: all that its keys and the grid tell before anything
    /// runs.
    ///
    /// # Errors
    /// Those that drawing would end with, whatever the layers hold.
    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        let _ = domain;
        Ok(())
    }

    /// Bytes that drawing takes at most, beside the layers of a landscape of so many cells and the pixels: as measured.
    fn working_bytes(&self, cells: u64) -> u64 {
        8 * cells
    }

    /// Bytes beside those where there is a layer that it reads if there is one.
    fn optional_bytes(&self, _layer: &str, _cells: u64) -> u64 {
        0
    }

    /// Draws a landscape that has all the layers in [`Picture::reads`].
    ///
    /// # Errors
    /// [`Error::Limit`] where the picture would be too large, [`Error::Run`] where a layer is missing.
    fn render(&self, landscape: &Landscape) -> Result<Image, Error>;

    /// The same with a background that may show through. `watch` is called with how far the drawing is and may end it.
    ///
    /// # Errors
    /// As [`Picture::render`], and those of `watch`.
    fn cutout(&self, landscape: &Landscape, watch: &mut Watch<'_>) -> Result<Cutout, Error> {
        let _ = watch;
        self.render(landscape).map(Cutout::from)
    }

    /// The picture as vectors, for those whose [`PictureEntry::extensions`] have `svg`.
    ///
    /// # Errors
    /// As [`Picture::render`].
    fn svg(&self, landscape: &Landscape) -> Result<String, Error> {
        let _ = landscape;
        Err(Error::Run("this picture has no vectors; choose a .png".to_owned()))
    }
}

/// Is called with how much of a drawing is done, of how much, and says whether to go on.
pub type Watch<'a> = dyn FnMut(u64, u64) -> Result<(), Error> + 'a;

/// A picture's declaration in the registry.
#[derive(Clone, Copy, Debug)]
pub struct PictureEntry {
    /// Word after `picture =`.
    pub name: &'static str,
    /// What it shows, in one sentence.
    pub summary: &'static str,
    /// The publication, or "Weald" for what is common practice.
    pub source: &'static str,
    /// Extensions of a still in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Declares the parameters.
    pub parameters: fn() -> Vec<Parameter>,
    /// Reads them from an `[[output]]` table without its `picture` and `file`.
    pub read: fn(&Table, &mut Diagnostics) -> Box<dyn Picture>,
}

impl PictureEntry {
    /// The declaration of picture type `T`.
    pub const fn of<T: Picture + Parameters + 'static>(
        name: &'static str,
        summary: &'static str,
        source: &'static str,
    ) -> Self {
        let read = |table: &Table, diagnostics: &mut Diagnostics| -> Box<dyn Picture> {
            Box::new(T::read(table, diagnostics))
        };
        Self { name, summary, source, extensions: &["png"], parameters: T::parameters, read }
    }

    /// The same with other extensions.
    pub(super) const fn into_files(self, extensions: &'static [&'static str]) -> Self {
        Self { extensions, ..self }
    }
}
