//! What the files for engines share: a square grid of vertices, cut into tiles with common edges, as files.

use std::path::Path;

use png::{BitDepth, ColorType};
use serde_json::{Value, json};

use super::Finished;
use super::vertices::Vertices;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::parameter::{Fault, LayerName};
use weald_io::Part;
use weald_io::png::Pixels;

weald_core::parameters! {
    /// A layer as a mask of 8 bits.
    pub struct Weight {
        /// The layer.
        layer: LayerName = LayerName::needed();
        /// Value that becomes 0, as all beyond it do, in the layer's unit. `low` above `high` inverts the mask.
        low: f64 = 0.0;
        /// Value that becomes 255, as all beyond it do, in the layer's unit.
        high: f64 = 1.0;
    }
}

impl Weight {
    /// The value as a number of 8 bits.
    pub(super) fn number(&self, value: f64) -> u8 {
        (255.0 * ((value - self.low) / (self.high - self.low))).round().clamp(0.0, 255.0) as u8
    }

    pub(super) fn fault(&self) -> Option<String> {
        (self.low == self.high).then(|| {
            format!("mask {}: `low` and `high` are both {}, but must differ", self.layer.0, self.low)
        })
    }

    /// What is cut off, where values lie beyond both ends.
    pub(super) fn note(&self, finished: &Finished<'_>) -> Option<String> {
        let valid = finished.landscape.domain.valid.as_ref();
        let (low, high) = finished.landscape.field(&self.layer.0).ok()?.range(valid)?;
        let ends = (self.low.min(self.high), self.low.max(self.high));
        (f64::from(low) < ends.0 || f64::from(high) > ends.1).then(|| {
            format!(
                "mask {}: values go from {low} to {high} and were cut off at {} and {}",
                self.layer.0, ends.0, ends.1
            )
        })
    }
}

/// A square grid of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tiles {
    /// Tiles a side.
    pub(super) count: usize,
    /// Vertices a side of a tile; neighbours have one row of them in common.
    pub(super) side: usize,
}

impl Tiles {
    /// Tiles of `side` vertices, or of the first of the rising `sizes` with which there are at least as many vertices as
    /// the longer side has cells; of the last where none suffices.
    pub(super) fn new(landscape: Size, count: u32, side: Option<u32>, sizes: &[u32]) -> Self {
        let count = count as usize;
        let needed = (landscape.columns.max(landscape.rows) - 1).div_ceil(count) + 1;
        let fitting =
            || sizes.iter().copied().find(|&size| size as usize >= needed).or(sizes.last().copied());
        let side = side.or_else(fitting).expect("an engine has sizes") as usize;
        Self { count, side }
    }

    /// Vertices of all tiles.
    pub(super) fn size(self) -> Result<Size, Error> {
        Size::square(self.count * (self.side - 1) + 1)
    }

    /// The tiles in columns and rows from the north-west.
    pub(super) fn all(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.count).flat_map(move |y| (0..self.count).map(move |x| (x, y)))
    }

    /// The numbers of one tile, rows from north to south.
    pub(super) fn cut<T: Copy>(self, all: &[T], (x, y): (usize, usize)) -> Vec<T> {
        let width = self.count * (self.side - 1) + 1;
        let (west, north) = (x * (self.side - 1), y * (self.side - 1));
        (north..north + self.side).flat_map(|row| &all[row * width + west..][..self.side]).copied().collect()
    }
}

/// Numbers of 16 bits, lowest byte first.
pub(super) fn little_endian(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A grey PNG of 16 bits.
pub(super) fn png_16(size: Size, numbers: &[u16]) -> Result<Vec<u8>, Error> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_be_bytes()).collect();
    grey(size, BitDepth::Sixteen, &bytes)
}

/// A grey PNG of 8 bits.
pub(super) fn png_8(size: Size, numbers: &[u8]) -> Result<Vec<u8>, Error> {
    grey(size, BitDepth::Eight, numbers)
}

fn grey(size: Size, depth: BitDepth, bytes: &[u8]) -> Result<Vec<u8>, Error> {
    Pixels { sides: [size.columns, size.rows], channels: ColorType::Grayscale, depth, bytes }.file()
}

/// What the name of a description has more than that of the file beside which it lies.
pub(super) const DESCRIPTION: &str = ".json";

/// The description of a set, beside the file that names it.
pub(super) fn description(json: &Value) -> Part {
    Part::beside(DESCRIPTION, format!("{json:#}\n").into_bytes())
}

/// The extension of the output, in lower case.
pub(super) fn extension(file: &Path) -> String {
    file.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase()
}

