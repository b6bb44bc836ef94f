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
mod han;
mod lake;
mod layered;
mod levee;
mod page;
mod parameters;
mod printed;
mod spacing;
mod stability;
mod start;
mod steps;
mod views;
mod weathering;

pub use claim::{Claim, Verdict};
pub use steps::run_steps;

use std::path::Path;

use crate::error::Error;
use crate::io::write_whole;
use crate::picture::Image;

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
    pub make: fn(GalleryJob) -> Result<FigureOutput, Error>,
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
];

/// A figure that is about to be made.
#[derive(Clone, Copy, Debug)]
pub struct Begun<'a> {
    /// The figure.
    pub figure: &'a Figure,
    /// Its place among those that are made, counted from 1.
    pub number: usize,
    /// How many are made.
    pub count: usize,
}

/// Makes the figures named in `only`, or all where it is empty, and writes their pictures and `index.md` into
/// a folder. Sections of other figures on an older page stay. `progress` hears of each figure begun.
///
/// # Errors
/// [`Error::Run`] for an unknown id, a failed step, or a folder that cannot be written.
pub fn write(folder: &Path, only: &[String], progress: &dyn Fn(Begun<'_>)) -> Result<(), Error> {
    write_figures(FIGURES, folder, &Selection { only, job: GalleryJob::default() }, progress)
}

/// Which figures to make, and how.
#[derive(Clone, Copy, Debug)]
pub struct Selection<'a> {
    /// Ids of the figures; all where empty.
    pub only: &'a [String],
    /// What each is given.
    pub job: GalleryJob,
}

/// [`write()`] for any list of figures. The page is written after each, so that what is done stays if the rest
/// is interrupted.
///
/// # Errors
/// As [`write()`].
pub fn write_figures(
    figures: &[Figure],
    folder: &Path,
    selection: &Selection<'_>,
    progress: &dyn Fn(Begun<'_>),
) -> Result<(), Error> {
    check_ids(figures, selection.only)?;
    std::fs::create_dir_all(folder).map_err(|cause| Error::write(folder, &cause))?;
    let page = folder.join("index.md");
    let mut sections = page::sections(&page);
    let chosen: Vec<_> = figures.iter().filter(|figure| selected(figure, selection.only)).collect();
    for (place, figure) in chosen.iter().enumerate() {
        progress(Begun { figure, number: place + 1, count: chosen.len() });
        let output = (figure.make)(selection.job)?;
        write_plates(figure, &output, folder)?;
        sections.insert(figure.id.to_owned(), page::section(figure, &output));
        write_whole(&page, page::assemble(figures, &sections).as_bytes())?;
    }
    Ok(())
}

fn write_plates(figure: &Figure, output: &FigureOutput, folder: &Path) -> Result<(), Error> {
    let text =
        [("Title".to_owned(), figure.title.to_owned()), ("Source".to_owned(), figure.source.to_owned())];
    for plate in &output.plates {
        write_whole(&folder.join(page::file_name(figure, plate)), &plate.image.to_png(&text))?;
    }
    Ok(())
}

fn selected(figure: &Figure, only: &[String]) -> bool {
    only.is_empty() || only.iter().any(|id| id == figure.id)
}

fn check_ids(figures: &[Figure], only: &[String]) -> Result<(), Error> {
    let known: Vec<&str> = figures.iter().map(|figure| figure.id).collect();
    match only.iter().find(|id| !known.contains(&id.as_str())) {
        Some(id) => {
            Err(Error::Run(format!("there is no figure `{id}`; the figures are: {}", known.join(", "))))
        }
        None => Ok(()),
    }
}

/// Headings or cells of a table.
fn texts<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}
