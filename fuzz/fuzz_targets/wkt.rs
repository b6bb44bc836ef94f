//! Any text as the definition of the CRS of a grid, in the places where such texts stand: `.prj` and the attribute `crs_wkt`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::io::{InMemory, Limits, Part, asc, square, zarr};

const LIMITS: Limits = Limits { cells: 1 << 16 };
const GRID: &str = "ncols 2\nnrows 2\nxllcorner 5\nyllcorner 4\ncellsize 0.5\n1 2\n3 4\n";

fuzz_target!(|bytes: &[u8]| {
    let parts = vec![Part::sibling(".prj", bytes.to_vec()), Part::own(GRID.as_bytes().to_vec())];
    if let Ok(raster) = asc::decode(&InMemory::of("land.asc", parts), LIMITS) {
        // Numbers of a definition that make no cell are a fault.
        drop(square(raster));
    }
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let quoted = serde_json::to_string(text).expect("text is JSON");
    let array = |shape: &str, attributes: &str| {
        format!(
            "{{\"zarr_format\": 3, \"node_type\": \"array\", \"shape\": {shape}, \"data_type\": \"float64\", \
             \"chunk_grid\": {{\"name\": \"regular\", \"configuration\": {{\"chunk_shape\": {shape}}}}}, \
             \"chunk_key_encoding\": {{\"name\": \"default\"}}, \"fill_value\": 0, \"codecs\": [{{\"name\": \
             \"bytes\", \"configuration\": {{\"endian\": \"little\"}}}}], \"attributes\": {attributes}}}"
        )
    };
    let parts = vec![
        Part::inside("zarr.json", b"{\"zarr_format\": 3, \"node_type\": \"group\", \"attributes\": {}}".to_vec()),
        Part::inside("height/zarr.json", array("[2, 2]", "{\"grid_mapping\": \"crs\"}").into_bytes()),
        Part::inside("crs/zarr.json", array("[]", &format!("{{\"crs_wkt\": {quoted}}}")).into_bytes()),
    ];
    drop(zarr::decode(&InMemory::of("a.zarr", parts), LIMITS));
});
