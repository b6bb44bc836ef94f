//! The frame of the gallery, and every figure in it as a draft.

use weald::picture::Image;
use weald_gallery::figures::{
    Claim, Detail, FIGURES, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Selection, Verdict,
    write_figures,
};

fn plate(job: GalleryJob) -> FigureOutput {
    let side = job.choose(4, 2);
    let plates = vec![Plate { name: "view", caption: "A sheet".to_owned(), image: Image::paper(side, side) }];
    let rows = vec![vec!["paper".to_owned(), side.to_string()]];
    let header = vec!["kind".to_owned(), "side".to_owned()];
    let measured = Measured { header, rows, remarks: vec!["Blank.".to_owned()] };
    let claims = vec![Claim::new("Paper is blank", Verdict::of(side > 2), format!("{side} cells"))];
    FigureOutput { plates, measured, claims, ..FigureOutput::default() }
}

fn figure(id: &'static str) -> Figure {
    Figure {
        id,
        title: "A test",
        source: "Weald",
        shows: "Paper.",
        seconds: 0,
        make: Make::Alone(|job| Ok(plate(job))),
    }
}

#[test]
fn a_page_names_source_claim_picture_and_measures() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &[], job: GalleryJob::default(), device: None };
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
fn all_claims_stand_at_the_head_of_the_page_with_their_verdicts() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |only: &[String], detail| {
        let selection = Selection { only, job: GalleryJob { detail }, device: None };
        write_figures(&[figure("one"), figure("two")], folder.path(), &selection, &|_| {}).expect("writes");
        std::fs::read_to_string(folder.path().join("index.md")).expect("a page")
    };
    let page = write(&[], Detail::Full);
    let head = page.split_once("<!-- figure").expect("a head").0;
    assert!(head.contains("| [one](#one) | Paper is blank | **shown** |"), "{head}");
    assert!(page.contains("| Paper is blank | **shown** | 4 cells |"), "{page}");
    // The other figure's verdict stays when one is made again.
    let page = write(&["two".to_owned()], Detail::Draft);
    let head = page.split_once("<!-- figure").expect("a head").0;
    assert!(head.contains("| [one](#one) | Paper is blank | **shown** |"), "{head}");
    assert!(head.contains("| [two](#two) | Paper is blank | **not reproduced** |"), "{head}");
}

#[test]
fn making_one_figure_again_keeps_the_sections_of_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let figures = [figure("one"), figure("two")];
    let full = Selection { only: &[], job: GalleryJob::default(), device: None };
    write_figures(&figures, folder.path(), &full, &|_| {}).expect("writes");
    let draft =
        Selection { only: &["two".to_owned()], job: GalleryJob { detail: Detail::Draft }, device: None };
    write_figures(&figures, folder.path(), &draft, &|begun| {
        assert_eq!((begun.figure.id, begun.number, begun.count), ("two", 1, 1));
    })
    .expect("writes");
    let page = std::fs::read_to_string(folder.path().join("index.md")).expect("a page");
    let (one, two) = (page.find("| paper | 4 |").expect("one"), page.find("| paper | 2 |").expect("two"));
    assert!(one < two, "{page}");
}

#[test]
fn an_unknown_figure_is_refused_with_the_names_there_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &["three".to_owned()], job: GalleryJob::default(), device: None };
    let error = write_figures(&[figure("one")], folder.path(), &selection, &|_| {}).expect_err("unknown");
    assert_eq!(error.to_string(), "there is no figure `three`; the figures are: one");
}

