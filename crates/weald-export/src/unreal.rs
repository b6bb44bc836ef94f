//! Landscapes of Unreal Engine: 16-bit heights as PNG or R16 in a size that a landscape can have, masks for its
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
    Tiles, Weight, at_vertices, description, extension, extent, little_endian, no_data_note, png_8, png_16,
    source,
};
use super::vertices::Vertices;
use super::{Export, ExportEntry, Finished};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::parameter::{Fault, LayerName, Nested};
use weald_io::Part;

weald_core::parameters! {
    /// A landscape for Unreal Engine.
    pub struct Unreal {
        /// Layer of heights, in metres.
        of: LayerName = LayerName::of("height");
        /// Vertices a side of a tile: 127, 253, 505, 1009, 2017, 4033 or 8129. By default the first that loses no
        /// cell of the longer side, 8129 at most.
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
    "a landscape for Unreal Engine: 16-bit heights in a legal size, weight maps, scales for the import",
    "Epic Games, Landscape Technical Guide",
);

/// Sizes that the guide recommends, in rising order.
const SIZES: [u32; 7] = [127, 253, 505, 1009, 2017, 4033, 8129];

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

    fn faults(&self) -> Vec<Fault> {
        let size = self.size.filter(|size| !SIZES.contains(size)).map(|size| {
            format!("`size` is {size}, but landscapes have {SIZES:?} vertices a side; choose one of these")
        });
        let size = size.map(|message| Fault::of("size", message));
        let masks = self.masks.iter().zip(1..).filter_map(|(mask, number)| {
            Some(Fault::of("low", mask.0.fault()?).within(&format!("masks.{number}")))
        });
        size.into_iter().chain(masks).collect()
    }

    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let cut = self.masks.iter().filter_map(|mask| mask.0.note(finished));
        no_data_note(finished, "; the file of holes is a weight map for the visibility layer")
            .into_iter()
            .chain(cut)
            .collect()
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let tiles = Tiles::new(finished.landscape.domain.size, self.tiles, self.size, &SIZES);
        let heights = at_vertices(finished, &self.of, tiles)?;
        let scale = Scale::of(self, heights.range())?;
        let mut set = TileSet { tiles, extension: extension(file), parts: Vec::new() };
        set.add_heights(&scale.numbers(&heights))?;
        for Nested(mask) in &self.masks {
            let layer = at_vertices(finished, &mask.layer, tiles)?;
            let value = |index| mask.number(layer.value(index, mask.low));
            set.add_mask(&mask.layer.0, &(0..layer.field.size().cells()).map(value).collect::<Vec<_>>())?;
        }
        if let Some(valid) = &heights.valid {
            set.add_mask(
                "holes",
                &valid.flags().iter().map(|is_valid| if *is_valid { 0 } else { 255 }).collect::<Vec<_>>(),
            )?;
        }
        set.parts.push(description(&self.described(finished, tiles, &scale)));
        Ok(set.parts)
    }
}

impl Unreal {
    fn described(&self, finished: &Finished<'_>, tiles: Tiles, scale: &Scale) -> Value {
        let [width, length] = extent(finished);
        let steps = (tiles.count * (tiles.side - 1)) as f64;
        let [x_scale, y_scale] = [width, length].map(|metres| 100.0 * metres / steps);
        let quads = if tiles.side == 8129 { 127 } else { 63 };
        json!({
            "for": "Unreal Engine landscape",
            "tiles": [tiles.count, tiles.count],
            "vertices_a_side_of_a_tile": tiles.side,
            "vertices_in_common": 1,
            "quads_per_section": quads,
            "sections_per_component": [2, 2],
            "components_of_a_tile": [(tiles.side - 1) / (2 * quads), (tiles.side - 1) / (2 * quads)],
            "scale": { "x": x_scale, "y": y_scale, "z": scale.percent },
            "location_cm": { "x": -50.0 * width, "y": -50.0 * length, "z": 100.0 * self.zero },
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
    fn of(export: &Unreal, (low, high): (f64, f64)) -> Result<Self, Error> {
        let (above, below) = ((high - export.zero).max(0.0), (export.zero - low).max(0.0));
        let least = 100.0 * STEPS * (above / (MAX_VALUE - MIDDLE)).max(below / MIDDLE);
        let percent = export.z_scale.unwrap_or(if least > 0.0 { least } else { 100.0 });
        if percent < least {
            return Err(Error::Run(format!(
                "unreal: heights from {low} to {high} m around {} m need a `z_scale` of {least} % or more, but it is \
                 {percent} %",
                export.zero
            )));
        }
        Ok(Self { percent, zero: export.zero })
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

/// The files of a set.
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
            self.parts.push(if self.tiles.count == 1 {
                Part::own(bytes)
            } else {
                Part::sibling(format!("_x{x}_y{y}.{}", self.extension), bytes)
            });
        }
        Ok(())
    }

    fn add_mask(&mut self, name: &str, numbers: &[u8]) -> Result<(), Error> {
        let size = Size::square(self.tiles.side)?;
        for (x, y) in self.tiles.all() {
            let tile = if self.tiles.count == 1 { String::new() } else { format!("_x{x}_y{y}") };
            let bytes = png_8(size, &self.tiles.cut(numbers, (x, y)))?;
            self.parts.push(Part::sibling(format!("_{name}{tile}.png"), bytes));
        }
        Ok(())
    }
}
