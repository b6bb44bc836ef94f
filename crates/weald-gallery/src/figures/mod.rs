//! The figures of the publications that Weald implements, made again and measured. [`FIGURES`] is the registry.

mod ages;
mod banks;
mod canyon;
mod cases;
mod claim;
mod cone;
mod deposits;
mod dissolution;
mod drift;
mod fault;
mod flow_rate;
mod force;
mod forms;
mod grass;
mod han;
mod ifs;
mod lake;
mod layered;
mod levee;
mod page;
mod parameters;
mod printed;
mod spacing;
mod stability;
mod start;
mod views;
mod weathering;
mod write;

pub use claim::{Claim, Verdict};
pub use page::merged_page;
pub use write::{Begun, Selection, draws, selectable, write, write_figures};

use weald_core::error::Error;
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
            (Make::Drawn(_), None) => Err(Error::Device(format!(
                "figure {} is drawn by a graphics device, and there is none",
                self.id
            ))),
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

/// All figures in the order of the page. Adding one is one file and one line here.
pub const FIGURES: &[Figure] = &[
    fault::FIGURE,
    cone::FIGURE,
    start::FIGURE,
    parameters::FIGURE,
    stability::FIGURE,
    flow_rate::FIGURE,
    forms::FIGURE,
    cases::FIGURE,
    weathering::FIGURE,
    spacing::FIGURE,
    deposits::FIGURE,
    ages::FIGURE,
    dissolution::FIGURE,
    printed::FIGURE,
    drift::FIGURE,
    canyon::FIGURE,
    force::FIGURE,
    banks::FIGURE,
    lake::FIGURE,
    levee::FIGURE,
    ifs::FIGURE_1,
    ifs::FIGURE_2,
    ifs::FIGURE_3,
    ifs::FIGURE_4,
    ifs::FIGURE_5,
    ifs::FIGURE_6,
    ifs::FIGURE_7,
    ifs::FIGURE_8,
    ifs::FIGURE_9,
    ifs::FIGURE_10,
    ifs::FIGURE_11,
    ifs::FIGURE_12,
    ifs::FIGURE_13,
    ifs::FIGURE_14,
    ifs::FIGURE_15,
    ifs::FIGURE_16,
    grass::FIGURE_2,
    grass::FIGURE_3,
    grass::FIGURE_5,
    grass::FIGURE_5B,
    grass::FIGURE_6,
    grass::FIGURE_8,
    grass::FIGURE_10,
    grass::FIGURE_11,
    grass::FIGURE_12,
    grass::FIGURE_13,
];

/// Headings or cells of a table.
fn texts<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}
