//! Files that the drivers of GDAL write.

use std::path::Path;
use std::process::Command;

use rayon::prelude::*;

use super::{Foreign, Theirs, Verdict, judge};

/// Cells of the sources.
const SIDES: [usize; 2] = [37, 23];

/// What `gdal_translate` is told: the group and name of the file, the source, the extension and the options.
#[derive(Clone)]
struct Recipe {
    group: &'static str,
    name: String,
    source: &'static str,
    extension: &'static str,
    options: Vec<String>,
    metres: f64,
    verdict: Verdict,
}

fn recipe(group: &'static str, source: &'static str, extension: &'static str, options: &str) -> Recipe {
    let words = options.split(' ').filter(|word| !word.is_empty()).map(str::to_owned).collect();
    Recipe {
        group,
        name: format!("{source} {options}"),
        source,
        extension,
        options: words,
        metres: 1.0,
        verdict: Verdict::Same,
    }
}

impl Recipe {
    fn in_metres(self, metres: f64) -> Self {
        Self { metres, ..self }
    }

    fn refused(self, words: &'static str) -> Self {
        Self { verdict: Verdict::Refused(words.to_owned()), ..self }
    }
}

/// The group of files without scale and offset.
const STORAGE: &str = "GeoTIFF, storage";

const SURVEY_FOOT: f64 = 1200.0 / 3937.0;
const TYPES: [&str; 7] = ["Byte", "UInt16", "Int16", "UInt32", "Int32", "Float32", "Float64"];
const TILES: &str = "-co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=16";

/// Every way to store numbers in a TIFF.
fn storage() -> Vec<Recipe> {
    let mut recipes = Vec::new();
    let mut add = |options: String| recipes.push(recipe(STORAGE, "plain", "tif", &options));
    for kind in TYPES {
        for compression in ["NONE", "LZW", "DEFLATE", "PACKBITS", "ZSTD"] {
            add(format!("-ot {kind} -co COMPRESS={compression} -co BLOCKYSIZE=5"));
            add(format!("-ot {kind} -co COMPRESS={compression} {TILES}"));
        }
        for compression in ["LZW", "ZSTD"] {
            add(format!("-ot {kind} -co COMPRESS={compression} -co PREDICTOR=2 {TILES}"));
        }
        add(format!("-ot {kind} -co ENDIANNESS=BIG -co COMPRESS=DEFLATE -co PREDICTOR=2"));
        add(format!("-ot {kind} -co ENDIANNESS=BIG -co BIGTIFF=YES"));
    }
    for kind in ["Float32", "Float64"] {
        add(format!("-ot {kind} -co COMPRESS=ZSTD -co PREDICTOR=3"));
        add(format!("-ot {kind} -co COMPRESS=DEFLATE -co PREDICTOR=3 {TILES}"));
    }
    for bits in 1..8 {
        add(format!("-ot Byte -scale 200 1100 0 {} -co NBITS={bits} -co COMPRESS=LZW", (1 << bits) - 1));
    }
    for bits in 9..16 {
        add(format!("-ot UInt16 -scale 200 1100 0 {} -co NBITS={bits} {TILES}", (1_u32 << bits) - 1));
    }
    for bits in [17, 20, 31] {
        add(format!("-ot UInt32 -scale 200 1100 0 65535 -co NBITS={bits} -co COMPRESS=DEFLATE"));
        add(format!("-ot UInt32 -scale 200 1100 0 65535 -co NBITS={bits} -co ENDIANNESS=BIG"));
    }
    add("-ot Float32 -co NBITS=16".to_owned());
    add("-ot Float32 -co NBITS=16 -co COMPRESS=DEFLATE -co PREDICTOR=3".to_owned());
    add("-ot Byte -scale 200 1100 0 127 -co PIXELTYPE=SIGNEDBYTE".to_owned());
    add(format!("-co SPARSE_OK=TRUE {TILES} -a_nodata 0"));
    recipes
}

