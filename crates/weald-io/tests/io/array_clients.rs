//! Real clients open files of arrays: GDAL the `NetCDF`, xarray, `netCDF4` and zarr-python both; and Weald reads
//! what they write.
//!
//! GDAL comes from the Debian package `gdal-bin`, the Python packages from `clients/install arrays`. A test fails
//! where one is missing, because a skipped proof proves nothing.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::rasters::{at, hills, written};
use serde_json::{Value, json};
use weald_core::grid::{Field, Mask, Size};
use weald_io::{Class, Classes, Raster};

/// Standard output of a program that must be there and succeed.
fn output(program: &Path, remedy: &str, arguments: &[&str]) -> Vec<u8> {
    let run = Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", "NO").output();
    let output = run.unwrap_or_else(|cause| {
        panic!("{} does not start ({cause}); install it: {remedy}", program.display())
    });
    let message = String::from_utf8_lossy(&output.stderr);
    let is_well = output.status.success() && !["ERROR", "Warning"].iter().any(|word| message.contains(word));
    assert!(is_well, "{} {arguments:?}: {message}", program.display());
    output.stdout
}

fn gdal(program: &str, arguments: &[&str]) -> Vec<u8> {
    output(Path::new(program), "apt-get install gdal-bin", arguments)
}

/// What a Python script with xarray, `netCDF4` and zarr prints as JSON.
fn python(script: &str, arguments: &[&str]) -> Value {
    let clients = std::env::var_os("WEALD_CLIENTS").map(PathBuf::from);
    let usual = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/clients");
    let python = clients.unwrap_or_else(usual).join("arrays/bin/python");
    let script = format!("import json, sys, numpy, netCDF4, xarray, zarr\npath = sys.argv[1]\n{script}");
    let all: Vec<&str> = ["-c", &script].into_iter().chain(arguments.iter().copied()).collect();
    let printed = output(&python, "clients/install arrays", &all);
    if printed.is_empty() { Value::Null } else { serde_json::from_slice(&printed).expect("JSON") }
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("a temporary folder has a plain name")
}

/// What a client must find: the value, or NaN for no-data.
fn assert_values(raster: &Raster, bytes: &[u8]) {
    let found = bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    assert_eq!(found.len(), raster.field.size().cells());
    for (index, found) in found.enumerate() {
        let is_valid = raster.valid.as_ref().is_none_or(|valid| valid.is_valid_at(index));
        let expected = raster.field.values()[index];
        assert!(
            if is_valid { found == expected } else { found.is_nan() },
            "cell {index}: {found} for {expected}"
        );
    }
}

fn gdalinfo(path: &Path) -> Value {
    serde_json::from_slice(&gdal("gdalinfo", &["-json", shown(path)])).expect("gdalinfo writes JSON")
}

#[test]
fn xarray_finds_classes_as_whole_numbers_with_their_meanings_and_no_data() {
    let size = Size { columns: 4, rows: 3 };
    let class = |number: u32, name: &str| Class { number, name: name.to_owned(), colour: [9, 9, 9] };
    let classes = Some(Classes { named: vec![class(0, "no lake"), class(7, "lake 7")], greatest: 7 });
    let valid = Mask::new(size, (0..12).map(|cell| cell != 5).collect());
    let field = Field::from_function(size, |x, y| if (x, y) == (3, 2) { 7.0 } else { 0.0 });
    let raster = Raster { classes, valid, cell: Some(5.0), ..Raster::from(field) };
    for name in ["lake.nc", "lake.zarr"] {
        let (_folder, path) = written(&raster, name);
        let script = "lake = xarray.open_dataset(path, engine='zarr' if path.endswith('zarr') else None)['layer']\n\
                      print(json.dumps([str(lake.encoding['dtype']), [int(v) for v in lake.attrs['flag_values']], \
                      lake.attrs['flag_meanings'], bool(numpy.isnan(lake.values[1, 1])), float(lake.values[2, 3]), \
                      int(numpy.isnan(lake.values).sum())]))";
        let found = python(script, &[shown(&path)]);
        assert_eq!(found, json!(["int32", [0, 7], "no_lake lake_7", true, 7.0, 1]), "{name}");
    }
}

