//! Banks that a river undercuts: they stand too steep, or slide.

use super::layered::{SOURCE, cut_open, from_above, ground, material, simulated, steepest_fall, texts};
use super::{Figure, FigureOutput, GalleryJob, Measured, Plate};
use crate::error::Error;
use crate::grid::{Field, Size};
use crate::landscape::Landscape;
use crate::picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "banks",
    title: "Slippage of undercut banks",
    source: SOURCE,
    shows: "A river cuts into its banks and makes them too steep to rest. Slippage lays each material back to its \
            own talus.",
    make,
};

const CELL: f64 = 1.0;

/// A running river keeps its banks a little steeper than they rest.
const MARGIN_DEG: f64 = 5.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (columns, rows, iterations) = job.choose((128, 80, 1500), (40, 32, 60));
    let start = valley(Size::new(columns, rows)?);
    let keys = format!(
        "erosion = 5.0\ncapacity = 2.0\nviscosity = 0.2\nsources = [{{ x = {:?}, y = {:?}, radius = 3.0, \
         rate = 0.05 }}]",
        0.1 * columns as f64,
        0.5 * rows as f64
    );
    let cut = simulated(&start, iterations, &keys)?;
    let slid = simulated(&start, iterations, &format!("{keys}\nslippage = {{ strength = 0.06 }}"))?;
    let landscapes = [&start, &cut, &slid];
    let caption = |view| format!("Before, and after {iterations} steps without and with slippage, {view}");
    let plates = vec![
        Plate { name: "relief", caption: caption("from above"), image: from_above(&landscapes)? },
        Plate {
            name: "section",
            caption: caption("cut across the river"),
            image: cut_open(&landscapes, Along::Column, 0.5)?,
        },
    ];
    Ok(FigureOutput { plates, measured: measured(&landscapes)? })
}

/// A plain that falls to the east, level beds of soil and gravel on rock, with a winding channel.
fn valley(size: Size) -> Landscape {
    let rows = size.rows as f64;
    let height = Field::from_function(size, |x, y| {
        let middle = 0.5 * rows + 0.1 * rows * libm::sin((x as f64 - 0.1 * size.columns as f64) / 13.0);
        let away = (y as f64 + 0.5 - middle).abs();
        (30.0 - 0.02 * x as f64 - (2.0 - 0.3 * away).max(0.0)) as f32
    });
    let mut landscape = ground(
        height,
        CELL,
        vec![material("rock", "rock"), material("gravel", "gravel"), material("soil", "soil")],
    );
    landscape.materials[1].bottom = Some(20.0);
    landscape.materials[2].bottom = Some(27.0);
    landscape
}

fn measured(landscapes: &[&Landscape; 3]) -> Result<Measured, Error> {
    let names = ["before", "without slippage", "with slippage"];
    let rows: Result<Vec<_>, Error> =
        names.into_iter().zip(landscapes).map(|(name, landscape)| row(name, landscape)).collect();
    Ok(Measured {
        header: texts(["ground", "gravel too steep", "soil too steep", "steepest, °"]),
        rows: rows?,
        remarks: texts([
            "Cells whose layer falls to a neighbour more steeply than its talus by 5° or more, and the steepest fall of \
             the ground; the edge is left out.",
        ]),
    })
}

fn row(name: &str, landscape: &Landscape) -> Result<Vec<String>, Error> {
    let height = landscape.field("height")?;
    let stack = crate::material::stack(landscape, height)?;
    let size = height.size();
    let inner: Vec<usize> =
        (2..size.rows - 2).flat_map(|y| (2..size.columns - 2).map(move |x| size.index(x, y))).collect();
    let mut cells = vec![name.to_owned()];
    for layer in [0, 1] {
        let top = top_of(height, &stack[layer + 1..]);
        let steep_deg = landscape.materials[layer + 1].talus_deg + MARGIN_DEG;
        let steepest = libm::tan(steep_deg.to_radians());
        let too_steep =
            |&&at: &&usize| stack[layer].values()[at] > 0.01 && steepest_fall(&top, at, CELL) > steepest;
        cells.push(inner.iter().filter(too_steep).count().to_string());
    }
    let steepest = inner.iter().map(|&at| steepest_fall(height, at, CELL)).fold(0.0, f64::max);
    cells.push(format!("{:.0}", libm::atan(steepest).to_degrees()));
    Ok(cells)
}

/// The ground without the layers above.
fn top_of(height: &Field, above: &[Field]) -> Field {
    let bare = |at: usize| height.values()[at] - above.iter().map(|layer| layer.values()[at]).sum::<f32>();
    Field::from_values(height.size(), (0..height.size().cells()).map(bare).collect())
}