#[test]
fn every_figure_can_be_made_as_a_draft() {
    let folder = tempfile::tempdir().expect("a folder");
    let selection = Selection { only: &[], job: GalleryJob { detail: Detail::Draft }, device: None };
    // Those that a device draws are made in the tests of the crate that draws.
    let alone = FIGURES.iter().filter(|figure| matches!(figure.make, Make::Alone(_)));
    let alone: Vec<_> = alone.copied().collect();
    write_figures(&alone, folder.path(), &selection, &|_| {}).expect("writes");
    let pictures = std::fs::read_dir(folder.path()).expect("a folder").count() - 1;
    assert!(pictures >= alone.len(), "{pictures} pictures");
    let page = std::fs::read_to_string(folder.path().join("index.md")).expect("a page");
    for figure in &alone {
        assert!(page.contains(&format!("| [{0}](#{0}) | ", figure.id)), "{} claims nothing", figure.id);
    }
}

/// The measures of a figure as it stands in the gallery: the number in a row and a column.
fn measured(id: &str) -> impl Fn(usize, usize) -> f64 {
    let figure = FIGURES.iter().find(|figure| figure.id == id).expect("there is such a figure");
    let rows = figure.output(GalleryJob::default(), None).expect("it can be made").measured.rows;
    move |row, column| {
        let cell = rows[row][column].trim_end_matches(" %");
        cell.parse().unwrap_or_else(|_| panic!("`{cell}` is a number"))
    }
}

#[test]
fn in_the_canyon_hard_beds_stand_steeper_than_the_soft_one_which_is_cut_back() {
    let of = measured("canyon");
    let [sandstone, shale] = [0, 1];
    assert!(of(shale, 2) > 1.5 * of(shale, 1), "the shale went from {} to {} m", of(shale, 1), of(shale, 2));
    assert!(of(sandstone, 4) > of(sandstone, 3) + 5.0, "the sandstone steepens from {}°", of(sandstone, 3));
    assert!(of(sandstone, 4) > of(shale, 4) + 12.0, "{}° over {}°", of(sandstone, 4), of(shale, 4));
}

#[test]
fn force_cuts_deeper_and_roughens_the_bed_that_dissolution_evens_out() {
    let of = measured("force");
    let [before, force, dissolution] = [0, 1, 2];
    assert!(of(dissolution, 1) > 0.5 && of(force, 1) > 1.3 * of(dissolution, 1), "{}", of(force, 1));
    assert!(of(force, 3) > of(before, 3), "force leaves {} m", of(force, 3));
    assert!(of(dissolution, 3) < 0.2 * of(before, 3), "dissolution leaves {} m", of(dissolution, 3));
}

#[test]
fn slippage_leaves_no_bank_much_steeper_than_its_talus() {
    let of = measured("banks");
    let [before, cut, slid] = [0, 1, 2];
    assert_eq!(of(before, 2), 0.0, "the banks rest before");
    assert!(of(cut, 2) > 50.0, "the river cuts {} cells of soil too steep", of(cut, 2));
    assert!(of(slid, 2) < 0.1 * of(cut, 2), "{} of them are left", of(slid, 2));
}

#[test]
fn a_lake_rises_to_its_outlet_within_a_centimetre_and_sinks_as_its_spill_carves() {
    let of = measured("lake");
    let [before, filling, full, spilled] = [0, 1, 2, 3];
    assert!(of(before, 1) < of(filling, 1) && of(filling, 1) < of(full, 1), "the lake rises");
    assert_eq!((of(before, 3), of(filling, 3)), (0.0, 0.0), "nothing spills before it is full");
    assert!((of(full, 1) - of(full, 2)).abs() < 0.01, "{} m at an outlet of {}", of(full, 1), of(full, 2));
    assert!(of(spilled, 2) < of(full, 2) - 0.5 && of(spilled, 1) < of(full, 1) - 0.5, "the spill carves");
    assert!(of(spilled, 3) > 1.0, "and water runs beyond");
}

#[test]
fn land_behind_a_painted_levee_stays_dry_that_is_flooded_without() {
    let of = measured("levee");
    let [without, with] = [1, 3];
    assert!(of(without, 2) > 20.0, "{} % are flooded without", of(without, 2));
    assert_eq!(of(with, 1), 0.0, "no cell is with it");
    assert!(of(with, 3) >= of(without, 3) * 0.9, "the river is there: {} m", of(with, 3));
}
