//! Banks that a river undercuts: they stand too steep, or slide.

use super::layered::{CUT_OPEN, Look, SOURCE, ground, material, simulated, steepest_fall};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_picture::Along;

pub(super) const FIGURE: Figure = Figure {
    id: "banks",
    title: "Slippage of undercut banks",
    source: SOURCE,
    shows: "A river cuts into its banks and makes them too steep to rest. Slippage lays each material back \
            to its own talus.",
    seconds: 2,
    make: Make::Alone(make),
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
    let stages = [("before", &start), ("after, without slippage", &cut), ("after, with slippage", &slid)];
    let caption = format!("Before, and after {iterations} steps without and with slippage: {CUT_OPEN}");
    let image = Look { exaggeration: 1.2, along: Along::Column, at: 0.5 }.stages(&stages)?;
    let plates = vec![Plate { name: "stages", caption, image }];
    let banks = ["before", "without slippage", "with slippage"].into_iter().zip(landscapes);
    let banks = banks.map(|(name, landscape)| Banks::of(name, landscape)).collect::<Result<Vec<_>, _>>()?;
    let measured = Measured {
        header: texts(["ground", "gravel too steep", "soil too steep", "steepest, °"]),
        rows: banks.iter().map(Banks::row).collect(),
        remarks: texts([
            "Cells whose layer falls to a neighbour more steeply than its talus by 5° or more, and the \
             steepest fall of the ground; the edge is left out.",
        ]),
    };
    Ok(FigureOutput { plates, measured, claims: claims(&banks), ..FigureOutput::default() })
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

/// How steep the ground stands.
struct Banks {
    name: &'static str,
    /// Cells of gravel and of soil that are too steep.
    too_steep: [usize; 2],
    steepest_deg: f64,
}

impl Banks {
    fn of(name: &'static str, landscape: &Landscape) -> Result<Self, Error> {
        let height = landscape.field("height")?;
        let stack = weald_core::strata::stack(landscape, height)?;
        let size = height.size();
        let inner: Vec<usize> =
            (2..size.rows - 2).flat_map(|y| (2..size.columns - 2).map(move |x| size.index(x, y))).collect();
        let too_steep = |layer: usize| {
            let top = top_of(height, &stack[layer + 1..]);
            let steepest_deg = landscape.materials[layer + 1].talus_deg + MARGIN_DEG;
            let steepest = libm::tan(steepest_deg.to_radians());
            let falls =
                |&&at: &&usize| stack[layer].values()[at] > 0.01 && steepest_fall(&top, at, CELL) > steepest;
            inner.iter().filter(falls).count()
        };
        let steepest = inner.iter().map(|&at| steepest_fall(height, at, CELL)).fold(0.0, f64::max);
        let steepest_deg = libm::atan(steepest).to_degrees();
        Ok(Self { name, too_steep: [0, 1].map(too_steep), steepest_deg })
    }

    fn row(&self) -> Vec<String> {
        let [gravel, soil] = self.too_steep.map(|cells| cells.to_string());
        vec![self.name.to_owned(), gravel, soil, format!("{:.0}", self.steepest_deg)]
    }
}

fn claims(banks: &[Banks]) -> Vec<Claim> {
    let [before, cut, slid] = [0, 1, 2].map(|stage| banks[stage].too_steep);
    let both = |[gravel, soil]: [usize; 2]| format!("{gravel} cells of gravel and {soil} of soil");
    vec![Claim::new(
        "Slippage lays undercut banks back to their talus",
        Verdict::of(before == [0, 0] && cut[1] > 0 && 10 * slid[1] < cut[1] && 10 * slid[0] <= cut[0]),
        format!("too steep are {} without slippage, {} with it", both(cut), both(slid)),
    )]
}

/// The ground without the layers above.
fn top_of(height: &Field, above: &[Field]) -> Field {
    let bare = |at: usize| height.values()[at] - above.iter().map(|layer| layer.values()[at]).sum::<f32>();
    Field::from_values(height.size(), (0..height.size().cells()).map(bare).collect())
}
