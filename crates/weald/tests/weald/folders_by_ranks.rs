//! Folders that ranks write side by side: those of a run in memory, to the byte, and of one output folder.

use crate::distributed::{assert_same_by_rows, over_with};
use crate::out_of_core::recipe;
use weald::recipe::{Options, Recipe, Silent};

/// Generated ground with rows of chunks that lie with several ranks.
fn land() -> Recipe {
    let output = |layer: &str, file: &str, more: &str| {
        format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n{more}\n")
    };
    let outputs = [
        output("height", "deep/height.zarr", ""),
        output("height", "shards.zarr", "preset = \"sharded\""),
        output("flow_direction", "directions.zarr", "preset = \"sharded\""),
        output("accumulation", "areas.zarr", ""),
    ];
    recipe(&format!(
        "[landscape]\nsize = [530, 610]\ncell = 12.0\nseed = 5\n\
         [[step]]\ndo = \"fbm\"\nrelief = 400\nwavelength = 900\n[[step]]\ndo = \"flow\"\n{}",
        outputs.concat()
    ))
}

#[test]
fn ranks_write_the_zarr_of_a_run_in_memory_side_by_side() {
    assert_same_by_rows(&land(), &[0, 1, 2, 3, 4, 6], "folders");
}

#[test]
fn a_rank_with_another_output_folder_ends_all_before_a_folder_has_its_name() {
    let [out, other] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let options = |rank| {
        let folder = if rank == 1 { other.path() } else { out.path() };
        Options { memory: Some(1 << 30), ..Options::into_folder(folder) }
    };
    for end in over_with(3, &land(), &options, &Silent) {
        let error = end.expect_err("refused").to_string();
        assert!(error.contains("must be the same on the machines of all ranks"), "{error}");
    }
    assert!(!out.path().join("shards.zarr").exists() && !out.path().join("deep/height.zarr").exists());
}
