//! Figures 5 to 10: a field, looked up where changed codes point, x'' = x + V(x') (eq. 7).

use std::collections::BTreeSet;

use super::AMPLITUDE;
use super::panels::{Panel, deformation, longest, points, row, rows, shape, tear};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::Image;
use weald_picture::fractal::Look;
use weald_plants::ifs::deform::{
    CodeChange, Field, Frame, Insertion, Interval, Permutation, Replacement, Swap,
};
use weald_plants::ifs::expansion::parts;
use weald_plants::ifs::{Code, Deform, Ifs};

/// One figure: which change it makes, and what the source says of such changes.
struct Method {
    change: fn() -> Box<dyn CodeChange>,
    says: &'static str,
    /// Whether measures bear that out.
    holds: fn(&CodeMapProperties) -> bool,
}

const fn interval(from: usize, to: usize) -> Interval {
    Interval { from, to }
}

const PERMUTATION: Method = Method {
    change: || Box::new(Permutation(interval(5, 7))),
    says: "Permutation is a bijection of codes whose order is the number of maps",
    holds: |nature| nature.kept == 1.0 && nature.order == Some(nature.maps),
};

const SWAP_2: Method = Method { change: || swap(2), ..SWAP };
const SWAP_3: Method = Method { change: || swap(3), ..SWAP };
const SWAP: Method = Method {
    change: || swap(1),
    says: "Swapping twice is nothing",
    holds: |nature| nature.kept == 1.0 && nature.order == Some(2),
};

fn swap(place: usize) -> Box<dyn CodeChange> {
    Box::new(Swap { interval: interval(place, place), between: [1, 2] })
}

const INSERTION_1: Method = Method {
    change: || Box::new(Insertion { interval: interval(1, 4), digit: 0 }),
    says: "Insertion is injective and not onto",
    holds: |nature| nature.distinct == nature.codes && nature.kept < 1.0,
};
const INSERTION_2: Method =
    Method { change: || Box::new(Insertion { interval: interval(2, 5), digit: 0 }), ..INSERTION_1 };

const REPLACEMENT: Method = Method {
    change: || Box::new(Replacement { interval: interval(2, 4), digit: 2, with: 0 }),
    says: "Replacement is not injective and leaves ((N - 1)/N)³ of the codes; doing it again changes nothing",
    holds: |nature| {
        let share = (nature.maps as f64 - 1.0) / nature.maps as f64;
        (nature.kept - share.powi(3)).abs() < 1e-9 && nature.idempotent
    },
};

macro_rules! figure {
    ($name:ident, $id:literal, $title:literal, $source:literal, $shows:literal, $method:ident) => {
        pub(in crate::figures) const $name: Figure = Figure {
            id: $id,
            title: $title,
            source: $source,
            shows: $shows,
            seconds: 8,
            make: Make::Alone(|job| make(&$method, job)),
        };
    };
}

figure!(
    FIGURE_5,
    "ifs-5",
    "Codes permuted",
    "Han and Kim 2007, fig. 5, eq. 7 to 9",
    "Digits 5 to 7 become the next ones, m → m + 1 mod N.",
    PERMUTATION
);
figure!(
    FIGURE_6,
    "ifs-6",
    "Codes swapped in place 2",
    "Han and Kim 2007, fig. 6, eq. 10 and 11",
    "Digits 1 and 2 take each other's place 2.",
    SWAP_2
);
figure!(
    FIGURE_7,
    "ifs-7",
    "Codes swapped in place 3",
    "Han and Kim 2007, fig. 7, eq. 10 and 11",
    "Digits 1 and 2 take each other's place 3: a finer change than in place 2.",
    SWAP_3
);
figure!(
    FIGURE_8,
    "ifs-8",
    "Digits inserted from place 1",
    "Han and Kim 2007, fig. 8, eq. 12",
    "A 0 comes between digits 1 to 4, three in all.",
    INSERTION_1
);
figure!(
    FIGURE_9,
    "ifs-9",
    "Digits inserted from place 2",
    "Han and Kim 2007, fig. 9, eq. 12",
    "A 0 comes between digits 2 to 5, three in all.",
    INSERTION_2
);
figure!(
    FIGURE_10,
    "ifs-10",
    "Digits replaced",
    "Han and Kim 2007, fig. 10, eq. 13 and 14",
    "Digit 2 becomes 0 in places 2 to 4.",
    REPLACEMENT
);

