//! All kinds of exports, by their names.

use super::{
    ExportEntry, GrassSets, LakeAreas, Layers, Mesh, PlantSet, Points, RiverLines, layers, points, report,
    terrain3d, unity, unreal,
};

/// All kinds of exports. Adding one is one file and one line here.
#[rustfmt::skip] // one entry a line, so that branches that add some do not meet
pub const EXPORTS: &[ExportEntry] = &[
    report::ENTRY,
    ExportEntry::of::<Mesh>("mesh", &["glb"], "the ground and its water as meshes of triangles, true to a stated error, with textures; x east, y up, z south, from the middle of the landscape", "Garland and Heckbert 1995 (triangles), Mikkelsen 2008 (tangents), glTF 2.0"),
    ExportEntry::of::<RiverLines>("rivers", &["geojson", "json"], "rivers as lines with width, depth, discharge and order, in the CRS, or in metres east and north of the south-western corner", "Weald; RFC 7946"),
    ExportEntry::of::<LakeAreas>("lakes", &["geojson", "json"], "lakes as areas with level, depth and volume, placed as those of `rivers`", "Weald; RFC 7946"),
    ExportEntry::of::<Layers>("layers", layers::EXTENSIONS, "several layers in one file: NetCDF or Zarr", "CF conventions 1.11, Zarr 3.0"),
    ExportEntry::of::<Points>("points", points::EXTENSIONS, "the points of a fractal with their codes", "Barnsley 1988; PLY 1.0, NumPy's NEP 1"),
    ExportEntry::of::<PlantSet>("plants", &["glb", "csv", "geojson", "ply"], "plants with their places, leaning, sizes and phases in the wind: as instances of a mesh, placed as `mesh` is (.glb), a table or points of a map, placed as `rivers` are (.csv, .geojson), or a cloud of points from the middle, x east, y north, z up (.ply)", "glTF 2.0 with EXT_mesh_gpu_instancing; RFC 4180; RFC 7946; Turk 1994, The PLY polygon file format"),
    ExportEntry::of::<GrassSets>("grass", &["glb"], "grass as instances of a tuft of each species, with the soil, light and wind of each, placed as `mesh` is", "glTF 2.0 with EXT_mesh_gpu_instancing"),
    unreal::ENTRY,
    unity::ENTRY,
    terrain3d::ENTRY,
];

/// The export of that name.
pub fn find(name: &str) -> Option<&'static ExportEntry> {
    EXPORTS.iter().find(|entry| entry.name == name)
}
