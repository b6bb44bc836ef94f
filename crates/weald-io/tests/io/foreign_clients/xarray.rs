//! Files that xarray writes, as `NetCDF` and as Zarr.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::{Foreign, Theirs, Verdict, judge};

/// Writes every file, and beside it what xarray reads of it: 64-bit floats from north to south, NaN without data. Prints
/// a list of the group, the name, the metres in a unit, the words of a refusal, and the cells that the specification of
/// the format leaves without data, where xarray does not.
const SCRIPT: &str = r#"
import json, os, sys, warnings, numpy, numcodecs, xarray, zarr
warnings.simplefilter('ignore')
folder, files = sys.argv[1], []
random = numpy.random.default_rng(7)
whole = random.integers(0, 100, (23, 37))

def dataset(values=whole, north_first=True, cell=80.0, west=7e5, south=4e6, names=('y', 'x'), **attributes):
    y = south + cell * (numpy.arange(23) + 0.5)
    x = west + cell * (numpy.arange(37) + 0.5)
    data = xarray.Dataset({'height': (names, values, attributes)},
        {names[0]: y[::-1] if north_first else y, names[1]: x})
    if names[0] in ('y', 'lat'):
        unit = ('degrees_north', 'degrees_east') if names[0] == 'lat' else ('m', 'm')
        data[names[0]].attrs['units'], data[names[1]].attrs['units'] = unit
    return data

def note(group, name, label, metres=1.0, refused=None, nothing=None, engine=None):
    if refused is None:
        with xarray.open_dataset(f'{folder}/{name}', engine=engine) as read:
            height = read['height'].squeeze().astype('f8')
            rows = height.dims[0]
            if rows in read.coords and read[rows][0] < read[rows][-1]:
                height = height[::-1]
            height.values.tofile(f'{folder}/{name}.f64')
    files.append([group, name, label, metres, refused, nothing])

def netcdf(label, data, encoding={}, kind='NETCDF3_CLASSIC', **more):
    name = f'{len(files)}.nc'
    data.to_netcdf(f'{folder}/{name}', engine='netcdf4', format=kind, encoding={'height': encoding})
    note('NetCDF of xarray', name, f'{kind} {label}', engine='netcdf4', **more)

def zarray(label, data, encoding={}, version=3, **more):
    name = f'{len(files)}.zarr'
    data.to_zarr(f'{folder}/{name}', zarr_format=version, encoding={'height': encoding})
    note(f'Zarr version {version} of xarray', name, label, engine='zarr', **more)

holes = numpy.where(whole % 17 == 0, numpy.nan, whole.astype('f8'))
packed = {'scale_factor': 0.5, 'add_offset': 3.0, '_FillValue': -7}
for kind in ['NETCDF3_CLASSIC', 'NETCDF3_64BIT', 'NETCDF3_64BIT_DATA']:
    types = ['i1', 'i2', 'i4', 'f4', 'f8'] + (['u1', 'u2', 'u4', 'i8', 'u8'] if kind.endswith('DATA') else [])
    for dtype in types:
        netcdf(f'{dtype}', dataset(whole.astype(dtype)), {'dtype': dtype, '_FillValue': None}, kind)
        if dtype[0] != 'u':
            netcdf(f'{dtype} packed', dataset(holes / 2 + 3), dict(packed, dtype=dtype, _FillValue=-7), kind)
    netcdf('f4, rows from the south', dataset(north_first=False), {'dtype': 'f4'}, kind)
    netcdf('unsigned bytes', dataset(numpy.where(whole == 10, numpy.nan, whole + 120.)),
        {'dtype': 'i1', '_Unsigned': 'true', '_FillValue': -126}, kind)
    netcdf('fill and missing value', dataset(holes), {'dtype': 'f4', '_FillValue': -1.0, 'missing_value': -1.0}, kind)
for unit, metres in [('m', 1), ('feet', .3048), ('ft', .3048), ('US_survey_foot', 1200 / 3937), ('km', 1000),
                     ('cm', .01), ('0.1 m', .1), ('K', 1), ('1', 1)]:
    netcdf(f'heights in {unit}', dataset(holes, units=unit), {'dtype': 'f4'}, metres=metres)
    zarray(f'heights in {unit}', dataset(holes, units=unit), {'dtype': 'f4'}, metres=metres)
