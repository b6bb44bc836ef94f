//! The committed gallery, renewed from the one that `weald gallery` has made.

use std::collections::BTreeSet;
use std::path::Path;

use weald::Error;
use weald::io::write_whole;
use weald_gallery::figures::{FIGURES, Figure, merged_page};

use crate::keep::{Kept, keep};

/// What became of a committed picture, by its name.
#[derive(Clone, Debug, PartialEq)]
pub enum Renewed {
    /// The picture of a figure.
    Figure(String, Kept),
    /// No figure shows it any more: it was deleted.
    Deleted(String),
}

/// Renews the committed gallery `into` from the folder `from`: pictures that look different, or all if `anew`, and the
/// sections of all figures that `from` has, with their measures.
///
/// # Errors
/// [`Error::Run`] where there is no gallery in `from`, or a file cannot be read or written.
pub fn renew(from: &Path, into: &Path, anew: bool, told: &dyn Fn(&Renewed)) -> Result<(), Error> {
    renew_figures(FIGURES, from, into, anew, told)
}

fn renew_figures(
    figures: &[Figure],
    from: &Path,
    into: &Path,
    anew: bool,
    told: &dyn Fn(&Renewed),
) -> Result<(), Error> {
    let [made, committed] = [from, into].map(|folder| folder.join("index.md"));
    if !made.exists() {
        return Err(Error::Run(format!(
            "there is no gallery in {}; `weald gallery --out {0}` makes it",
            from.display()
        )));
    }
    let mut page = merged_page(figures, &committed, &made);
    // Links to PNG stand in sections that have just been made, all others lead to WebP.
    for picture in pictures(&page, ".png") {
        let name = picture.replace(".png", ".webp");
        let kept = keep(&from.join(&picture), &into.join(&name), anew)?;
        told(&Renewed::Figure(name.clone(), kept));
        page = page.replace(&format!("]({picture})"), &format!("]({name})"));
    }
    write_whole(&committed, page.as_bytes())?;
    delete_others(into, &pictures(&page, ".webp"), told)
}

/// Names of pictures that a page shows, with an end.
fn pictures(page: &str, end: &str) -> BTreeSet<String> {
    let links = page.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
    links.filter(|link| link.ends_with(end)).map(str::to_owned).collect()
}

/// Deletes pictures that the page does not show.
fn delete_others(folder: &Path, shown: &BTreeSet<String>, told: &dyn Fn(&Renewed)) -> Result<(), Error> {
    let failed = |cause| Error::write(folder, &cause);
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.extension().is_some_and(|end| end == "webp") && !shown.contains(&name) {
            std::fs::remove_file(&path).map_err(|cause| Error::write(&path, &cause))?;
            told(&Renewed::Deleted(name));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use weald::picture::Image;
    use weald_gallery::figures::{
        Detail, FigureOutput, GalleryJob, Make, Measured, Plate, Selection, write_figures,
    };

    use super::*;

    /// A sheet, marked where it is a draft.
    #[expect(clippy::unnecessary_wraps, reason = "figures are made by functions that may fail")]
    fn sheet(job: GalleryJob) -> Result<FigureOutput, Error> {
        let mut image = Image::paper(80, 80);
        image.rgb[..job.choose(0, 9_000)].fill(0);
        let plates = vec![Plate { name: "view", caption: "A sheet".to_owned(), image }];
        let remarks = vec![job.choose("White.", "Marked.").to_owned()];
        Ok(FigureOutput {
            plates,
            measured: Measured { remarks, ..Measured::default() },
            claims: Vec::new(),
            ..FigureOutput::default()
        })
    }

    fn figure(id: &'static str) -> Figure {
        let (title, source, shows) = ("A test", "Weald", "Paper.");
        Figure { id, title, source, shows, seconds: 0, make: Make::Alone(sheet) }
    }

    /// Makes figures into one folder, renews the other from it, and lists what was told.
    fn renewed(figures: &[Figure], only: &[&str], detail: Detail, folders: [&Path; 2]) -> Vec<String> {
        let only: Vec<String> = only.iter().map(|&id| id.to_owned()).collect();
        let selection = Selection { only: &only, job: GalleryJob { detail }, device: None };
        write_figures(figures, folders[0], &selection, &|_| {}).expect("made");
        let told = RefCell::new(Vec::new());
        let tell = |renewed: &Renewed| {
            told.borrow_mut().push(match renewed {
                Renewed::Figure(name, Kept::AsItWas(_)) => format!("{name} kept"),
                Renewed::Figure(name, Kept::Written(..)) => format!("{name} written"),
                Renewed::Deleted(name) => format!("{name} deleted"),
            });
        };
        renew_figures(figures, folders[0], folders[1], false, &tell).expect("renewed");
        told.into_inner()
    }

    #[test]
    fn pictures_that_look_different_and_all_sections_that_were_made_are_renewed() {
        let (new, committed) = (tempfile::tempdir().expect("one"), tempfile::tempdir().expect("two"));
        let folders = [new.path(), committed.path()];
        let both = [figure("one"), figure("two")];
        let all = renewed(&both, &[], Detail::Full, folders);
        assert_eq!(all, ["one-view.webp written", "two-view.webp written"]);

        std::fs::remove_file(new.path().join("index.md")).expect("the page");
        assert_eq!(renewed(&both, &["two"], Detail::Full, folders), ["two-view.webp kept"]);
        assert_eq!(renewed(&both, &["two"], Detail::Draft, folders), ["two-view.webp written"]);
        let page = std::fs::read_to_string(committed.path().join("index.md")).expect("a page");
        for part in ["](one-view.webp)", "](two-view.webp)", "White.", "Marked."] {
            assert!(page.contains(part), "{part}: {page}");
        }
        assert!(!page.contains(".png"), "{page}");

        let left = renewed(&both[1..], &[], Detail::Draft, folders);
        assert_eq!(left, ["two-view.webp kept", "one-view.webp deleted"]);
    }

    #[test]
    fn a_folder_without_a_gallery_says_how_to_make_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = renew(folder.path(), folder.path(), false, &|_| {}).expect_err("none").to_string();
        assert!(error.contains("weald gallery --out"), "{error}");
    }
}
