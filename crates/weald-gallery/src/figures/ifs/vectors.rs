//! Figures 11 to 14: displacement vectors, alone and together with a field.

use super::AMPLITUDE;
use super::panels::{Panel, deformation, longest, points, row, rows, shape};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::Image;
use weald_picture::fractal::Look;
use weald_plants::ifs::deform::{Displacement, Field, Frame, Interval};
use weald_plants::ifs::{Deform, Ifs};

/// One figure.
struct Vectors {
    interval: Interval,
    delta: f64,
    with_field: bool,
}

const COARSEST: Vectors = Vectors { interval: Interval { from: 1, to: 1 }, delta: 0.65, with_field: false };
const FINER: Vectors = Vectors { interval: Interval { from: 3, to: 5 }, ..COARSEST };
const SMALL_DELTA: Vectors = Vectors { delta: 0.5, with_field: true, ..FINER };
const LARGE_DELTA: Vectors = Vectors { with_field: true, ..FINER };

macro_rules! figure {
    ($name:ident, $id:literal, $title:literal, $source:literal, $shows:literal, $vectors:ident) => {
        pub(in crate::figures) const $name: Figure = Figure {
            id: $id,
            title: $title,
            source: $source,
            shows: $shows,
            seconds: 6,
            make: Make::Alone(|job| make(&$vectors, job)),
        };
    };
}

figure!(
    FIGURE_11,
    "ifs-11",
    "Vectors for the first digit",
    "Han and Kim 2007, fig. 11, eq. 15",
    "Each largest part is pushed by a vector of its own: (0.1, 0.1), (0.1, 0.2), (0.2, 0), (-0.3, -0.1) for digits 0 to 3.",
    COARSEST
);
figure!(
    FIGURE_12,
    "ifs-12",
    "Vectors for digits 3 to 5",
    "Han and Kim 2007, fig. 12, eq. 15",
    "The same vectors for digits 3 to 5, each finer one shorter by 0.65.",
    FINER
);
figure!(
    FIGURE_13,
    "ifs-13",
    "Field and vectors, delta 0.5",
    "Han and Kim 2007, fig. 13, eq. 16",
    "x + V(x) + the sum for digits 3 to 5 with delta 0.5.",
    SMALL_DELTA
);
figure!(
    FIGURE_14,
    "ifs-14",
    "Field and vectors, delta 0.65",
    "Han and Kim 2007, fig. 14, eq. 16",
    "The same with delta 0.65: finer digits push further than with 0.5.",
    LARGE_DELTA
);

/// The fern in its own units, ten high, takes vectors as a tenth of what they are to the unit square.
const TENTH: Frame = Frame { scale: 10.0, shift: [0.0; 3] };

impl Vectors {
    fn displacement(&self, frame: Frame) -> Displacement {
        let vectors = Displacement::OF_THE_SOURCE.to_vec();
        Displacement { interval: self.interval, delta: self.delta, vectors, frame }
    }

    fn deforms(&self, frame: Frame) -> Vec<Deform> {
        let field = self.with_field.then(|| Deform::Field(Field::of_the_source(AMPLITUDE, Frame::UNIT)));
        field.into_iter().chain([Deform::Displacement(self.displacement(frame))]).collect()
    }
}

fn make(vectors: &Vectors, job: GalleryJob) -> Result<FigureOutput, Error> {
    let (gasket, fern) = (shape("gasket"), shape("fern"));
    let drawn = [(&gasket, Frame::UNIT, "in the unit square"), (&fern, TENTH, "in the fern's own units")];
    let images = drawn.iter().map(|(ifs, frame, title)| pair(ifs, vectors, *frame, title, job));
    let mut images = images.collect::<Result<Vec<_>, Error>>()?;
    images.push(pair(&fern, vectors, Frame::UNIT, "in the unit square", job)?);
    let mut measured = Measured {
        header: texts(["shape", "vectors", "greatest shift by vectors", "bound"]),
        ..Measured::default()
    };
    let mut within = true;
    for (name, ifs, frame, units) in [
        ("gasket", &gasket, Frame::UNIT, "as printed"),
        ("fern", &fern, Frame::UNIT, "as printed"),
        ("fern", &fern, TENTH, "in the fern's own units, a tenth"),
    ] {
        let displacement = vectors.displacement(frame);
        let alone = deformation(ifs, vec![Deform::Displacement(displacement.clone())])?;
        let shift = longest(&points(ifs, job), |point, code| alone.apply(point, code));
        within &= shift <= displacement.bound() * (1.0 + 1e-9) && shift > 0.0;
        measured.rows.push(vec![
            name.to_owned(),
            units.to_owned(),
            format!("{shift:.3}"),
            format!("{:.3}", displacement.bound()),
        ]);
    }
    let other = Vectors { delta: 0.5, ..LARGE_DELTA }.displacement(Frame::UNIT).bound();
    let larger = LARGE_DELTA.displacement(Frame::UNIT).bound();
    let caption = "Undeformed and deformed: the gasket; the fern with vectors in its own units (a tenth of the square's); \
        the fern with vectors as printed".to_owned();
    Ok(FigureOutput {
        plates: vec![Plate { name: "vectors", caption, image: rows(&images) }],
        measured,
        claims: vec![
            Claim::new(
                "No shift is longer than max |d| (1 - delta^length)/(1 - delta)",
                Verdict::of(within),
                "greatest shift of 100,000 points beside the bound: see the table",
            ),
            Claim::new(
                "A smaller delta changes less",
                Verdict::of(other < larger),
                format!("bounds for digits 3 to 5: {other:.3} with 0.5, {larger:.3} with 0.65"),
            ),
        ],
        ..FigureOutput::default()
    })
}

/// A shape undeformed and deformed.
fn pair(ifs: &Ifs, vectors: &Vectors, frame: Frame, title: &str, job: GalleryJob) -> Result<Image, Error> {
    let bent = deformation(ifs, vectors.deforms(frame))?;
    let motion = |point, code: &_| bent.apply(point, code);
    let title = format!("vectors {title}");
    let panels =
        [Panel { title: "undeformed", motion: None }, Panel { title: &title, motion: Some(&motion) }];
    row(ifs, &Look::default(), &panels, job)
}