low = numpy.flatnonzero(whole.ravel() < 20).tolist()
outer = numpy.flatnonzero((whole.ravel() < 20) | (whole.ravel() > 90)).tolist()
for write in [netcdf, zarray]:
    i2 = {'dtype': 'i2', '_FillValue': None}
    write('valid_min', dataset(whole.astype('i2'), valid_min=numpy.int16(20)), i2, nothing=low)
    write('valid_range', dataset(whole.astype('i2'), valid_range=numpy.array([20, 90], 'i2')), i2, nothing=outer)
    write('valid_range of floats', dataset(whole.astype('f4'), valid_range=numpy.array([20, 90], 'f4')), nothing=outer)
    write('valid_range, packed', dataset(whole * .5 + 3, valid_range=numpy.array([20, 90], 'i2')),
        dict(packed, dtype='i2'), nothing=outer)
    write('valid_range, unpacked', dataset(whole * .5 + 3, valid_range=numpy.array([13., 48.])),
        dict(packed, dtype='i2'), nothing=outer)
    write('depths', dataset(positive='down'), refused='holds depths')
    write('columns first', dataset(whole.T.copy().T, names=('lon', 'lat')).assign_coords(
        lon=numpy.arange(23.), lat=numpy.arange(37.)), refused='transpose')
    write('degrees', dataset(cell=.001, west=8, south=46, names=('lat', 'lon')))
    for wkt, words in [('GEOCCS["c",UNIT["metre",1]]', 'geocentric'),
                       ('GEOGCS["g",UNIT["grad",0.015707963267949]]', 'not in degrees')]:
        other = dataset(grid_mapping='crs')
        other['crs'] = xarray.DataArray(0, attrs={'crs_wkt': wkt})
        write(words, other, refused=words)
    mixed = dataset(cell=.001, west=8, south=46, grid_mapping='crs', names=('lat', 'lon'))
    mixed['crs'] = xarray.DataArray(0, attrs={'crs_wkt': 'PROJCS["p",UNIT["metre",1]]'})
    write('degrees in a projected CRS', mixed, refused='counts in a unit of length')
netcdf('NetCDF-4', dataset(), {}, 'NETCDF4', refused='nccopy -k classic')

f4 = {'dtype': 'f4', 'chunks': (10, 16)}
for name, compressors in {'none': None, 'gzip': zarr.codecs.GzipCodec(), 'zstd': zarr.codecs.ZstdCodec(),
                          'sum': [zarr.codecs.ZstdCodec(), zarr.codecs.Crc32cCodec()]}.items():
    for dtype in ['i1', 'u1', 'i2', 'u2', 'i4', 'u4', 'f4', 'f8']:
        zarray(f'{name} {dtype}', dataset(whole.astype(dtype)), {'compressors': compressors, 'chunks': (10, 16)})
    zarray(f'{name} packed', dataset(holes / 2 + 3), dict(packed, dtype='i2', compressors=compressors))
zarray('big-endian', dataset(holes), dict(f4, serializer=zarr.codecs.BytesCodec(endian='big')))
for cname in ['lz4', 'lz4hc', 'zlib', 'zstd']:
    for dtype in ['i2', 'f4', 'f8']:
        for size in [None, 4096]:
            codec = zarr.codecs.BloscCodec(cname=cname, shuffle='shuffle')
            big = numpy.tile(whole, (1, 1)) if size is None else whole
            zarray(f'blosc {cname} {dtype}', dataset(big.astype(dtype)), {'compressors': codec, 'chunks': (23, 37)})
            old = numcodecs.Blosc(cname=cname, shuffle=1, blocksize=0 if size is None else 512)
            zarray(f'blosc {cname} {dtype}', dataset(big.astype(dtype)), {'compressors': old}, 2)
