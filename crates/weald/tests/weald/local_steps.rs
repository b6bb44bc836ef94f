//! Steps that look at a cell and those around it alone, on rows of a landscape that no process holds: the files of a run in memory.

use std::fmt::Write;
use std::path::Path;

use crate::distributed::over_with;
use crate::ground_by_rows::ground_with_holes;
use crate::out_of_core::{BESIDE, assert_same_files, recipe, run, said};
use weald::recipe::{Options, Recipe, Report, Silent};

/// Layers that the steps leave.
const LAYERS: [&str; 13] = [
    "height",
    "slope",
    "aspect",
    "northness",
    "curvature_profile",
    "soil_depth",
    "fertility",
    "steps",
    "mask",
    "blurred",
    "flattened",
    "steep",
    "nowhere",
];

/// Every local step on a ground, with windows of several widths; some layers also as bare numbers.
fn land(landscape: &str) -> Recipe {
    let steps = [
        "do = \"slope\"",
        "do = \"slope\"\nunit = \"tangent\"\nscale = 95\ninto = \"wide\"",
        "do = \"aspect\"\nscale = 40",
        "do = \"curvature\"",
        "do = \"remap\"\nlayer = \"slope\"\nfrom = [2, 20]\ninto = \"mask\"",
        "do = \"terrace\"\nspacing = 25\ninto = \"steps\"",
        "do = \"blend\"\nwith = \"steps\"\nmask = \"mask\"",
        "do = \"add\"\nwith = \"wide\"\nfactor = 3",
        "do = \"max\"\nwith = \"steps\"",
        "do = \"min\"\nlayer = \"steps\"\nwith = \"height\"",
        "do = \"soil\"\nscale = 50\nmoisture = \"mask\"",
        "do = \"smooth\"\nradius = 37\ninto = \"blurred\"",
        "do = \"smooth\"\nlayer = \"steps\"\nradius = 5\ninto = \"flattened\"",
        "do = \"smooth\"\nradius = 21",
        "do = \"select\"\nwhere = [{ layer = \"slope\", above = 9, soft = 3 }, { layer = \"mask\", below = 0.7 }]\ninto = \"steep\"",
        "do = \"select\"\nwhere = [{ layer = \"height\", above = 9000 }]\ninto = \"nowhere\"",
    ];
    let mut text = landscape.to_owned();
    for step in steps {
        let _ = write!(text, "[[step]]\n{step}\n");
    }
    for layer in LAYERS {
        let _ = write!(text, "[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.tif\"\n");
    }
    for (layer, file) in [("height", "bare.r16"), ("slope", "bare.r32"), ("mask", "bare/mask.raw")] {
        let _ = write!(text, "[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n");
    }
    recipe(&text)
}

fn generated(size: [usize; 2]) -> String {
    format!(
        "[landscape]\nsize = {size:?}\ncell = 20.0\n[[step]]\ndo = \"fbm\"\nrelief = 300\nwavelength = 900\n"
    )
}

fn into(out: &Path) -> Options {
    Options { memory: Some(1 << 30), ..Options::into_folder(out) }
}

#[test]
fn local_steps_give_the_files_of_a_run_in_memory_on_rows_of_any_rank() {
    let [folder, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let file = ground_with_holes(folder.path()).display().to_string();
    let with_holes = format!("[landscape]\nfrom = {file:?}\nnodata = -1.0\n");
    // A file is read in tiles of 256 rows.
    for (landscape, memory) in [(generated([150, 230]), 1 << 20), (with_holes, 3 << 20)] {
        let (recipe, whole) = (land(&landscape), tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        for count in [0, 1, 3, 6] {
            let out = tempfile::tempdir().expect("a folder");
            let got = if count == 0 {
                run(&recipe, out.path(), Some((scratch.path(), BESIDE + memory)), &Silent)
            } else {
                over_with(count, &recipe, &|_| into(out.path()), &Silent).swap_remove(0)
            };
            let got = got.unwrap_or_else(|error| panic!("over {count}: {error}"));
            assert_eq!(said(&Report { engine: "cpu".to_owned(), ..got }), said(&expected), "over {count}");
            assert_same_files(&expected, [whole.path(), out.path()], &format!("{landscape} over {count}"));
        }
    }
}

#[test]
fn a_window_wider_than_the_rows_of_a_rank_is_refused_before_anything_runs() {
    let out = tempfile::tempdir().expect("a folder");
    let text = generated([60, 130])
        + "[[step]]\ndo = \"slope\"\nscale = 620\n[[output]]\nlayer = \"slope\"\nfile = \"s.tif\"\n";
    let wide = recipe(&text);
    for end in over_with(4, &wide, &|_| into(&out.path().join("out")), &Silent) {
        let error = end.expect_err("refused").to_string();
        assert!(error.contains("step 2 (`slope`) looks 34 rows far, and a rank has 32"), "{error}");
    }
    assert!(!out.path().join("out").exists(), "nothing was begun");
    let done = over_with(3, &wide, &|_| into(&out.path().join("out")), &Silent);
    assert!(done.iter().all(Result::is_ok), "{done:?}");
}
