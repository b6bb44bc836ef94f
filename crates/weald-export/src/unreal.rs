//! Landscapes of Unreal Engine: 16-bit heights as PNG or R16 in a size that its guide recommends, masks for its
//! layers, and what to enter at the import.
//!
//! A landscape stores whole numbers `n` from 0 to 65535. With a Z scale of `s` percent a vertex lies at
//!
//! height above the actor in cm = (n − 32768) / 128 · s,
//!
//! so 32768 is the height of the actor itself, and a scale of 100 reaches from −256 m to 255.992 m. X and Y scale
//! are the centimetres from one vertex to the next.
//!
//! Source: Epic Games, Landscape Technical Guide, Unreal Engine documentation: recommended landscape sizes,
//! calculating heightmap dimensions and Z scale.

use std::path::Path;

use serde_json::{Value, json};

use super::terrain_tiles::{
    DESCRIPTION, Tiles, Weight, at_vertices, description, extension, extent, little_endian, no_data_note,
    png_8, png_16, resampled_note, size_fault, source,
};
use super::vertices::{Vertices, ensure_extent};
use super::{Export, ExportEntry, Finished};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::parameter::{Fault, LayerName, Nested};
use weald_io::{Part, PartName};

weald_core::parameters! {
    /// A landscape for Unreal Engine.
    pub struct Unreal {
        /// Layer of heights, in metres.
        of: LayerName = LayerName::of("height");
        /// Vertices a side of a tile: 127, 253, 505, 1009, 2017, 4033 or 8129. By default the first with at least as many
        /// vertices as the longer side has cells, 8129 at most. A landscape of another size is resampled: for none of
        /// it, make the landscape's `size` one of these.
        size: Option<u32> = None, range 127..=8129;
        /// Tiles a side. More than one are files of their own, `_x0_y0` in the north-west, with one row of
        /// vertices in common with each neighbour.
        tiles: u32 = 1, range 1..=32;
        /// Height of the landscape actor, stored as 32768.
        zero: f64 = 0.0, range -1.0e5..=1.0e5, unit "m";
        /// Z scale, the same for several landscapes that meet. By default the smallest that holds all heights.
        z_scale: Option<f64> = None, range 0.001..=1.0e6, unit "%";
        /// Layers that become weight maps of 8 bits: `[{ layer = "soil", high = 2.0 }]`.
        masks: Vec<Nested<Weight>> = Vec::new();
    }
}

/// The entry in the registry of exports.
pub(super) const ENTRY: ExportEntry = ExportEntry::of::<Unreal>(
    "unreal",
    &["png", "r16"],
    "a landscape for Unreal Engine: 16-bit heights in a size that it recommends, weight maps, what to enter at the import; +X east, +Y south, the middle of the landscape at the origin",
    "Epic Games, Landscape Technical Guide",
);

/// Sizes that the guide recommends, in rising order.
const SIZES: [u32; 7] = [127, 253, 505, 1009, 2017, 4033, 8129];

/// Name of the weight map of the cells without data.
const HOLES: &str = "holes";

const MIDDLE: f64 = 32768.0;
const MAX_VALUE: f64 = 65535.0;
/// Numbers in a centimetre at a scale of one percent.
const STEPS: f64 = 128.0;

impl Export for Unreal {
    fn reads(&self) -> Vec<String> {
        [&self.of]
            .into_iter()
            .chain(self.masks.iter().map(|mask| &mask.0.layer))
            .map(|it| it.0.clone())
            .collect()
    }

    fn working_bytes(&self, cells: u64) -> u64 {
        70 * cells
    }

    fn faults(&self) -> Vec<Fault> {
        let size = size_fault("size", self.size, "the sizes that Unreal recommends are", &SIZES);
        let masks = self.masks.iter().zip(1..).filter_map(|(mask, number)| {
            Some(Fault::of("low", mask.0.fault()?).within(&format!("masks.{number}")))
        });
        size.into_iter().chain(masks).collect()
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let tiles = Tiles::new(finished.landscape.domain.size, self.tiles, self.size, &SIZES);
        let cut = self.masks.iter().filter_map(|mask| mask.0.note(finished));
        no_data_note(finished, "; the file of holes is a weight map for the visibility layer")
            .into_iter()
            .chain(resampled_note(finished, tiles))
            .chain(self.coarse_note(finished))
            .chain(self.raised_note(finished))
            .chain(cut)
            .collect()
    }

