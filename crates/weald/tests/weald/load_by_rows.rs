//! Layers of files of which each process reads its own rows: those of a run that has the whole in memory.

use std::path::Path;

use crate::distributed::over_with;
use crate::ground_by_rows::ground_with_holes;
use crate::out_of_core::{BESIDE, assert_same_files, recipe, run, said};
use weald::recipe::{Options, Recipe, Report, Silent};

/// Generated ground of as many cells as the file, or that of the file, with layers of the file.
fn land(file: &Path, is_of_file: bool, load: &str) -> Recipe {
    let path = file.display().to_string();
    let landscape = if is_of_file {
        format!("from = {path:?}\nnodata = -1.0")
    } else {
        "size = [230, 400]\ncell = 20.0\n[[step]]\ndo = \"fbm\"\nrelief = 300".to_owned()
    };
    let output = |layer: &str| format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.tif\"\n");
    recipe(&format!(
        "[landscape]\n{landscape}\n[[step]]\ndo = \"load\"\nfile = {path:?}\nnodata = -1.0\ninto = \"soil\"\n{load}\n\
         [[step]]\ndo = \"add\"\nwith = \"soil\"\n{}{}",
        output("soil"),
        output("height")
    ))
}

fn into(out: &Path) -> Options {
    Options { memory: Some(1 << 30), ..Options::into_folder(out) }
}

#[test]
fn layers_of_files_are_read_by_rows_to_the_bits_of_the_whole() {
    let [folder, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let file = ground_with_holes(folder.path());
    for (is_of_file, load, count) in [
        (true, "", 0),
        (true, "unit = \"ft\"", 3),
        (false, "no_data = 7.5\nscale = 0.25\noffset = -3", 0),
        (false, "no_data = 7.5", 6),
    ] {
        let recipe = land(&file, is_of_file, load);
        let [whole, out] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        let got = if count == 0 {
            run(&recipe, out.path(), Some((scratch.path(), BESIDE + (3 << 20))), &Silent)
        } else {
            over_with(count, &recipe, &|_| into(out.path()), &Silent).swap_remove(0)
        };
        let got = got.unwrap_or_else(|error| panic!("{load} over {count}: {error}"));
        assert_eq!(said(&Report { engine: "cpu".to_owned(), ..got }), said(&expected), "{load}");
        assert_same_files(&expected, [whole.path(), out.path()], &format!("{load} over {count}"));
    }
}

#[test]
fn a_layer_that_is_not_read_by_rows_is_refused_with_what_to_do_before_anything_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = ground_with_holes(folder.path());
    let out = folder.path().join("out");
    let refused = |recipe: &Recipe| {
        let ends = over_with(2, recipe, &|_| into(&out), &Silent).into_iter();
        let said: Vec<_> = ends.map(|end| end.expect_err("refused").to_string()).collect();
        assert!(!out.exists(), "nothing was begun");
        said[0].clone()
    };
    let resampled = refused(&land(&file, false, "no_data = 7.5\nresample = true"));
    assert!(resampled.contains("the step `load`: `resample = true`"), "{resampled}");
    let other = recipe(
        "[landscape]\nsize = 40\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"load\"\nfile = \"FILE\"\ninto = \"soil\"\n\
         [[output]]\nlayer = \"soil\"\nfile = \"s.tif\"\n"
            .replace("FILE", &file.display().to_string())
            .as_str(),
    );
    let other = refused(&other);
    assert!(other.contains("gdalwarp -ts 40 40"), "{other}");
}

#[test]
fn ground_without_data_in_the_file_is_named_by_its_place_in_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = ground_with_holes(folder.path());
    let ends = over_with(3, &land(&file, false, ""), &|_| into(&folder.path().join("out")), &Silent);
    let in_memory = run(&land(&file, false, ""), &folder.path().join("whole"), None, &Silent);
    let in_memory = in_memory.expect_err("no data").to_string();
    assert!(in_memory.contains("column 0, row 0 has no data"), "{in_memory}");
    for (end, place) in ends.into_iter().zip(["column 0, row 0", "column 40, row 133"]) {
        let error = end.expect_err("no data").to_string();
        assert!(error.contains(&format!("{place} has no data, where the landscape has ground")), "{error}");
    }
}