fn make(method: &Method, job: GalleryJob) -> Result<FigureOutput, Error> {
    let mut measured = Measured {
        header: texts([
            "shape",
            "codes kept",
            "back after",
            "greatest |x' - x|",
            "bound",
            "greatest |x'' - x|",
            "torn",
        ]),
        ..Measured::default()
    };
    let (mut images, mut natures) = (Vec::new(), Vec::new());
    let mut within = true;
    for name in ["gasket", "fern"] {
        let shown = Shown::new(&shape(name), method, job)?;
        within &= shown.to_code <= shown.bound + 1e-12;
        measured.rows.push(shown.row(name));
        natures.push(shown.nature);
        images.push(shown.image);
    }
    let torn = measured.rows[0][6].clone();
    measured.remarks = texts([
        "Lengths are shares of the unit square. Torn: how far the two codes of (0.5, 0) part on the gasket.",
    ]);
    let caption =
        "Gasket and fern: undeformed, points of the changed codes x', and x'' = x + V(x')".to_owned();
    Ok(FigureOutput {
        plates: vec![Plate { name: "codes", caption, image: rows(&images) }],
        measured,
        claims: vec![
            Claim::new(
                method.says,
                Verdict::of(natures.iter().all(method.holds)),
                natures.iter().map(CodeMapProperties::in_words).collect::<Vec<_>>().join("; "),
            ),
            Claim::new(
                "No point moves further than the part of the digits before the interval is wide",
                Verdict::of(within),
                format!("greatest move beside its bound: see the table; the gasket is torn by {torn}"),
            ),
        ],
        ..FigureOutput::default()
    })
}

/// What a change does to one shape.
struct Shown {
    image: Image,
    nature: CodeMapProperties,
    to_code: f64,
    by_field: f64,
    bound: f64,
    torn: String,
}

impl Shown {
    fn new(ifs: &Ifs, method: &Method, job: GalleryJob) -> Result<Self, Error> {
        let change = method.change;
        let codes = deformation(ifs, vec![Deform::Codes(change())])?;
        let field = Deform::Field(Field::of_the_source(AMPLITUDE, Frame::UNIT));
        let bent = deformation(ifs, vec![field, Deform::Codes(change())])?;
        let to_code = |point, code: &_| codes.apply(point, code);
        let by_field = |point, code: &_| bent.apply(point, code);
        let panels = [
            Panel { title: "undeformed", motion: None },
            Panel { title: "points of the changed codes", motion: Some(&to_code) },
            Panel { title: "x + V(x')", motion: Some(&by_field) },
        ];
        let image = row(ifs, &Look::default(), &panels, job)?;
        let points = points(ifs, job);
        Ok(Self {
            image,
            nature: CodeMapProperties::of(ifs, change().as_ref())?,
            to_code: longest(&points, to_code),
            by_field: longest(&points, by_field),
            bound: ifs.precision(change().interval().from - 1),
            torn: if ifs.maps().len() == 3 { format!("{:.3}", tear(ifs, &bent)) } else { "-".to_owned() },
        })
    }

    fn row(&self, name: &str) -> Vec<String> {
        let order = self.nature.order.map_or("never".to_owned(), |order| format!("{order} times"));
        let numbers = [self.to_code, self.bound, self.by_field].map(|number| format!("{number:.3}"));
        let [to_code, bound, by_field] = numbers;
        let kept = format!("{:.3}", self.nature.kept);
        vec![name.to_owned(), kept, order, to_code, bound, by_field, self.torn.clone()]
    }
}

/// What a change is as a map of codes: measured on all codes down to the last digit that it changes.
struct CodeMapProperties {
    maps: usize,
    codes: usize,
    /// Codes that come out.
    distinct: usize,
    /// Share of all codes of that length that come out.
    kept: f64,
    /// After how many times every code is back.
    order: Option<usize>,
    idempotent: bool,
}

impl CodeMapProperties {
    fn of(ifs: &Ifs, change: &dyn CodeChange) -> Result<Self, Error> {
        let depth = change.interval().to;
        let changed = |code: &Code| change.change(code, ifs.digits());
        let mut codes = Vec::new();
        parts(ifs, depth, |part| codes.push(part.code))?;
        let distinct: BTreeSet<Code> = codes.iter().map(changed).collect();
        let maps = ifs.maps().len();
        let all = (maps as f64).powi((depth + change.lengthens()) as i32);
        let after = |times: usize, code: &Code| (0..times).fold(*code, |code, _| changed(&code));
        Ok(Self {
            maps,
            codes: codes.len(),
            distinct: distinct.len(),
            kept: distinct.len() as f64 / all,
            order: (1..=maps).find(|&times| codes.iter().all(|code| after(times, code) == *code)),
            idempotent: codes.iter().all(|code| after(2, code) == after(1, code)),
        })
    }

    fn in_words(&self) -> String {
        let Self { maps, codes, distinct, kept, .. } = self;
        let back = self.order.map_or("never back".to_owned(), |order| format!("back after {order}"));
        format!("{maps} maps: {codes} codes become {distinct}, a share of {kept:.3}, {back}")
    }
}