#[test]
fn gdal_reads_every_cell_and_the_place_of_a_netcdf_file() {
    let raster = hills();
    let (_folder, path) = written(&raster, "height.nc");
    let info = gdalinfo(&path);
    assert_eq!(info["geoTransform"], json!([730_900.75, 80.0, 0.0, 4_069_271.25, 0.0, -80.0]));
    assert_eq!(info["size"], json!([300, 270]));
    let wkt = info["coordinateSystem"]["wkt"].as_str().expect("a CRS");
    assert!(wkt.contains("UTM zone 16N") && wkt.contains("ID[\"EPSG\",32616]]"), "{wkt}");
    let band = &info["bands"][0];
    assert_eq!(
        (&band["type"], &band["unit"], &band["noDataValue"]),
        (&json!("Float32"), &json!("m"), &json!("NaN"))
    );
    assert_eq!(info["metadata"][""]["NC_GLOBAL#WEALD_SEED"], "7");
    assert_eq!(info["metadata"][""]["height#standard_name"], "surface_altitude");
    let raw = path.with_extension("raw");
    gdal("gdal_translate", &["-q", "-of", "ENVI", shown(&path), shown(&raw)]);
    assert_values(&raster, &std::fs::read(raw).expect("gdal_translate wrote it"));
}

/// Grids that CF spells out and grids that it cannot.
#[test]
fn gdal_finds_the_crs_of_any_code_in_a_netcdf_file() {
    let field = || Field::from_function(Size { columns: 4, rows: 3 }, |x, y| (x + 10 * y) as f32);
    for (code, origin, pixel, name) in [
        (4326, [-84.5, 36.75], [0.01, 0.01], "WGS 84"),
        (2154, [700_000.0, 6_600_000.0], [5.0, 5.0], "RGF93"),
        (3035, [4_321_000.0, 3_210_000.0], [25.0, 25.0], "ETRS89"),
        (5070, [-96_000.0, 1_500_000.0], [30.0, 30.0], "NAD83"),
        (2056, [2_600_000.0, 1_200_000.0], [0.5, 0.5], "CH1903+ / LV95"),
        (3857, [1e6, 6e6], [10.0, 10.0], "Pseudo-Mercator"),
        (27700, [400_000.0, 200_000.0], [50.0, 50.0], "British National Grid"),
        (3413, [-1e5, -2e6], [100.0, 100.0], "Polar Stereographic North"),
    ] {
        let (_folder, path) = written(&at(code, origin, pixel, field()), "height.nc");
        let info = gdalinfo(&path);
        let wkt = info["coordinateSystem"]["wkt"].as_str().unwrap_or_default();
        assert!(wkt.contains(&format!("ID[\"EPSG\",{code}]]")) && wkt.contains(name), "{code}: {wkt}");
        let transform = json!([origin[0], pixel[0], 0.0, origin[1], 0.0, -pixel[1]]);
        assert_eq!(info["geoTransform"], transform, "{code}");
    }
}

#[test]
fn gdal_finds_the_cell_size_of_a_ground_without_a_place() {
    let raster = Raster { georeference: None, valid: None, cell: Some(20.0), ..hills() };
    let (_folder, path) = written(&raster, "height.nc");
    let info = gdalinfo(&path);
    assert_eq!(info["geoTransform"], json!([0.0, 20.0, 0.0, 5400.0, 0.0, -20.0]));
    assert_eq!(info["coordinateSystem"], Value::Null);
}

/// What xarray says of a file, after its heights went to a raw file.
const SUMMARY: &str = "
with xarray.open_dataset(path, engine=sys.argv[2], decode_coords='all') as data:
    height = data[sys.argv[3]]
    height.values.astype('<f4').tofile(path + '.raw')
    print(json.dumps({
        'dims': height.dims, 'shape': height.shape, 'dtype': str(height.dtype),
        'x': [float(data.x[0]), float(data.x[-1])], 'y': [float(data.y[0]), float(data.y[-1])],
        'units': height.attrs['units'], 'landlab': height.attrs['landlab_name'],
        'crs': data.spatial_ref.attrs['epsg_code'], 'axis': data.x.attrs['standard_name'],
        'seed': data.attrs['WEALD_SEED'], 'conventions': data.attrs['Conventions'],
        'arrays': sorted(data.data_vars), 'north': float(height.sel(y=data.y.max()).mean()),
    }))";