    fn names(&self, file: &Path) -> Vec<PartName> {
        let tiles = Tiles { count: self.tiles as usize, side: 0 };
        let extension = &extension(file);
        let masks = self.masks.iter().map(|Nested(mask)| mask.layer.0.as_str()).chain([HOLES]);
        let masks = masks.flat_map(|mask| tiles.all().map(move |tile| mask_name(tiles, mask, tile)));
        let heights = tiles.all().map(|tile| heights_name(tiles, extension, tile));
        heights.chain(masks).chain([PartName::Beside(DESCRIPTION.to_owned())]).collect()
    }

    fn check_on(&self, domain: &Domain, _: &Path) -> Result<(), Error> {
        ensure_extent(domain.size)?;
        Tiles::new(domain.size, self.tiles, self.size, &SIZES).size().map(drop)
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let tiles = Tiles::new(finished.landscape.domain.size, self.tiles, self.size, &SIZES);
        let heights = at_vertices(finished, &self.of, tiles)?;
        let scale = Scale::of(self, heights.range());
        let mut set = TileSet { tiles, extension: extension(file), parts: Vec::new() };
        set.add_heights(&scale.numbers(&heights))?;
        for Nested(mask) in &self.masks {
            let layer = at_vertices(finished, &mask.layer, tiles)?;
            let value = |index| mask.number(layer.value(index, mask.low));
            set.add_mask(&mask.layer.0, &(0..layer.field.size().cells()).map(value).collect::<Vec<_>>())?;
        }
        if let Some(valid) = &heights.valid {
            set.add_mask(
                HOLES,
                &valid.flags().iter().map(|is_valid| if *is_valid { 0 } else { 255 }).collect::<Vec<_>>(),
            )?;
        }
        set.parts.push(description(&self.described(finished, tiles, &scale)));
        Ok(set.parts)
    }
}

/// Of the 65536 numbers, those that heights should take: 12 of their 16 bits.
const MIN_NUMBERS: f64 = 4096.0;

impl Unreal {
    /// What the user should know where `zero` is so far from the heights that few numbers are left to them.
    fn coarse_note(&self, finished: &Finished<'_>) -> Option<String> {
        let (low, high) = self.heights(finished)?;
        let metres = Scale::of(self, (low, high)).percent / 100.0 / STEPS;
        let numbers = (high - low) / metres;
        (self.z_scale.is_none() && high > low && numbers < MIN_NUMBERS).then(|| {
            let middle = (0.5 * (low + high)).round();
            format!(
                "heights take {numbers:.0} of 65536 numbers, one every {metres:.3} m; a `zero` near them, as {middle}, \
                 leaves them more"
            )
        })
    }

    /// What the user should know where heights do not go into the scale that was asked for.
    fn raised_note(&self, finished: &Finished<'_>) -> Option<String> {
        let (low, high) = self.heights(finished)?;
        let (asked, zero) = (self.z_scale?, self.zero);
        let needed = Scale::of(self, (low, high)).percent;
        (needed > asked).then(|| {
            format!(
                "heights from {low:.1} to {high:.1} m around {zero} m do not go into a `z_scale` of {asked} %: the numbers \
                 and the description have {needed} %; a `zero` nearer to them needs less"
            )
        })
    }

    fn heights(&self, finished: &Finished<'_>) -> Option<(f64, f64)> {
        let valid = finished.landscape.domain.valid.as_ref();
        let (low, high) = finished.landscape.field(&self.of.0).ok()?.range(valid)?;
        Some((low.into(), high.into()))
    }

