//! The frame of the gallery, and every figure in it as a draft.

use weald::gallery::{
    Detail, FIGURES, Figure, FigureOutput, GalleryJob, Measured, Plate, Selection, write_figures,
};
use weald::picture::Image;

fn plate(job: GalleryJob) -> FigureOutput {
    let side = job.choose(4, 2);
    let plates = vec![Plate { name: "view", caption: "A sheet".to_owned(), image: Image::paper(side, side) }];
    let rows = vec![vec!["paper".to_owned(), side.to_string()]];
    let header = vec!["kind".to_owned(), "side".to_owned()];
    FigureOutput { plates, measured: Measured { header, rows, remarks: vec!["Blank.".to_owned()] } }
}

fn figure(id: &'static str) -> Figure {
    Figure { id, title: "A test", source: "Weald", shows: "Paper.", make: |job| Ok(plate(job)) }
}

#[test]
fn a_page_names_source_claim_picture_and_measures() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &[], job: GalleryJob::default() };
    write_figures(&[figure("one")], folder.path(), &selection, &|_| {}).expect("writes");
    let page = std::fs::read_to_string(folder.path().join("index.md")).expect("a page");
    for part in
        ["## A test", "Source: Weald.", "Paper.", "![A sheet](one-view.png)", "| paper | 4 |", "Blank."]
    {
        assert!(page.contains(part), "{part} is missing from:\n{page}");
    }
    assert!(folder.path().join("one-view.png").exists());
}

#[test]
fn making_one_figure_again_keeps_the_sections_of_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let figures = [figure("one"), figure("two")];
    let full = Selection { only: &[], job: GalleryJob::default() };
    write_figures(&figures, folder.path(), &full, &|_| {}).expect("writes");
    let draft = Selection { only: &["two".to_owned()], job: GalleryJob { detail: Detail::Draft } };
    write_figures(&figures, folder.path(), &draft, &|id| assert_eq!(id, "two")).expect("writes");
    let page = std::fs::read_to_string(folder.path().join("index.md")).expect("a page");
    let (one, two) = (page.find("| paper | 4 |").expect("one"), page.find("| paper | 2 |").expect("two"));
    assert!(one < two, "{page}");
}

#[test]
fn an_unknown_figure_is_refused_with_the_names_there_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &["three".to_owned()], job: GalleryJob::default() };
    let error = write_figures(&[figure("one")], folder.path(), &selection, &|_| {}).expect_err("unknown");
    assert_eq!(error.to_string(), "there is no figure `three`; the figures are: one");
}

#[test]
fn every_figure_can_be_made_as_a_draft() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &[], job: GalleryJob { detail: Detail::Draft } };
    write_figures(FIGURES, folder.path(), &selection, &|_| {}).expect("writes");
    let pictures = std::fs::read_dir(folder.path()).expect("a folder").count() - 1;
    assert!(pictures >= FIGURES.len(), "{pictures} pictures");
}