#[test]
fn xarray_reads_every_cell_and_the_place_of_both_formats() {
    let raster = hills();
    let north = raster.field.row(0).iter().map(|value| f64::from(*value)).sum::<f64>() / 300.0;
    for (name, engine) in [("height.nc", "netcdf4"), ("height.zarr", "zarr")] {
        let (_folder, path) = written(&raster, name);
        let found = python(SUMMARY, &[shown(&path), engine, "height"]);
        assert_eq!((&found["dims"], &found["shape"]), (&json!(["y", "x"]), &json!([270, 300])), "{name}");
        assert_eq!(found["x"], json!([730_940.75, 754_860.75]));
        assert_eq!(found["y"], json!([4_069_231.25, 4_047_711.25]));
        let texts =
            ["dtype", "units", "landlab", "crs", "axis", "seed", "conventions"].map(|key| &found[key]);
        let expected = [
            "float32",
            "m",
            "topographic__elevation",
            "EPSG:32616",
            "projection_x_coordinate",
            "7",
            "CF-1.11",
        ];
        assert_eq!(texts, expected, "{name}");
        assert_eq!(found["arrays"], json!(["height"]));
        assert!((found["north"].as_f64().expect("a mean") - north).abs() < 1e-3, "{name}: row 0 is north");
        let raw = std::fs::read(path.with_file_name(format!("{name}.raw"))).expect("xarray wrote it");
        assert_values(&raster, &raw);
    }
}

#[test]
fn xarray_and_gdal_place_the_rows_that_landlab_wants_first_in_the_south() {
    let raster = hills();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("height.nc");
    let (encode, _) =
        weald_io::format_of(&path).and_then(|format| format.writing(Some("landlab"))).expect("a preset");
    weald_io::write_parts(&path, &encode.parts(&raster).expect("finite")).expect("written");
    let found = python(SUMMARY, &[shown(&path), "netcdf4", "topographic__elevation"]);
    assert_eq!(found["y"], json!([4_047_711.25, 4_069_231.25]));
    let north = raster.field.row(0).iter().map(|value| f64::from(*value)).sum::<f64>() / 300.0;
    assert!((found["north"].as_f64().expect("a mean") - north).abs() < 1e-3, "row 0 is north");
    let raw = path.with_extension("gdal");
    gdal("gdal_translate", &["-q", "-of", "ENVI", shown(&path), shown(&raw)]);
    assert_values(&raster, &std::fs::read(raw).expect("gdal_translate wrote it"));
    assert_eq!(gdalinfo(&path)["geoTransform"], json!([730_900.75, 80.0, 0.0, 4_069_271.25, 0.0, -80.0]));
}

#[test]
fn zarr_python_reads_the_group_and_its_chunks() {
    let (_folder, path) = written(&hills(), "height.zarr");
    let script = "
group = zarr.open_group(path, mode='r')
height = group['height']
print(json.dumps({
    'format': group.metadata.zarr_format, 'members': sorted(name for name, _ in group.members()),
    'chunks': height.chunks, 'names': height.metadata.dimension_names, 'fill': str(height.fill_value),
    'chunks_on_disk': height.nchunks_initialized, 'corner': float(height[0, 0]),
    'listed': sorted(group.metadata.consolidated_metadata.metadata), 'scalar': int(group['spatial_ref'][()]),
}))";
    let found = python(script, &[shown(&path)]);
    assert_eq!(
        (&found["format"], &found["chunks"], &found["names"]),
        (&json!(3), &json!([256, 256]), &json!(["y", "x"]))
    );
    let members = json!(["height", "spatial_ref", "x", "y"]);
    assert_eq!((&found["members"], &found["listed"]), (&members, &members));
    assert_eq!(
        (&found["fill"], &found["chunks_on_disk"], &found["scalar"]),
        (&json!("nan"), &json!(4), &json!(0))
    );
    assert_eq!(found["corner"], 200.0);
}