    fn described(&self, finished: &Finished<'_>, tiles: Tiles, scale: &Scale) -> Value {
        let [width, length] = extent(finished);
        let steps = (tiles.count * (tiles.side - 1)) as f64;
        let [x_scale, y_scale] = [width, length].map(|metres| 100.0 * metres / steps);
        let quads = if tiles.side == 8129 { 127 } else { 63 };
        json!({
            "for": "Unreal Engine landscape",
            "tiles": [tiles.count, tiles.count],
            "vertices_in_common": 1,
            "Overall Resolution": [tiles.side, tiles.side],
            "Section Size": format!("{quads}x{quads} Quads"),
            "Sections Per Component": "2x2 Sections",
            "Number of Components": [(tiles.side - 1) / (2 * quads), (tiles.side - 1) / (2 * quads)],
            "Location": { "x": -50.0 * width, "y": -50.0 * length, "z": 100.0 * self.zero },
            "Scale": { "x": x_scale, "y": y_scale, "z": scale.percent },
            "units": "as the import dialog has them, to be entered as they are: Location in cm, Scale in cm a quad for \
                      X and Y and in percent for Z; resolution and components are those of a tile",
            "height_m": { "of_0": scale.metres(0.0), "of_32768": self.zero, "of_65535": scale.metres(MAX_VALUE) },
            "rows": "north to south, +X east, +Y south",
            "masks": self.masks.iter().map(|Nested(mask)| {
                json!({ "layer": mask.layer.0, "value_of_0": mask.low, "value_of_255": mask.high })
            }).collect::<Vec<_>>(),
            "source": source(finished, &self.of),
        })
    }
}

/// How numbers stand for heights.
struct Scale {
    percent: f64,
    /// Height of 32768 in metres.
    zero: f64,
}

impl Scale {
    /// That which was asked for, or the least that heights go into.
    fn of(export: &Unreal, (low, high): (f64, f64)) -> Self {
        let (above, below) = ((high - export.zero).max(0.0), (export.zero - low).max(0.0));
        let least = 100.0 * STEPS * (above / (MAX_VALUE - MIDDLE)).max(below / MIDDLE);
        let percent = export.z_scale.unwrap_or(if least > 0.0 { least } else { 100.0 }).max(least);
        Self { percent, zero: export.zero }
    }

    fn metres(&self, number: f64) -> f64 {
        self.zero + (number - MIDDLE) / STEPS * self.percent / 100.0
    }

    fn numbers(&self, heights: &Vertices) -> Vec<u16> {
        let low = heights.range().0;
        let number = |index| {
            let steps = (heights.value(index, low) - self.zero) * 100.0 * STEPS / self.percent;
            (MIDDLE + steps.round()).clamp(0.0, MAX_VALUE) as u16
        };
        (0..heights.field.size().cells()).map(number).collect()
    }
}

/// Which tile a file is of, where there are several.
fn tile_suffix(tiles: Tiles, (x, y): (usize, usize)) -> String {
    if tiles.count == 1 { String::new() } else { format!("_x{x}_y{y}") }
}

fn heights_name(tiles: Tiles, extension: &str, tile: (usize, usize)) -> PartName {
    match tile_suffix(tiles, tile) {
        none if none.is_empty() => PartName::Own,
        suffix => PartName::Sibling(format!("{suffix}.{extension}")),
    }
}

fn mask_name(tiles: Tiles, mask: &str, tile: (usize, usize)) -> PartName {
    PartName::Sibling(format!("_{mask}{}.png", tile_suffix(tiles, tile)))
}

/// The files of an export.
struct TileSet {
    tiles: Tiles,
    extension: String,
    parts: Vec<Part>,
}

impl TileSet {
    fn add_heights(&mut self, numbers: &[u16]) -> Result<(), Error> {
        let size = Size::square(self.tiles.side)?;
        for (x, y) in self.tiles.all() {
            let tile = self.tiles.cut(numbers, (x, y));
            let bytes = if self.extension == "png" { png_16(size, &tile)? } else { little_endian(&tile) };
            self.parts.push(Part { name: heights_name(self.tiles, &self.extension, (x, y)), bytes });
        }
        Ok(())
    }

    fn add_mask(&mut self, name: &str, numbers: &[u8]) -> Result<(), Error> {
        let size = Size::square(self.tiles.side)?;
        for (x, y) in self.tiles.all() {
            let bytes = png_8(size, &self.tiles.cut(numbers, (x, y)))?;
            self.parts.push(Part { name: mask_name(self.tiles, name, (x, y)), bytes });
        }
        Ok(())
    }
}
