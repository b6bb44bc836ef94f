//! Figures 1, 2 and 15: the shapes, and what their codes name.

use super::panels::{Panel, longest, points, row, rows, shape};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::Image;
use weald_picture::fractal::{ColourBy, Draw, Look};
use weald_plants::ifs::map::distance;
use weald_plants::ifs::{Code, Game, Ifs};

pub(in crate::figures) const FIGURE_1: Figure = Figure {
    id: "ifs-1",
    title: "The gasket and its codes",
    source: "Han and Kim 2007, fig. 1, eq. 2",
    shows: "Three maps halve the triangle; a code says in which third of a third of a third a point lies. 24 digits tell \
            points 2^-24 of the triangle apart.",
    seconds: 2,
    make: Make::Alone(|job| make("gasket", [1, 2, 4], job)),
};

pub(in crate::figures) const FIGURE_2: Figure = Figure {
    id: "ifs-2",
    title: "Barnsley's fern and its codes",
    source: "Han and Kim 2007, fig. 2; Barnsley 1988, table III.3",
    shows: "Four maps: stem, the fern without its lowest pair of fronds, the left frond, the right frond. Since the second \
            map shrinks by little (0.851), 64 digits are needed.",
    seconds: 2,
    make: Make::Alone(|job| make("fern", [1, 2, 4], job)),
};

pub(in crate::figures) const FIGURE_15: Figure = Figure {
    id: "ifs-15",
    title: "Digits name the parts of the fern",
    source: "Han and Kim 2007, fig. 15",
    shows: "Parts by their first digit: 0 the stem, 1 what goes on upward, 2 the lowest left frond, 3 the lowest right one. A \
            frond hangs from its joint, the point of its prefix followed by zeros.",
    seconds: 2,
    make: Make::Alone(joints),
};

fn make(name: &str, depths: [u32; 3], job: GalleryJob) -> Result<FigureOutput, Error> {
    let ifs = shape(name);
    let first = by(&ifs, &Look::default(), "random iteration", job)?;
    let opened = depths.map(|depth| {
        let look = Look { draw: Draw::Parts, depth: Some(depth), ..Look::default() };
        by(&ifs, &look, &format!("all codes of {depth} digits"), job)
    });
    let [one, two, three] = opened;
    let image = rows(&[Image::beside(&[first, one?], 8), Image::beside(&[two?, three?], 8)]);
    let off = single_precision(&ifs, job);
    let precision = ifs.precision(ifs.code_digits());
    let within = off <= precision + 1e-5;
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "codes",
            caption: format!("The {name}, and its parts of 1, 2 and 4 digits"),
            image,
        }],
        measured: Measured {
            header: texts([
                "digits",
                "greatest ratio",
                "precision by the ratios",
                "greatest distance measured",
            ]),
            rows: vec![vec![
                ifs.code_digits().to_string(),
                format!("{:.3}", ifs.ratio_of(1)),
                format!("{precision:.1e}"),
                format!("{off:.1e}"),
            ]],
            remarks: texts([
                "Measured: from points of random iteration in single precision to the points of their codes.",
            ]),
        },
        claims: vec![Claim::new(
            "The last maps taken, newest first, are the code of a point",
            Verdict::of(within),
            format!(
                "100,000 points lie within {off:.1e} of the points of their codes; the ratios allow {precision:.1e}, single precision 1e-5"
            ),
        )],
        ..FigureOutput::default()
    })
}

fn by(ifs: &Ifs, look: &Look, title: &str, job: GalleryJob) -> Result<Image, Error> {
    row(ifs, look, &[Panel { title, motion: None }], job)
}

fn single_precision(ifs: &Ifs, job: GalleryJob) -> f64 {
    let mut worst = 0.0_f64;
    Game::new(ifs, 3).points(job.choose(100_000, 2_000), |block| {
        for number in 0..block.len() {
            let code = block.code(number, ifs);
            worst = worst.max(distance(block.point(number).map(f64::from), ifs.point(&code)));
        }
    });
    worst
}

/// Prefixes of the source, and their joints in Barnsley's units.
const JOINTS: [(&str, [f64; 2]); 4] =
    [("2", [0.0, 1.6]), ("3", [0.0, 0.44]), ("13", [0.0176, 1.974]), ("113", [0.0939, 3.2772])];

fn joints(job: GalleryJob) -> Result<FigureOutput, Error> {
    let ifs = shape("fern");
    let coloured = Look { colour_by: ColourBy::Map, ..Look::default() };
    let apart = |point: [f64; 3], code: &Code| {
        // Fronds are moved aside, each from its joint, so that it is seen what belongs to which prefix.
        let aside = |text: &str, [x, y]: [f64; 2]| {
            code.starts_with(&prefix(&ifs, text)).then_some([point[0] + x, point[1] + y, point[2]])
        };
        let moved = aside("2", [-0.18, -0.02]).or_else(|| aside("3", [0.18, -0.06]));
        moved.or_else(|| aside("13", [0.2, 0.0])).or_else(|| aside("113", [0.22, 0.04])).unwrap_or(point)
    };
    let panels = [
        Panel { title: "by first digit", motion: None },
        Panel { title: "[2], [3], [1,3] and [1,1,3] moved aside", motion: Some(&apart) },
    ];
    let image = row(&ifs, &coloured, &panels, job)?;
    let found = JOINTS.map(|(text, expected)| {
        let [x, y, _] = ifs.point(&prefix(&ifs, text));
        (text, [10.0 * (x - 0.5), 10.0 * y], expected)
    });
    let off = found.iter().map(|(_, [x, y], [a, b])| (x - a).hypot(y - b)).fold(0.0, f64::max);
    let rows = found.iter().map(|(text, [x, y], [a, b])| {
        vec![format!("[{text}]"), format!("({x:.4}, {y:.4})"), format!("({a}, {b})")]
    });
    let moved = longest(&points(&ifs, job), apart);
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "parts",
            caption: format!("Parts by their first digit; four fronds moved by up to {moved:.2}"),
            image,
        }],
        measured: Measured {
            header: texts(["prefix", "joint", "joint in the source"]),
            rows: rows.collect(),
            remarks: Vec::new(),
        },
        claims: vec![Claim::new(
            "Digits 2 and 3 are the lowest fronds, and [1,3], [1,1,3] the second and third right one",
            Verdict::of(off < 1e-3),
            format!("the four joints lie within {off:.1e} of the source's"),
        )],
        ..FigureOutput::default()
    })
}

fn prefix(ifs: &Ifs, text: &str) -> Code {
    Code::parse(ifs.digits(), text).expect("digits of the fern")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Detail;

    #[test]
    fn the_joints_of_the_fern_are_those_of_the_source() {
        let output = joints(GalleryJob { detail: Detail::Draft }).expect("draws");
        assert_eq!(output.claims[0].verdict, Verdict::Shown, "{}", output.claims[0].measure);
        assert_eq!(output.measured.rows[2][2], "(0.0176, 1.974)");
    }
}
