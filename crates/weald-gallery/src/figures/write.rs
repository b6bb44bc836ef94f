//! Making figures and writing them down: pictures, and the page after each.

use std::path::Path;

use super::{FIGURES, Figure, FigureOutput, GalleryJob, Make, page};
use weald_core::error::Error;
use weald_io::write_whole;
use weald_picture::{Cutout, RenderDevice, write_apng};

/// A figure that is about to be made.
#[derive(Clone, Copy, Debug)]
pub struct StartedFigure<'a> {
    /// The figure.
    pub figure: &'a Figure,
    /// Its place among those that are made, counted from 1.
    pub number: usize,
    /// How many are made.
    pub count: usize,
}

/// Makes the figures named in `only`, or all where it is empty, and writes their pictures and `index.md` into
/// a folder. Sections of other figures on an older page stay. `progress` is called for each figure begun.
///
/// # Errors
/// [`Error::Run`] for an unknown id, a failed step, or a folder that cannot be written; [`Error::Device`] for a figure that
/// a device draws where there is none.
pub fn write(
    folder: &Path,
    only: &[String],
    device: Option<&dyn RenderDevice>,
    progress: &dyn Fn(StartedFigure<'_>),
) -> Result<(), Error> {
    write_figures(FIGURES, folder, &Selection { only, job: GalleryJob::default(), device }, progress)
}

/// Which figures to make, and how.
#[derive(Clone, Copy, Debug)]
pub struct Selection<'a> {
    /// Ids of the figures; all where empty.
    pub only: &'a [String],
    /// What each is given.
    pub job: GalleryJob,
    /// What draws those figures that a device draws.
    pub device: Option<&'a dyn RenderDevice>,
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
    progress: &dyn Fn(StartedFigure<'_>),
) -> Result<(), Error> {
    check_ids(figures, selection.only)?;
    std::fs::create_dir_all(folder).map_err(|cause| Error::write(folder, &cause))?;
    let page = folder.join("index.md");
    let mut sections = page::sections(&page);
    let chosen: Vec<_> = figures.iter().filter(|figure| selected(figure, selection.only)).collect();
    for (place, figure) in chosen.iter().enumerate() {
        progress(StartedFigure { figure, number: place + 1, count: chosen.len() });
        let output = figure.output(selection.job, selection.device)?;
        write_plates(figure, &output, folder)?;
        sections.insert(figure.id.to_owned(), page::section(figure, &output));
        write_whole(&page, page::assemble(figures, &sections).as_bytes())?;
    }
    Ok(())
}

/// Whether a device draws some of the figures named in `only`, or of all where it is empty.
pub fn draws(only: &[String]) -> bool {
    FIGURES.iter().any(|figure| selected(figure, only) && matches!(figure.make, Make::Drawn(_)))
}

fn write_plates(figure: &Figure, output: &FigureOutput, folder: &Path) -> Result<(), Error> {
    let text =
        [("Title".to_owned(), figure.title.to_owned()), ("Source".to_owned(), figure.source.to_owned())];
    for plate in &output.plates {
        write_whole(&folder.join(page::file_name(figure, plate.name)), &plate.image.to_png(&text))?;
    }
    for film in &output.films {
        let frame = |number: u64| Ok(Cutout::from(film.frames[number as usize].clone()));
        let path = folder.join(page::file_name(figure, film.name));
        write_apng(&path, (film.frames.len() as u64, film.per_second), frame)?;
    }
    Ok(())
}

fn selected(figure: &Figure, only: &[String]) -> bool {
    only.is_empty() || only.iter().any(|id| id == figure.id || group(figure) == Some(id))
}

/// What stands before the number of a figure, as `ifs` in `ifs-5` and `grass` in `grass-5b`: it selects all figures of a publication.
fn group(figure: &Figure) -> Option<&str> {
    let (group, number) = figure.id.rsplit_once('-')?;
    number.starts_with(|first: char| first.is_ascii_digit()).then_some(group)
}

/// Every word that selects figures: ids, and groups such as `ifs` before their first figure.
pub fn selectable(figures: &[Figure]) -> impl Iterator<Item = &str> {
    figures.iter().enumerate().flat_map(|(place, figure)| {
        let begins = place == 0 || group(&figures[place - 1]) != group(figure);
        group(figure).filter(|_| begins).into_iter().chain([figure.id])
    })
}

fn check_ids(figures: &[Figure], only: &[String]) -> Result<(), Error> {
    let known: Vec<&str> = selectable(figures).collect();
    match only.iter().find(|id| !known.contains(&id.as_str())) {
        Some(id) => {
            Err(Error::Run(format!("there is no figure `{id}`; the figures are: {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
