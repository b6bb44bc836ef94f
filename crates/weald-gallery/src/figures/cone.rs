//! A steep cone under the thermal schemes: by axes it becomes a square pyramid, isotropically it stays round.

use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_land::analyse::contour::roundness;
use weald_picture::{Image, Picture, Relief, Tint};

pub(super) const FIGURE: Figure = Figure {
    id: "cone",
    title: "A cone under thermal weathering",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 2",
    shows: "Weathering that looks along the axes turns a cone into a pyramid; weathering by the slope of the \
            surface leaves it a cone.",
    seconds: 2,
    make: Make::Alone(make),
};

const SCHEMES: [&str; 3] = ["axis", "isotropic", "isotropic-symmetric"];

/// Slope of the cone before, in heights a cell; the angle of repose is 1.
const STEEPNESS: f64 = 2.0;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let (side, iterations) = job.choose((129, 4000), (33, 100));
    let start = cone(side)?;
    let mut images = vec![draw(&start)?];
    let mut shapes = vec![Shape::of("before", &start, &start)?];
    for scheme in SCHEMES {
        let mut landscape = start.clone();
        let keys = format!("scheme = {scheme:?}\ntalus = 1.0\nstrength = 0.2\niterations = {iterations}");
        run_steps(&mut landscape, 0, &[("thermal", &keys)])?;
        images.push(draw(&landscape)?);
        shapes.push(Shape::of(scheme, &start, &landscape)?);
    }
    let caption = format!("Before; and after {iterations} steps by axes, isotropic, isotropic and symmetric");
    Ok(FigureOutput {
        plates: vec![Plate { name: "schemes", caption, image: Image::beside(&images, 8) }],
        measured: Measured {
            header: texts([
                "scheme",
                "least / greatest contour radius",
                "mean slope",
                "volume error",
                "difference when turned",
            ]),
            rows: shapes.iter().map(Shape::row).collect(),
            remarks: texts([
                "Radius of the contour at half height; slope over the middle half of the flank; volume \
                 relative to the start; greatest height difference, in cells, to the result turned by 90°.",
            ]),
        },
        claims: claims(&shapes),
        ..FigureOutput::default()
    })
}

/// A circle at half height is told from other shapes down to this ratio of its radii.
const ROUND: f64 = 0.98;

/// A square has 0.71; the one that weathering by axes makes is a little rounder.
const SQUARE: f64 = 0.85;

fn claims(shapes: &[Shape]) -> Vec<Claim> {
    let roundness: Vec<f64> = shapes[1..].iter().map(|shape| shape.roundness.unwrap_or(0.0)).collect();
    let [by_axes, isotropic] = [roundness[0], roundness[1].min(roundness[2])];
    vec![
        Claim::new(
            "Weathering along the axes turns a cone into a pyramid",
            Verdict::of(by_axes < SQUARE),
            format!("least over greatest radius {by_axes:.3}; 1 is a circle, 0.707 a square"),
        ),
        Claim::new(
            "Weathering by the slope of the surface leaves it a cone",
            Verdict::of(isotropic >= ROUND),
            format!("least over greatest radius {isotropic:.3}"),
        ),
    ]
}

fn cone(side: usize) -> Result<Landscape, Error> {
    let mut landscape = Landscape::new(Domain::new(Size::square(side)?, 1.0));
    // The foot stays clear of the border, also after the flank has slid to the slope of repose.
    let peak = STEEPNESS * side as f64 / 4.0;
    run_steps(&mut landscape, 0, &[("cone", &format!("peak = {peak:?}\nslope = {STEEPNESS:?}"))])?;
    Ok(landscape)
}

fn draw(landscape: &Landscape) -> Result<Image, Error> {
    Relief { width: Some(440), ramp: Tint::Desert, exaggeration: Some(0.6), ..Relief::default() }
        .render(landscape)
}

/// What is left of the cone.
struct Shape {
    scheme: &'static str,
    /// `None` where the contour at half height is not closed.
    roundness: Option<f64>,
    slope: f64,
    volume_error: f64,
    turned: f32,
}

impl Shape {
    fn of(scheme: &'static str, start: &Landscape, landscape: &Landscape) -> Result<Self, Error> {
        let (before, height) = (start.field("height")?, landscape.field("height")?);
        let centre = (height.size().columns / 2) as f64;
        let (low, high) = height.range(None).unwrap_or((0.0, 0.0));
        Ok(Self {
            scheme,
            roundness: roundness(height, [centre; 2], f64::from(low + high) / 2.0),
            slope: mean_slope(height),
            volume_error: (height.sum() - before.sum()).abs() / before.sum(),
            turned: turned_difference(height),
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.scheme.to_owned(),
            self.roundness.map_or_else(|| "open".to_owned(), |round| format!("{round:.3}")),
            format!("{:.2}", self.slope),
            brief(self.volume_error),
            brief(f64::from(self.turned)),
        ]
    }
}

/// A small number in one digit; 0 where it is exactly that.
fn brief(number: f64) -> String {
    if number == 0.0 { "0".to_owned() } else { format!("{number:.0e}") }
}

/// Mean slope of the cells between a quarter and three quarters of the height.
fn mean_slope(height: &Field) -> f64 {
    let size = height.size();
    let (low, high) = height.range(None).unwrap_or((0.0, 0.0));
    let flank = low + 0.25 * (high - low)..low + 0.75 * (high - low);
    let (mut sum, mut count) = (0.0, 0.0);
    for y in 1..size.rows - 1 {
        for x in (1..size.columns - 1).filter(|&x| flank.contains(&height.at(x, y))) {
            let east = f64::from(height.at(x + 1, y) - height.at(x - 1, y)) / 2.0;
            let south = f64::from(height.at(x, y + 1) - height.at(x, y - 1)) / 2.0;
            sum += (east * east + south * south).sqrt();
            count += 1.0;
        }
    }
    sum / f64::max(count, 1.0)
}

fn turned_difference(height: &Field) -> f32 {
    let last = height.size().columns - 1;
    let difference = |x: usize, y: usize| (height.at(x, y) - height.at(last - y, x)).abs();
    (0..=last).flat_map(|y| (0..=last).map(move |x| difference(x, y))).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bump_beside_the_axis_differs_by_its_height_when_turned_and_one_on_it_does_not() {
        let size = Size::square(3).expect("small");
        let bump = |at: [usize; 2]| Field::from_function(size, |x, y| if [x, y] == at { 2.5 } else { 0.0 });
        assert_eq!(turned_difference(&bump([1, 1])), 0.0);
        assert_eq!(turned_difference(&bump([1, 0])), 2.5);
    }
}
