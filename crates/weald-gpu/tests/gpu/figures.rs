//! The figures of the gallery that a device draws.

use crate::programs::gpu;
use weald_gallery::figures::{Detail, FIGURES, GalleryJob, Make, Selection, write_figures};

#[test]
fn every_figure_that_a_device_draws_can_be_made_as_a_draft() {
    let Some(gpu) = gpu() else { return };
    let drawn: Vec<_> =
        FIGURES.iter().filter(|figure| matches!(figure.make, Make::Drawn(_))).copied().collect();
    assert!(drawn.len() > 2, "{} figures", drawn.len());
    let job = GalleryJob { detail: Detail::Draft };
    let mut rates = None;
    for figure in &drawn {
        let output = figure.output(job, Some(&gpu)).expect("it can be made");
        assert!(!output.plates.is_empty() && !output.claims.is_empty(), "{}", figure.id);
        let without = figure.output(job, None).expect_err("there is no device").to_string();
        assert!(without.contains(figure.id), "{without}");
        if figure.id == "grass-8" {
            rates = Some(output.measured);
        }
    }
    let measured = rates.expect("the tables");
    assert!(measured.rows.iter().any(|row| row[0] == "1"), "{:?}", measured.rows);
    assert!(measured.remarks[0].contains("llvmpipe") || !gpu.is_software(), "{:?}", measured.remarks);
}

#[test]
fn without_a_device_a_page_stops_at_what_needs_one_and_keeps_the_rest() {
    let folder = tempfile::tempdir().expect("a folder");
    let only = ["grass-6".to_owned(), "grass-12".to_owned()];
    let selection = Selection { only: &only, job: GalleryJob { detail: Detail::Draft }, device: None };
    let error = write_figures(FIGURES, folder.path(), &selection, &|_| {}).expect_err("no device");
    assert!(error.to_string().contains("grass-12"), "{error}");
    let page = std::fs::read_to_string(folder.path().join("index.md")).expect("a page");
    assert!(page.contains("grass-6") && !page.contains("grass-12"), "{page}");
}
