//! Terrain3D for Godot: heights in metres as EXR, or as R16 with their range, and what to enter in its importer.
//!
//! The importer cuts an image of any size into regions and pads the last ones. It stores metres as they are in an
//! EXR; for a number `n` of an R16 file
//!
//! height = low + n / 65535 · (high − low), with `r16_range` = (low, high).
//!
//! All vertices are `vertex_spacing` apart, so cells are kept as they are, or brought to another spacing.
//!
//! Source: Terrain3D documentation: Importing & Exporting Data, Heightmaps (scaling); at most 32 × 32 regions.

use std::path::Path;

use serde_json::{Value, json};

use super::terrain_tiles::{
    DESCRIPTION, description, extension, extent_of, little_endian, no_data_note, size_fault, source,
};
use super::vertices::{Vertices, ensure_extent};
use super::{Export, ExportEntry, Finished};
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity, left_out};
use weald_core::grid::Size;
use weald_core::parameter::{Fault, LayerName};
use weald_io::{Part, PartName};

weald_core::parameters! {
    /// Terrain for Terrain3D.
    pub struct Terrain3d {
        /// Layer of heights, in metres.
        of: LayerName = LayerName::of("height");
        /// Vertices a side of a region: 64, 128, 256, 512, 1024 or 2048. By default 256, or the first with which 32
        /// regions are enough.
        region_size: Option<u32> = None, range 64..=2048;
        /// Distance of vertices. By default the side of a cell.
        spacing: Option<f64> = None, range 0.01..=1.0e5, unit "m";
    }
}

/// The entry in the registry of exports.
pub(super) const ENTRY: ExportEntry = ExportEntry::of::<Terrain3d>(
    "terrain3d",
    &["exr", "r16"],
    "terrain for Terrain3D in Godot: heights in metres or as 16 bits, and what its importer asks for; +X east, +Z south, from the north-western corner",
    "Terrain3D documentation, Importing & Exporting Data",
);

const REGION_SIZES: [u32; 6] = [64, 128, 256, 512, 1024, LARGEST_REGION];
const LARGEST_REGION: u32 = 2048;
const DEFAULT_REGION: u32 = 256;
/// Most regions a side.
const REGIONS: usize = 32;
const MAX_VALUE: f64 = 65535.0;

impl Export for Terrain3d {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn faults(&self) -> Vec<Fault> {
        size_fault("region_size", self.region_size, "regions of Terrain3D have", &REGION_SIZES)
            .into_iter()
            .collect()
    }

    fn left_out(&self, file: &Path) -> Option<String> {
        let needs_exr = extension(file) == "exr" && cfg!(not(feature = "exr"));
        needs_exr.then(|| format!("{}; .r16 is written without it", left_out("OpenEXR", "exr")))
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        no_data_note(finished, "").into_iter().collect()
    }

    fn names(&self, _: &Path) -> Vec<PartName> {
        vec![PartName::Own, PartName::Beside(DESCRIPTION.to_owned())]
    }

    fn check_on(&self, domain: &Domain, _: &Path) -> Result<(), Error> {
        ensure_extent(domain.size)?;
        self.region(self.size(domain)?.0).map(drop)
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let domain = &finished.landscape.domain;
        let (size, spacing) = self.size(domain)?;
        let region = self.region(size)?;
        let heights = Vertices::of(domain, finished.landscape.field(&self.of.0)?, size)?;
        let (low, high) = heights.range();
        let bytes = if extension(file) == "exr" {
            exr(heights)?
        } else {
            let per_metre = if high > low { MAX_VALUE / (high - low) } else { 0.0 };
            let number = |index| ((heights.value(index, low) - low) * per_metre).round() as u16;
            little_endian(&(0..size.cells()).map(number).collect::<Vec<_>>())
        };
        let mut json = self.described(finished, &Import { size, spacing, region });
        if extension(file) != "exr" {
            json["r16_range"] = json!([low, high]);
            json["r16_size"] = json!([size.columns, size.rows]);
        }
        Ok(vec![Part::own(bytes), description(&json)])
    }
}

/// Heights in metres as OpenEXR.
#[cfg(feature = "exr")]
fn exr(heights: Vertices) -> Result<Vec<u8>, Error> {
    let raster = weald_io::Raster { valid: heights.valid, ..weald_io::Raster::from(heights.field) };
    weald_io::exr::encode_for_godot(&raster)
}

#[cfg(not(feature = "exr"))]
fn exr(_: Vertices) -> Result<Vec<u8>, Error> {
    Err(Error::Run(left_out("OpenEXR", "exr")))
}

/// What the importer is given.
struct Import {
    size: Size,
    spacing: f64,
    region: u32,
}

impl Terrain3d {
    /// Vertices, and how far they are apart: the nearest to what is asked for that ends at the last cell of the
    /// longer side.
    fn size(&self, domain: &Domain) -> Result<(Size, f64), Error> {
        let Some(wanted) = self.spacing else { return Ok((domain.size, domain.cell)) };
        let [width, length] = extent_of(domain);
        let longer = width.max(length);
        let spacing = longer / (longer / wanted).round().max(1.0);
        let vertices = |metres: f64| (metres / spacing).round().max(1.0) as usize + 1;
        Ok((Size::new(vertices(width), vertices(length))?, spacing))
    }

    fn region(&self, size: Size) -> Result<u32, Error> {
        let longer = size.columns.max(size.rows);
        let holds = |region: &u32| *region as usize * REGIONS >= longer;
        let fitting = REGION_SIZES.into_iter().filter(|&region| region >= DEFAULT_REGION).find(holds);
        let region = self.region_size.or(fitting).unwrap_or(LARGEST_REGION);
        if holds(&region) {
            return Ok(region);
        }
        let asked = longer.div_ceil(region as usize) as u64;
        let limit = Limit::new(Quantity::RegionsPerSide, asked, 0..=REGIONS as u64);
        let subject = format!("terrain3d: {size} vertices in regions of {region}");
        Err(limit.of(subject).remedy("choose a larger `region_size` or `spacing`").into())
    }

    fn described(&self, finished: &Finished<'_>, import: &Import) -> Value {
        let Import { size, spacing, region } = import;
        json!({
            "for": "Terrain3D for Godot",
            "vertex_spacing": spacing,
            "region_size": region,
            "regions": [size.columns.div_ceil(*region as usize), size.rows.div_ceil(*region as usize)],
            "import_scale": 1.0,
            "height_offset": 0.0,
            "rows": "north to south, +X east, +Z south",
            "source": source(finished, &self.of),
        })
    }
}