/// Kinds of TIFF that are refused, each with its reason.
fn refused() -> Vec<Recipe> {
    let group = "GeoTIFF, other kinds";
    let of = |options: &str, words| recipe(group, "plain", "tif", options).refused(words);
    vec![
        of("-co COMPRESS=LZMA", "compression 34925"),
        of("-co COMPRESS=LERC", "compression 34887"),
        of("-ot Byte -co COMPRESS=JPEG", "compression 7"),
        of("-b 1 -b 1", "2 bands"),
        of("-ot CInt16", "sample format 5"),
        of("-ot CFloat32", "sample format 6"),
        of("-ot UInt32 -scale 200 1100 0 65535 -co NBITS=24", "24 bits in sample format 1"),
        recipe(group, "palette", "tif", "").refused("table of colours"),
        recipe(group, "palette", "png", "").refused("Indexed"),
        recipe(group, "turned", "tif", "").refused("rotated or sheared"),
        of("-a_srs EPSG:4978", "geocentric"),
        of("-a_srs EPSG:4807", "not in degrees"),
        of("-mask 1 --config GDAL_TIFF_INTERNAL_MASK YES", "mask of their own"),
    ]
}

/// No-data, scales, offsets, units and places.
fn meaning() -> Vec<Recipe> {
    let group = "GeoTIFF, meaning";
    let mut recipes = Vec::new();
    for kind in ["UInt16", "Int16", "Int32", "Float32", "Float64"] {
        let of = |options: &str| recipe(group, "land", "tif", &format!("-ot {kind} {options}"));
        recipes.push(of("-a_scale 0.1 -a_offset 1000"));
        recipes.push(of("-a_scale -2 -co COMPRESS=DEFLATE"));
        recipes.push(of("-a_srs EPSG:32616+6360").in_metres(SURVEY_FOOT));
        recipes.push(of("-a_scale 0.5 -a_srs EPSG:32616+8228").in_metres(0.3048));
        recipes.push(of("-a_nodata 500"));
    }
    for code in ["32616+5703", "8712", "6318", "4326+5773", "4267", "2264", "27700", "3857", "4979"] {
        let metres = if code == "8712" { SURVEY_FOOT } else { 1.0 };
        recipes.push(recipe(group, "land", "tif", &format!("-a_srs EPSG:{code}")).in_metres(metres));
    }
    for (source, metres) in
        [("feet", 0.3048), ("survey", SURVEY_FOOT), ("kilometres", 1000.0), ("kelvin", 1.0)]
    {
        recipes.push(recipe(group, source, "tif", "-co COMPRESS=LZW").in_metres(metres));
    }
    for options in ["", "-co COMPRESS=DEFLATE", "-ot Int16", "-mo AREA_OR_POINT=Point", TILES] {
        recipes.push(recipe(group, "south", "tif", options));
    }
    for options in ["", "-a_nodata nan", "-ot Float64", "-co COMPRESS=LZW -co PREDICTOR=3"] {
        recipes.push(recipe(group, "nan", "tif", options));
    }
    recipes
}

