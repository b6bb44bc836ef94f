//! Terrain of Unity: 16-bit heights, lowest byte first, of 2ⁿ + 1 vertices a side, and what to enter at the import.
//!
//! Unity reads a whole number `n` as the share n / 65536 of the terrain's height, and the first row of a file as
//! that at z = 0. Since z points north here, rows go from south to north, and "Flip Vertically" stays off. The
//! height entered is therefore a 65,536th more than the range, so that 65535 stands for the highest point.
//!
//! Source: Unity Technologies, Unity Manual: Working with Heightmaps, Terrain Settings (heightmap resolution); and
//! Terrain Tools: Import Heightmap, which finds tiles by `_X_Z` at the end of their names.

use std::path::Path;

use serde_json::{Value, json};

use super::terrain_tiles::{
    DESCRIPTION, Tiles, at_vertices, description, extension, extent, little_endian, no_data_note,
    resampled_note, size_fault, source,
};
use super::vertices::ensure_extent;
use super::{Export, ExportEntry, Finished};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::parameter::{Fault, LayerName};
use weald_io::{Part, PartName};

weald_core::parameters! {
    /// Terrain for Unity.
    pub struct Unity {
        /// Layer of heights, in metres.
        of: LayerName = LayerName::of("height");
        /// Vertices a side of a tile: 33, 65, 129, 257, 513, 1025, 2049 or 4097. By default the first with at
        /// least as many vertices as the longer side has cells, 4097 at most. A landscape of another size is resampled.
        size: Option<u32> = None, range 33..=4097;
        /// Tiles a side. More than one are files of their own, `_0_0` in the south-west, `_1_0` east of it, with
        /// one row of vertices in common with each neighbour.
        tiles: u32 = 1, range 1..=32;
    }
}

/// The entry in the registry of exports.
pub(super) const ENTRY: ExportEntry = ExportEntry::of::<Unity>(
    "unity",
    &["raw", "r16"],
    "terrain for Unity: 16-bit heights of 2^n + 1 vertices a side, in tiles, and its size for the import; +X east, +Z north, from the south-western corner",
    "Unity Manual, Working with Heightmaps; Terrain Tools, Import Heightmap",
);

/// Resolutions that Unity offers, in rising order.
const SIZES: [u32; 8] = [33, 65, 129, 257, 513, 1025, 2049, 4097];

/// Unity divides by this, one more than the greatest number.
const WHOLE: f64 = 65536.0;
const MAX_VALUE: f64 = 65535.0;

impl Export for Unity {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn faults(&self) -> Vec<Fault> {
        size_fault("size", self.size, "terrain of Unity has", &SIZES).into_iter().collect()
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let tiles = Tiles::new(finished.landscape.domain.size, self.tiles, self.size, &SIZES);
        no_data_note(finished, "").into_iter().chain(resampled_note(finished, tiles)).collect()
    }

    fn names(&self, file: &Path) -> Vec<PartName> {
        let tiles = Tiles { count: self.tiles as usize, side: 0 };
        let names = tiles.all().map(|tile| self.tile_name(tile, file));
        names.chain([PartName::Beside(DESCRIPTION.to_owned())]).collect()
    }

    fn check_on(&self, domain: &Domain, _: &Path) -> Result<(), Error> {
        ensure_extent(domain.size)?;
        Tiles::new(domain.size, self.tiles, self.size, &SIZES).size().map(drop)
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let tiles = Tiles::new(finished.landscape.domain.size, self.tiles, self.size, &SIZES);
        let heights = at_vertices(finished, &self.of, tiles)?;
        let (low, high) = heights.range();
        let per_metre = if high > low { MAX_VALUE / (high - low) } else { 0.0 };
        let number = |index| ((heights.value(index, low) - low) * per_metre).round() as u16;
        let numbers: Vec<u16> = (0..heights.field.size().cells()).map(number).collect();
        let mut parts = Vec::new();
        for (x, y) in tiles.all() {
            let rows = tiles.cut(&numbers, (x, y));
            let from_south: Vec<u16> = rows.rchunks(tiles.side).flatten().copied().collect();
            let bytes = little_endian(&from_south);
            parts.push(Part { name: self.tile_name((x, y), file), bytes });
        }
        parts.push(description(&self.described(finished, tiles, (low, high))));
        Ok(parts)
    }
}

impl Unity {
    /// The file of a tile that is counted from the north-west.
    fn tile_name(&self, (x, y): (usize, usize), file: &Path) -> PartName {
        match self.tiles as usize {
            1 => PartName::Own,
            count => PartName::Sibling(format!("_{x}_{}.{}", count - 1 - y, extension(file))),
        }
    }

    fn described(&self, finished: &Finished<'_>, tiles: Tiles, (low, high): (f64, f64)) -> Value {
        let [width, length] = extent(finished).map(|metres| metres / tiles.count as f64);
        json!({
            "for": "Unity terrain",
            "tiles": [tiles.count, tiles.count],
            "Depth": "Bit 16",
            "Resolution": tiles.side,
            "Byte Order": "Windows",
            "Flip Vertically": false,
            "Terrain Size": { "x": width, "y": (high - low) * WHOLE / MAX_VALUE, "z": length },
            "Position": { "x": 0.0, "y": low, "z": 0.0 },
            "units": "as the import and the transform have them: metres; those of one tile",
            "vertices_in_common": 1,
            "rows": "south to north, +X east, +Z north",
            "source": source(finished, &self.of),
        })
    }
}