zarray('blosc without shuffle', dataset(holes), dict(f4, compressors=zarr.codecs.BloscCodec(shuffle='noshuffle')))
bits = zarr.codecs.BloscCodec(shuffle='bitshuffle')
zarray('blosc with bits', dataset(holes), dict(f4, compressors=bits), refused='bitshuffle')
bare = zarr.codecs.BloscCodec(cname='blosclz', shuffle='shuffle')
zarray('blosclz', dataset(holes), dict(f4, compressors=bare), refused='BloscLZ')
for name, codec in {'none': None, 'zlib': numcodecs.Zlib(), 'gzip': numcodecs.GZip(), 'zstd': numcodecs.Zstd(),
                    'lz4': numcodecs.LZ4()}.items():
    for dtype in ['i1', 'u2', '>i2', 'f4', 'f8', '>f8']:
        zarray(f'{name} {dtype}', dataset(whole.astype(dtype)), {'compressors': codec, 'chunks': (10, 16)}, 2)
    zarray(f'{name} packed', dataset(holes / 2 + 3), dict(packed, dtype='i2', compressors=codec), 2)
    zarray(f'{name} holes', dataset(holes), {'dtype': 'f4', 'compressors': codec, '_FillValue': -9.0}, 2)
zarray('degrees', dataset(cell=.001, west=8, south=46, names=('lat', 'lon')), {}, 2)
zarray('feet', dataset(holes, units='feet'), {}, 2, metres=.3048)
zarray('bz2', dataset(), {'compressors': numcodecs.BZ2()}, 2, refused='codec `bz2`')
zarray('delta', dataset(whole.astype('i4')), {'filters': [numcodecs.Delta('i4')]}, 2, refused='codec `delta`')
for name, compressors in {'none': None, 'zstd': zarr.codecs.ZstdCodec(), 'gzip': zarr.codecs.GzipCodec()}.items():
    for dtype in ['i2', 'f4', 'f8']:
        for shards in [(20, 32), (30, 48), (10, 16)]:
            zarray(f'shards, {name} {dtype}', dataset(whole.astype(dtype)),
                {'dtype': dtype, 'chunks': (10, 16), 'shards': shards, 'compressors': compressors})
zarray('shards with holes', dataset(holes), dict(f4, shards=(20, 32)))
turn = zarr.codecs.TransposeCodec(order=(1, 0))
zarray('columns first', dataset(holes), dict(f4, filters=[turn]))
zarray('columns first, in shards', dataset(holes), dict(f4, shards=(20, 32), filters=[turn]))
far = numpy.where(numpy.arange(37) < 16, holes, numpy.nan)
zarray('shards without some chunks', dataset(far), dict(f4, shards=(20, 48), _FillValue=numpy.nan))
print(json.dumps(files))
"#;

/// The files that the script lists.
fn files(folder: &Path) -> Vec<Foreign> {
    let clients = std::env::var_os("WEALD_CLIENTS").map(PathBuf::from);
    let usual = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/clients");
    let python = clients.unwrap_or_else(usual).join("arrays/bin/python");
    let run = Command::new(&python).args(["-c", SCRIPT]).arg(folder).output();
    let output = run.unwrap_or_else(|cause| {
        panic!("{} does not start ({cause}); install it: clients/install arrays", python.display())
    });
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let listed: Vec<Value> = serde_json::from_slice(&output.stdout).expect("a list");
    listed.iter().map(|file| file_of(folder, file)).collect()
}

fn file_of(folder: &Path, listed: &Value) -> Foreign {
    let text = |at: usize| listed[at].as_str().expect("a text").to_owned();
    let nothing: Option<Vec<usize>> = serde_json::from_value(listed[5].clone()).expect("cells");
    let verdict = match (listed[4].as_str(), nothing) {
        (Some(words), _) => Verdict::Refused(words.to_owned()),
        (None, Some(cells)) => Verdict::NoDataAt(cells),
        (None, None) => Verdict::Same,
    };
    Foreign {
        group: text(0),
        path: folder.join(text(1)),
        name: text(2),
        metres: listed[3].as_f64().expect("a number"),
        verdict,
    }
}

fn theirs(path: &Path) -> Result<Theirs, String> {
    let raw = path
        .with_extension(format!("{}.f64", path.extension().and_then(|it| it.to_str()).unwrap_or_default()));
    let bytes = std::fs::read(raw).map_err(|cause| cause.to_string())?;
    let eight = bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().expect("eight")));
    Ok(Theirs(eight.collect()))
}

#[test]
fn files_of_xarray_are_read_as_xarray_reads_them_or_refused_with_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = files(folder.path());
    let faults: Vec<String> = files.iter().filter_map(|file| file.fault(&theirs(&file.path))).collect();
    judge(&files, &faults);
}