/// The other formats that GDAL writes and Weald reads.
fn others() -> Vec<Recipe> {
    let mut recipes = Vec::new();
    for kind in ["Byte", "Int16", "Int32", "Float32"] {
        for source in ["plain", "land"] {
            for options in ["", "-co FORCE_CELLSIZE=YES", "-co DECIMAL_PRECISION=2", "-a_srs EPSG:2264"] {
                let options = format!("-of AAIGrid -ot {kind} {options}");
                recipes.push(recipe("ASCII grid", source, "asc", &options));
            }
        }
    }
    let unmarked = recipe("ASCII grid", "marked", "asc", "-of AAIGrid -ot Int16");
    recipes.push(Recipe { verdict: Verdict::NoDataAt(vec![0, 40]), ..unmarked });
    for format in ["NC", "NC2"] {
        for kind in ["Byte", "Int16", "Int32", "Float32", "Float64"] {
            for options in ["", "-a_scale 0.1 -a_offset 1000", "-co WRITE_BOTTOMUP=NO -a_srs EPSG:4326"] {
                let source = if options.contains("4326") { "degrees" } else { "land" };
                let options = format!("-of netCDF -co FORMAT={format} -ot {kind} {options}");
                recipes.push(recipe("NetCDF of GDAL", source, "nc", &options));
            }
        }
    }
    for kind in ["UInt32", "Float32", "Float64"] {
        recipes.push(recipe(STORAGE, "large", "tif", &format!("-ot {kind} -co COMPRESS=LZW")));
    }
    for options in ["-of AAIGrid", "-of netCDF", "-of netCDF -co WRITE_BOTTOMUP=NO", "-of GTiff"] {
        let extension = if options.contains("net") {
            "nc"
        } else if options.contains("AAI") {
            "asc"
        } else {
            "tif"
        };
        recipes.push(recipe("degrees", "degrees", extension, options));
    }
    for kind in ["Byte", "Int16", "UInt16", "Float32", "Float64"] {
        for compression in
            ["NONE", "ZLIB", "GZIP", "ZSTD", "LZ4", "BLOSC -co BLOSC_CNAME=lz4 -co BLOSC_SHUFFLE=BYTE"]
        {
            let options = format!("-of Zarr -ot {kind} -co BLOCKSIZE=10,16 -co COMPRESS={compression}");
            recipes.push(recipe("Zarr of GDAL", "plain", "zarr", &options));
        }
    }
    for (options, source) in [("-a_nodata 500", "plain"), ("", "degrees"), ("", "south")] {
        recipes.push(recipe("Zarr of GDAL", source, "zarr", &format!("-of Zarr {options}")));
    }
    let draft = recipe("Zarr of GDAL", "plain", "zarr", "-of Zarr -co FORMAT=ZARR_V3");
    recipes.push(draft.refused("zarr_format is"));
    for format in ["NC4", "NC4C"] {
        let options = format!("-of netCDF -co FORMAT={format}");
        recipes.push(recipe("NetCDF of GDAL", "land", "nc", &options).refused("nccopy -k classic"));
    }
    for options in ["-ot Byte", "-ot UInt16", "-ot UInt16 -a_nodata 500", "-ot Byte -co ZLEVEL=9"] {
        recipes.push(recipe("PNG", "plain", "png", &format!("-of PNG {options}")));
    }
    for (options, extension) in
        [("-of PNG -ot UInt16", "png"), ("-of PNG -ot Byte", "png"), ("-of AAIGrid", "asc")]
    {
        for meaning in ["-a_scale 0.1 -a_offset 100", "-a_scale -2", "-a_nodata 255"] {
            let options = format!("{options} {meaning} --config GDAL_PAM_ENABLED YES");
            recipes.push(recipe("with .aux.xml", "plain", extension, &options));
        }
    }
    let feet = "-of PNG -ot UInt16 -a_srs EPSG:32616+6360 --config GDAL_PAM_ENABLED YES";
    recipes.push(recipe("with .aux.xml", "feet", "png", feet).in_metres(0.3048));
    for bits in [1, 2, 4] {
        let options = format!("-of PNG -ot Byte -scale 200 1100 0 1 -co NBITS={bits}");
        recipes.push(recipe("PNG", "plain", "png", &options).refused("bits a channel"));
    }
    for kind in ["UInt16", "Float32"] {
        let options = format!("-of ENVI -ot {kind}");
        recipes.push(recipe("ENVI", "plain", "raw", &options).refused(".hdr"));
    }
    recipes
}

/// A source as GDAL's virtual format describes it: the name, what stands in it, its step to the south, and elements.
const SOURCES: [(&str, Cells, f64, &str); 13] = [
    ("plain", Cells::Land, -80.0, ""),
    ("land", Cells::Holes(-9999.0), -80.0, NO_DATA),
    ("marked", Cells::Holes(-9999.0), -80.0, ""),
    ("nan", Cells::Holes(f32::NAN), -80.0, ""),
    ("large", Cells::Large, -80.0, ""),
    ("south", Cells::Holes(-9999.0), 80.0, NO_DATA),
    ("feet", Cells::Holes(-9999.0), -80.0, "<NoDataValue>-9999</NoDataValue><UnitType>ft</UnitType>"),
    ("survey", Cells::Land, -80.0, "<UnitType>US survey foot</UnitType>"),
    ("kilometres", Cells::Land, -80.0, "<UnitType>km</UnitType>"),
    ("kelvin", Cells::Land, -80.0, "<UnitType>K</UnitType>"),
    ("turned", Cells::Land, -80.0, ""),
    ("degrees", Cells::Holes(-9999.0), -0.001, NO_DATA),
    (
        "palette",
        Cells::Bytes,
        -80.0,
        "<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1=\"0\" c2=\"9\" c3=\"0\" c4=\"255\"/>\
         <Entry c1=\"7\" c2=\"0\" c3=\"0\" c4=\"255\"/></ColorTable>",
    ),
];

