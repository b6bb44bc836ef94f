//! Pictures of eroded ground on the same scales, so that they compare.

use super::Plate;
use super::han::FinishedRun;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_picture::{Image, Map, Picture, Relief, Scale, Tint};

/// Pixels between two pictures.
const GAP: usize = 10;

/// Factor on heights in shaded relief: the same everywhere, so that shading compares.
const EXAGGERATION: f64 = 0.7;

/// Cells that the smallest brook drains in pictures of the flow.
const BROOK: f64 = 20.0;

/// Shaded relief with lakes and rivers.
pub(super) fn relief(landscape: &Landscape, width: u32) -> Result<Image, Error> {
    let exaggeration = Some(EXAGGERATION);
    Relief { width: Some(width), exaggeration, contours: Some(0.0), ..Relief::default() }.render(landscape)
}

/// Shaded relief of the ground alone.
pub(super) fn bare(landscape: &Landscape, width: u32) -> Result<Image, Error> {
    let exaggeration = Some(EXAGGERATION);
    Relief { width: Some(width), exaggeration, contours: Some(0.0), water: false, ..Relief::default() }
        .render(landscape)
}

/// Mean discharge of each cell.
pub(super) fn discharge(landscape: &Landscape) -> Result<Field, Error> {
    let (x, y) = (landscape.field("flux_x")?, landscape.field("flux_y")?);
    let strength = |(&x, &y): (&f32, &f32)| (x * x + y * y).sqrt();
    let flow = x.values().iter().zip(y.values()).map(strength).collect();
    Ok(Field::from_values(x.size(), flow))
}

/// Rivers on grey ground, down to brooks, as wide as the root of their mean discharge.
pub(super) fn flow(landscape: &Landscape, width: u32) -> Result<Image, Error> {
    let least_area = Some(BROOK * landscape.domain.cell_area());
    let (ramp, exaggeration, contours) = (Tint::Grey, Some(0.25 * EXAGGERATION), Some(0.0));
    Relief { width: Some(width), ramp, exaggeration, contours, least_area, ..Relief::default() }
        .render(landscape)
}

/// Depth of water from 0 to one cell.
pub(super) fn depth(landscape: &Landscape, width: u32) -> Result<Image, Error> {
    let [low, high] = [Some(0.0), Some(1.0)];
    Map { width: Some(width), ramp: Scale::Water, low, high, ..map("water") }.render(landscape)
}

/// A map of a layer.
pub(super) fn map(layer: &str) -> Map {
    Map { of: LayerName::of(layer), legend: false, ..Map::default() }
}

/// A square of `side` cells whose north-western cell is at `corner` (column, row).
pub(super) fn part(landscape: &Landscape, corner: [usize; 2], side: usize) -> Result<Landscape, Error> {
    let size = Size::square(side)?;
    let mut part = Landscape::new(Domain::new(size, landscape.domain.cell));
    for (name, layer) in landscape.layers() {
        let values = Field::from_function(size, |x, y| layer.field.at(corner[0] + x, corner[1] + y));
        part.insert(name, &layer.unit, values);
    }
    Ok(part)
}

/// Draws each run below its name and lays the pictures out in rows of `columns`.
pub(super) fn sheet(
    runs: &[FinishedRun],
    columns: usize,
    draw: impl Fn(&Landscape) -> Result<Image, Error>,
) -> Result<Image, Error> {
    let titled = |ran: &FinishedRun| Ok(draw(&ran.landscape)?.titled(&ran.run.name));
    let images = runs.iter().map(titled).collect::<Result<Vec<_>, Error>>()?;
    Ok(laid_out(&images, columns))
}

/// Pictures in rows of `columns`.
pub(super) fn laid_out(images: &[Image], columns: usize) -> Image {
    let rows: Vec<Image> = images.chunks(columns).map(|row| Image::beside(row, GAP)).collect();
    Image::below(&rows, GAP)
}

/// A row of pictures, with what they show and the names of the runs below it.
pub(super) fn plate(name: &'static str, what: &str, runs: &[FinishedRun], image: Image) -> Plate {
    let names: Vec<&str> = runs.iter().map(|ran| ran.run.name.as_str()).collect();
    let steps = runs.first().map_or(0, |ran| ran.run.iterations);
    Plate { name, caption: format!("{what} after {steps} steps: {}", names.join("; ")), image }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn carrying(flow: [f32; 2]) -> Landscape {
        let size = Size::new(1, 1).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.insert("height", "m", Field::filled(size, 0.0));
        for (name, flow) in ["flux_x", "flux_y"].into_iter().zip(flow) {
            landscape.insert(name, "m³/step", Field::filled(size, flow));
        }
        landscape
    }

    #[test]
    fn discharge_is_the_length_of_the_mean_flow() {
        assert_eq!(discharge(&carrying([3.0, -4.0])).expect("both layers").at(0, 0), 5.0);
    }
}