/// A grid of three shards of several chunks, some of them without data.
#[test]
fn xarray_and_zarr_python_read_every_cell_of_shards() {
    let size = Size { columns: 900, rows: 600 };
    let valid = Mask::new(size, (0..size.cells()).map(|cell| cell % 900 > 300 || cell / 900 > 300).collect());
    let value =
        |x: usize, y: usize| if x > 300 || y > 300 { (x * 3) as f32 - (y * y) as f32 / 7.0 } else { 0.0 };
    let raster = Raster { valid, cell: Some(5.0), ..Raster::from(Field::from_function(size, value)) };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("height.zarr");
    let format = weald_io::format_of(&path).expect("Zarr");
    let (encode, _) = format.writing(Some("sharded")).expect("a preset");
    weald_io::write_parts(&path, &encode.parts(&raster).expect("finite")).expect("written");
    let raw = folder.path().join("raw");
    let script = "
layer = zarr.open_group(path, mode='r')['layer']
values = xarray.open_dataset(path, engine='zarr')['layer'].values
assert numpy.array_equal(values, layer[:], equal_nan=True)
values.astype('<f4').tofile(sys.argv[2])
print(json.dumps([layer.chunks, layer.shards]))";
    let found = python(script, &[shown(&path), shown(&raw)]);
    assert_eq!(found, json!([[256, 256], [256, 1024]]));
    assert_values(&raster, &std::fs::read(raw).expect("xarray wrote it"));
}

#[test]
fn weald_reads_what_gdal_writes_as_netcdf() {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/jacksboro_fault_utm16_80m.tif");
    let was = weald_io::read(&model).expect("reads");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.nc");
    for (format, bottom_up) in [("NC", "YES"), ("NC", "NO"), ("NC2", "YES")] {
        let options = [format!("FORMAT={format}"), format!("WRITE_BOTTOMUP={bottom_up}")];
        gdal(
            "gdal_translate",
            &["-q", "-of", "netCDF", "-co", &options[0], "-co", &options[1], shown(&model), shown(&path)],
        );
        let is = weald_io::read(&path).expect("reads");
        assert_eq!(
            (&is.field, &is.valid, is.cell),
            (&was.field, &was.valid, was.cell),
            "{format}, {bottom_up}"
        );
        let (is, was) = (is.georeference.expect("placed"), was.georeference.as_ref().expect("placed"));
        assert_eq!(
            (is.epsg, is.origin, is.pixel),
            (was.epsg, was.origin, was.pixel),
            "{format}, {bottom_up}"
        );
    }
}

/// Writes the heights 0, 1, 2 / 10, 11, 12 with the north-western one missing, from south to north.
const DATA: &str = "
import warnings
warnings.simplefilter('ignore')
data = xarray.Dataset({'topographic__elevation': (('time', 'lat', 'lon'), numpy.array([[[10., 11, 12], [numpy.nan, 1, 2]]]))},
    {'lat': numpy.array([46.5, 47.5], 'f4'), 'lon': numpy.array([8.25, 8.75, 9.25], 'f4')})
data['other'] = data.topographic__elevation * 3
data.lat.attrs['units'] = 'degrees_north'
data.lon.attrs['units'] = 'degrees_east'
";

/// That raster as Weald must read it.
fn assert_data(path: &Path, stored: &str, how: &str) {
    let raster = weald_io::read(path).unwrap_or_else(|error| panic!("{how}: {error}"));
    assert_eq!(raster.field.values(), [0.0, 1.0, 2.0, 10.0, 11.0, 12.0], "{how}");
    let valid = raster.valid.expect("one cell is missing");
    assert_eq!(valid.flags(), [false, true, true, true, true, true], "{how}");
    let place = raster.georeference.expect("placed");
    assert!(place.is_geographic(), "{how}");
    assert_eq!((place.origin, place.pixel, raster.cell), ([8.0, 48.0], [0.5, 1.0], None), "{how}");
    assert_eq!(raster.stored, stored, "{how}");
}

#[test]
fn weald_reads_what_xarray_writes_as_netcdf() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = format!(
        "{DATA}
formats = ['NETCDF3_CLASSIC', 'NETCDF3_64BIT', 'NETCDF3_64BIT_DATA']
encodings = {{
    'float64': {{}},
    'float32': {{'dtype': 'f4', '_FillValue': -9999.0}},
    'int16': {{'dtype': 'i2', 'scale_factor': 0.5, 'add_offset': 3.0, '_FillValue': -7}},
    'int8': {{'dtype': 'i1', '_FillValue': -1}},
}}
for format in formats:
    for name, encoding in encodings.items():
        data.to_netcdf(f'{{path}}/{{name}}_{{format}}.nc', engine='netcdf4', format=format, unlimited_dims=['time'],
            encoding={{'topographic__elevation': encoding}})
print(json.dumps([[name, f'{{name}}_{{format}}.nc'] for format in formats for name in encodings]))"
    );
    assert_files(folder.path(), &script, 12);
}