const NO_DATA: &str = "<NoDataValue>-9999</NoDataValue>";

/// What the cells of a source hold.
#[derive(Clone, Copy)]
enum Cells {
    /// Heights from 200 to 1,100 m.
    Land,
    /// The same, but for some cells.
    Holes(f32),
    /// From 0 to 4 thousand million.
    Large,
    /// 0 and 1, in bytes.
    Bytes,
}

impl Cells {
    fn bytes(self) -> Vec<u8> {
        let [columns, rows] = SIDES;
        let heights = (0..columns * rows).map(|cell| {
            let random = (weald_core::random::hash2(7, cell as i64, 1) >> 40) as f32 / 16_777_216.0;
            let hole = cell % 40 == 0 && cell <= 40;
            match self {
                Self::Holes(none) if hole => none,
                Self::Large => random * 4.0e9,
                _ => 200.0 + random * 900.0,
            }
        });
        match self {
            Self::Bytes => (0..columns * rows).map(|cell| (cell % 2) as u8).collect(),
            _ => heights.flat_map(f32::to_le_bytes).collect(),
        }
    }
}

/// Writes the sources into a folder.
fn write_sources(folder: &Path) {
    for (name, cells, south, elements) in SOURCES {
        std::fs::write(folder.join(format!("{name}.bin")), cells.bytes()).expect("written");
        let [columns, rows] = SIDES;
        let (kind, bytes) = if matches!(cells, Cells::Bytes) { ("Byte", 1) } else { ("Float32", 4) };
        let (west, north, cell, crs) = if name == "degrees" {
            (-84.4, 36.7, 0.001, "EPSG:4326")
        } else {
            (7e5, 4e6, 80.0, "EPSG:32616")
        };
        let turn = if name == "turned" { 10.0 } else { 0.0 };
        let line = columns * bytes;
        let text = format!(
            "<VRTDataset rasterXSize=\"{columns}\" rasterYSize=\"{rows}\"><SRS>{crs}</SRS><GeoTransform>{west}, {cell}, \
             {turn}, {north}, {turn}, {south}</GeoTransform><VRTRasterBand dataType=\"{kind}\" band=\"1\" \
             subClass=\"VRTRawRasterBand\">{elements}<SourceFilename relativetoVRT=\"1\">{name}.bin</SourceFilename>\
             <PixelOffset>{bytes}</PixelOffset><LineOffset>{line}</LineOffset><ByteOrder>LSB</ByteOrder>\
             </VRTRasterBand></VRTDataset>"
        );
        std::fs::write(folder.join(format!("{name}.vrt")), text).expect("written");
    }
}

fn run(program: &str, arguments: &[String]) -> Result<(), String> {
    // What is read may have a file beside it; what is made has one only where a recipe says so.
    let pam = if arguments.iter().any(|word| word == "-unscale") { "YES" } else { "NO" };
    let run = Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", pam).output();
    let output = run.map_err(|cause| {
        format!("{program} does not start ({cause}); install it: apt-get install gdal-bin")
    })?;
    let message = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(()) } else { Err(format!("{program} {arguments:?}: {message}")) }
}

fn translate(options: &[String], from: &Path, into: &Path) -> Result<(), String> {
    let shown = |path: &Path| path.display().to_string();
    let all = [&["-q".to_owned()], options, &[shown(from), shown(into)]].concat();
    run("gdal_translate", &all)
}

