//! Figures 3 and 4: a continuous field bends the gasket and the fern.

use super::AMPLITUDE;
use super::panels::{Panel, deformation, longest, points, row, shape, tear};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::fractal::Look;
use weald_plants::ifs::Deform;
use weald_plants::ifs::deform::{Field, Frame};

const SHOWS: &str = "x' = x + V(x) with V = (5A(y - 0.3)³, A x(x² - 1.5x + y + 0.5)). A is lost in the source; here it is 0.4. \
    Neighbours stay neighbours: the shape bends and does not tear.";

pub(in crate::figures) const FIGURE_3: Figure = Figure {
    id: "ifs-3",
    title: "A field bends the gasket",
    source: "Han and Kim 2007, fig. 3, eq. 5 and 6",
    shows: SHOWS,
    seconds: 2,
    make: Make::Alone(|job| make("gasket", job)),
};

pub(in crate::figures) const FIGURE_4: Figure = Figure {
    id: "ifs-4",
    title: "A field bends the fern",
    source: "Han and Kim 2007, fig. 4, eq. 5 and 6",
    shows: SHOWS,
    seconds: 2,
    make: Make::Alone(|job| make("fern", job)),
};

/// Distance of neighbours of which the stretch is measured, in units of the square.
const NEAR: f64 = 1e-4;

fn make(name: &str, job: GalleryJob) -> Result<FigureOutput, Error> {
    let ifs = shape(name);
    let field = Field::of_the_source(AMPLITUDE, Frame::UNIT);
    let bent = deformation(&ifs, vec![Deform::Field(field.clone())])?;
    let motion = |point, code: &_| bent.apply(point, code);
    let panels =
        [Panel { title: "undeformed", motion: None }, Panel { title: "x + V(x)", motion: Some(&motion) }];
    let image = row(&ifs, &Look::default(), &panels, job)?;
    let points = points(&ifs, job);
    let moved = longest(&points, motion);
    let stretch = points.iter().map(|([x, y, z], _)| {
        let (here, there) = (field.at([*x, *y, *z]), field.at([x + NEAR, y + NEAR, *z]));
        (there[0] - here[0]).hypot(there[1] - here[1]) / (NEAR * std::f64::consts::SQRT_2)
    });
    let stretch = stretch.fold(0.0, f64::max);
    let gasket = shape("gasket");
    let torn = tear(&gasket, &deformation(&gasket, vec![Deform::Field(field)])?);
    Ok(FigureOutput {
        plates: vec![Plate { name: "bent", caption: "Undeformed, and bent by the field".to_owned(), image }],
        measured: Measured {
            header: texts(["greatest shift", "most that neighbours' shifts differ, of their distance"]),
            rows: vec![vec![format!("{moved:.3}"), format!("{stretch:.2}")]],
            remarks: texts(["Lengths are shares of the unit square."]),
        },
        claims: vec![Claim::new(
            "A continuous field bends without tearing",
            Verdict::of(torn < 1e-6 && stretch.is_finite() && moved > 0.05),
            format!("the two codes of (0.5, 0) stay {torn:.1e} apart; points move up to {moved:.3}"),
        )],
        ..FigureOutput::default()
    })
}
