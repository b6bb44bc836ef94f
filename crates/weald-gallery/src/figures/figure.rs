//! What a figure is: how it is declared, what it is given and what it makes.

use super::Claim;
use weald_core::error::{DeviceError, DeviceErrorKind, Error};
use weald_picture::{Image, RenderDevice};

/// A figure's declaration.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Word after `--only`, and start of its files' names.
    pub id: &'static str,
    /// Heading on the page.
    pub title: &'static str,
    /// Publication and figure.
    pub source: &'static str,
    /// What the source shows and claims.
    pub shows: &'static str,
    /// About how many seconds it takes at full detail on two cores, for those who wait.
    pub seconds: u32,
    /// Makes it.
    pub make: Make,
}

/// How a figure is made.
#[derive(Clone, Copy, Debug)]
pub enum Make {
    /// On the processor.
    Alone(fn(GalleryJob) -> Result<FigureOutput, Error>),
    /// With a device that draws.
    Drawn(fn(GalleryJob, &dyn RenderDevice) -> Result<FigureOutput, Error>),
}

impl Figure {
    /// Makes it, where there may be a device that draws.
    ///
    /// # Errors
    /// [`Error::Run`] where a step fails, [`Error::Device`] where a device is needed and there is none, or it fails.
    pub fn output(&self, job: GalleryJob, device: Option<&dyn RenderDevice>) -> Result<FigureOutput, Error> {
        match (self.make, device) {
            (Make::Alone(make), _) => make(job),
            (Make::Drawn(make), Some(device)) => make(job, device),
            (Make::Drawn(_), None) => {
                let message = format!("figure {} is drawn by a graphics device, and there is none", self.id);
                Err(DeviceError::new(DeviceErrorKind::NoAdapter { found: Vec::new() }, message).into())
            }
        }
    }
}

/// How much work a figure may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// The sizes and counts that the measures are stated for: seconds to a minute a figure.
    #[default]
    Full,
    /// Small grids and few steps, to see that a figure can be made.
    Draft,
}

/// What a figure is given.
#[derive(Clone, Copy, Debug, Default)]
pub struct GalleryJob {
    /// How much work it may be.
    pub detail: Detail,
}

impl GalleryJob {
    /// `full` or `draft`, by the detail that is wanted.
    pub fn choose<T>(self, full: T, draft: T) -> T {
        match self.detail {
            Detail::Full => full,
            Detail::Draft => draft,
        }
    }
}

/// A figure as made.
#[derive(Clone, Debug, Default)]
pub struct FigureOutput {
    /// Pictures in the order of the page.
    pub plates: Vec<Plate>,
    /// Films, after them.
    pub films: Vec<Film>,
    /// What was measured.
    pub measured: Measured,
    /// What the source claims, judged by the measures.
    pub claims: Vec<Claim>,
}

/// One picture of a figure.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Ends the file's name: `ID-NAME.png`.
    pub name: &'static str,
    /// What it shows, from left to right.
    pub caption: String,
    /// The picture.
    pub image: Image,
}

/// Pictures that move.
#[derive(Clone, Debug)]
pub struct Film {
    /// Ends the file's name: `ID-NAME.png`, an animated PNG.
    pub name: &'static str,
    /// What it shows.
    pub caption: String,
    /// All of one size.
    pub frames: Vec<Image>,
    /// Frames shown a second.
    pub per_second: f64,
}

/// A table of measures, and what follows from it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// Headings of the columns; empty without a table.
    pub header: Vec<String>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<String>>,
    /// Sentences below the table.
    pub remarks: Vec<String>,
}

/// Headings or cells of a table.
pub(crate) fn texts<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}
