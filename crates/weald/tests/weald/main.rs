//! Recipes and the catalogue from end to end.

mod analysis;
mod cached_runs;
mod catalog;
#[path = "../../../weald-land/tests/land/common/mod.rs"]
mod common;
mod distributed;
mod documents;
mod edited_runs;
mod engine_sets;
mod folders_by_ranks;
mod grass;
mod ground;
mod ground_by_rows;
mod islands;
mod json_schema;
mod kept_parts;
mod load_by_rows;
mod local_steps;
mod materials;
mod networks;
mod out_of_core;
mod over_ranks;
mod own_grid;
mod plants;
#[path = "../../../weald-export/tests/export/programs/mod.rs"]
mod programs;
mod qgis;
mod random_recipes;
mod recipes;
mod report;
mod rivers;
mod sessions;
mod shaders;
mod stream_azimuths;
mod told_before;
mod vectors;