/// Where the landscape lies and where it came from.
pub(super) fn source(finished: &Finished<'_>, layer: &LayerName) -> Value {
    let place = finished.landscape.domain.georeference.as_ref();
    json!({
        "weald": env!("CARGO_PKG_VERSION"),
        "recipe_blake3": finished.hash,
        "seed": finished.seed,
        "layer": layer.0,
        "epsg": place.and_then(|place| place.epsg),
        "north_western_vertex": place.map(|place| place.at([0.5; 2])),
    })
}

/// Metres from the first vertex to the last, eastward and southward.
pub(super) fn extent(finished: &Finished<'_>) -> [f64; 2] {
    extent_of(&finished.landscape.domain)
}

/// The same of a grid.
pub(super) fn extent_of(domain: &Domain) -> [f64; 2] {
    [domain.size.columns, domain.size.rows].map(|cells| (cells - 1) as f64 * domain.cell)
}

/// The layer of a set at the vertices of all its tiles.
pub(super) fn at_vertices(
    finished: &Finished<'_>,
    layer: &LayerName,
    tiles: Tiles,
) -> Result<Vertices, Error> {
    let landscape = finished.landscape;
    Vertices::of(&landscape.domain, landscape.field(&layer.0)?, tiles.size()?)
}

/// What is wrong with a size that an engine does not take.
pub(super) fn size_fault(key: &str, size: Option<u32>, whose: &str, sizes: &[u32]) -> Option<Fault> {
    let size = size.filter(|size| !sizes.contains(size))?;
    let (last, others) = sizes.split_last()?;
    let others = others.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    let smaller = sizes.iter().rev().find(|known| **known < size);
    let larger = sizes.iter().find(|known| **known > size);
    let near = [(smaller, "smaller"), (larger, "larger")];
    let near = near.iter().filter_map(|(near, which)| Some(format!("{} is the next {which}", (*near)?)));
    let near = near.collect::<Vec<_>>().join(", ");
    let message = format!("`{key}` is {size}, but {whose} {others} or {last} vertices a side; {near}");
    Some(Fault::of(key, message))
}

/// What the user should know where vertices are not the cells.
pub(super) fn resampled_note(finished: &Finished<'_>, tiles: Tiles) -> Option<String> {
    let (cells, vertices) = (finished.landscape.domain.size, tiles.size().ok()?);
    let [x, y] = extent(finished).map(|metres| metres / (vertices.columns - 1) as f64);
    let side = vertices.columns;
    (cells != vertices).then(|| {
        format!(
            "{cells} cells were resampled to {vertices} vertices, {x:.2} m × {y:.2} m apart; a landscape of {side} × \
             {side} cells keeps its own"
        )
    })
}

/// What becomes of cells without data, where there are any.
pub(super) fn no_data_note(finished: &Finished<'_>, more: &str) -> Option<String> {
    let has_none = finished.landscape.domain.valid.is_some();
    has_none.then(|| format!("cells without data are written as the lowest height{more}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_share_their_edges() {
        let tiles = Tiles { count: 3, side: 5 };
        let numbers: Vec<usize> = (0..13 * 13).collect();
        let [west, east, south] = [(0, 1), (1, 1), (0, 2)].map(|at| tiles.cut(&numbers, at));
        for row in 0..5 {
            assert_eq!(west[row * 5 + 4], east[row * 5]);
        }
        assert_eq!(west[20..], south[..5]);
        assert_eq!(tiles.all().last(), Some((2, 2)));
        assert_eq!(tiles.cut(&numbers, (2, 2)).last(), numbers.last());
    }

    #[test]
    fn the_size_is_the_first_with_a_vertex_for_each_cell() {
        let tiles =
            |side, count| Tiles::new(Size { columns: side, rows: 9 }, count, None, &[33, 65, 129]).side;
        assert_eq!([33, 34, 65, 500].map(|side| tiles(side, 1)), [33, 65, 65, 129]);
        assert_eq!([65, 66, 129].map(|side| tiles(side, 2)), [33, 65, 65]);
    }

    #[test]
    fn a_mask_goes_from_its_low_to_its_high_value() {
        let weight = |low, high| Weight { layer: LayerName::of("soil"), low, high };
        assert_eq!(
            [-1.0, 0.0, 1.0, 2.0, 3.0].map(|value| weight(0.0, 2.0).number(value)),
            [0, 0, 128, 255, 255]
        );
        assert_eq!([0.0, 2.0].map(|value| weight(2.0, 0.0).number(value)), [255, 0]);
        assert!(weight(1.0, 1.0).fault().is_some() && weight(0.0, 1.0).fault().is_none());
    }
}