/// The values behind scale and offset, and NaN where the mask says that there is no data.
fn read(path: &Path) -> Result<Theirs, String> {
    let raw = path
        .with_extension(format!("{}.bin", path.extension().and_then(|it| it.to_str()).unwrap_or_default()));
    let options =
        "-unscale -ot Float64 -b 1 -b mask -of ENVI".split(' ').map(str::to_owned).collect::<Vec<_>>();
    translate(&options, path, &raw)?;
    let bytes = std::fs::read(raw).map_err(|cause| cause.to_string())?;
    Ok(land(&bytes))
}

/// What is stored in many files that have neither scale nor offset: as bands of one virtual file, which is read at once.
fn read_all(folder: &Path, paths: &[&Path]) -> Result<Vec<Theirs>, String> {
    let [columns, rows] = SIDES;
    let band = |path: &&Path, band: &str| {
        format!(
            "<VRTRasterBand dataType=\"Float64\"><SimpleSource><SourceFilename>{}</SourceFilename><SourceBand>{band}\
             </SourceBand></SimpleSource></VRTRasterBand>",
            path.display()
        )
    };
    let bands: String = paths.iter().flat_map(|path| [band(path, "1"), band(path, "mask,1")]).collect();
    let text = format!("<VRTDataset rasterXSize=\"{columns}\" rasterYSize=\"{rows}\">{bands}</VRTDataset>");
    let (all, raw) = (folder.join("all.vrt"), folder.join("all.bin"));
    std::fs::write(&all, text).map_err(|cause| cause.to_string())?;
    translate(&["-of".to_owned(), "ENVI".to_owned()], &all, &raw)?;
    let bytes = std::fs::read(raw).map_err(|cause| cause.to_string())?;
    Ok(bytes.chunks(2 * 8 * columns * rows).map(land).collect())
}

/// Values, and behind them the mask, as bytes: values that are NaN where the mask says that there is no data.
fn land(bytes: &[u8]) -> Theirs {
    let numbers: Vec<f64> =
        bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().expect("eight"))).collect();
    let (values, mask) = numbers.split_at(numbers.len() / 2);
    let cells = values.iter().zip(mask).map(|(value, mask)| if *mask == 0.0 { f64::NAN } else { *value });
    Theirs(cells.collect())
}

impl Recipe {
    fn file(&self, folder: &Path, number: usize) -> Foreign {
        let path = folder.join(format!("{number}.{}", self.extension));
        let source = folder.join(format!("{}.vrt", self.source));
        translate(&self.options, &source, &path).unwrap_or_else(|cause| panic!("{}: {cause}", self.name));
        let Self { group, name, metres, verdict, .. } = self;
        Foreign {
            group: (*group).to_owned(),
            name: name.clone(),
            path,
            metres: *metres,
            verdict: verdict.clone(),
        }
    }
}

#[test]
fn files_of_gdal_are_read_as_gdal_reads_them_or_refused_with_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    write_sources(folder.path());
    let recipes = [storage(), refused(), meaning(), others()].concat();
    let made: Vec<Foreign> =
        recipes.par_iter().enumerate().map(|(number, recipe)| recipe.file(folder.path(), number)).collect();
    let plain: Vec<&Path> =
        made.iter().filter(|it| it.group == STORAGE).map(|it| it.path.as_path()).collect();
    let mut stored = read_all(folder.path(), &plain).expect("GDAL reads its own files").into_iter();
    let theirs: Vec<Option<Theirs>> =
        made.iter().map(|file| if file.group == STORAGE { stored.next() } else { None }).collect();
    let judged = (recipes.par_iter(), made.par_iter(), theirs.into_par_iter()).into_par_iter().map(
        |(recipe, file, stored)| {
            let is_refused = matches!(file.verdict, Verdict::Refused(_));
            let theirs = match stored {
                Some(stored) => Ok(stored),
                None if is_refused => Err("not asked".to_owned()),
                None => read(&file.path),
            };
            let is_turned = recipe.source == "south";
            file.fault(&theirs.map(|theirs| if is_turned { theirs.turned(SIDES[0]) } else { theirs }))
        },
    );
    let faults: Vec<String> = judged.collect::<Vec<_>>().into_iter().flatten().collect();
    judge(&made, &faults);
}