#[test]
fn weald_reads_what_xarray_writes_as_zarr() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = format!(
        "{DATA}
encodings = [
    ('float64', {{}}),
    ('float32', {{'dtype': 'f4', '_FillValue': -9999.0, 'compressors': None}}),
    ('float64', {{'chunks': (1, 1, 2), 'compressors': [zarr.codecs.GzipCodec(), zarr.codecs.Crc32cCodec()]}}),
    ('float64', {{'chunks': (1, 2, 2), 'serializer': zarr.codecs.BytesCodec(endian='big')}}),
    ('int16', {{'dtype': 'i2', 'scale_factor': 0.5, 'add_offset': 3.0, '_FillValue': -7}}),
]
files = []
for consolidated in [True, False]:
    for name, encoding in encodings:
        files.append([name, f'{{len(files)}}_{{name}}.zarr'])
        data.to_zarr(f'{{path}}/{{files[-1][1]}}', zarr_format=3, consolidated=consolidated,
            encoding={{'topographic__elevation': encoding}})
print(json.dumps(files))"
    );
    assert_files(folder.path(), &script, 10);
}

/// Each file that a script wrote and printed, behind the type of its numbers, holds the raster of [`DATA`].
fn assert_files(folder: &Path, script: &str, count: usize) {
    let printed = python(script, &[shown(folder)]);
    let files: Vec<[String; 2]> = serde_json::from_value(printed).expect("pairs of type and name");
    assert_eq!(files.len(), count);
    for [stored, name] in files {
        assert_data(&folder.join(&name), &stored, &name);
    }
}

/// Files that are not read, and what is said of them.
const REFUSED: [(&str, &str); 5] = [
    ("four.nc", "nccopy -k classic"),
    ("nameless.nc", "one, other"),
    ("deep.nc", "ds.isel(time=0)"),
    ("uneven.nc", "coordinate 1 of `lon`"),
    ("west.nc", "ds.sortby('lon')"),
];

#[test]
fn what_xarray_writes_in_another_way_is_refused_with_a_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = format!(
        "{DATA}
data.to_netcdf(path + '/four.nc', engine='netcdf4')
for name, other in {{
    'nameless': data.rename(topographic__elevation='one'),
    'deep': xarray.concat([data, data], 'time'),
    'uneven': data.assign_coords(lon=('lon', [8.0, 8.5, 9.5])),
    'west': data.isel(lon=slice(None, None, -1)),
}}.items():
    other.to_netcdf(f'{{path}}/{{name}}.nc', engine='netcdf4', format='NETCDF3_CLASSIC')"
    );
    python(&script, &[shown(folder.path())]);
    for (name, remedy) in REFUSED {
        let diagnostic = weald_io::read(&folder.path().join(name)).expect_err(name).to_string();
        assert!(diagnostic.contains(remedy), "{name}: {diagnostic}");
    }
}

/// The place follows the coordinates, and not the numbers beside them that still tell of the whole.
#[test]
fn a_part_that_xarray_cut_out_of_a_file_lies_where_it_lay() {
    let raster = hills();
    let (folder, path) = written(&raster, "height.nc");
    let part = folder.path().join("part.nc");
    let script = "
with xarray.open_dataset(path) as data:
    data.isel(x=slice(10, 40), y=slice(20, 60)).to_netcdf(sys.argv[2], engine='netcdf4', format='NETCDF3_CLASSIC')";
    python(script, &[shown(&path), shown(&part)]);
    let cut = weald_io::read(&part).expect("reads");
    assert_eq!(cut.field.size(), Size { columns: 30, rows: 40 });
    assert_eq!(cut.field.at(0, 0), raster.field.at(10, 20));
    let place = cut.georeference.expect("placed");
    assert_eq!((place.epsg, place.origin, place.pixel), (Some(32616), [731_700.75, 4_067_671.25], [80.0; 2]));
    assert_eq!(cut.cell, Some(80.0));
}
