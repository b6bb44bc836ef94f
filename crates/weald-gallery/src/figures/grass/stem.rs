//! Figure 6: the stem of a blade, a clamped B-spline, with its control points at each level.

use super::chart::{Chart, GREEN, GREY, RED};
use crate::figures::views::laid_out;
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_picture::Image;
use weald_plants::grass::spline::clamped;
use weald_plants::grass::{Bend, Growth, LEVELS, Spline};

pub(in crate::figures) const FIGURE_6: Figure = Figure {
    id: "grass-6",
    title: "The stem of a blade",
    source: "Kim and Cho 2009, fig. 6, eq. 1 and 8",
    shows: "The clamped uniform cubic B-spline through the points of each level; it begins in the root and ends in the tip. \
        Above with the bend of the whole blade, below as printed, where each level turns the whole stem again.",
    seconds: 1,
    make: Make::Alone(|job| Ok(make(job))),
};

/// Good soil in the light in which grass grows tallest.
fn growth() -> Growth {
    Growth::of(0.85, 0.6, 0.95)
}

fn make(job: GalleryJob) -> FigureOutput {
    let growth = growth();
    let charts =
        [Bend::Total, Bend::Printed].iter().flat_map(|&bend| (1..=LEVELS).map(move |level| (bend, level)));
    let charts: Vec<_> = charts.map(|(bend, level)| drawn(&growth, bend, level, job)).collect();
    let [total, printed] = [Bend::Total, Bend::Printed].map(|bend| growth.points(bend));
    let ends = (1..=LEVELS).map(|level| {
        let spline = Spline::of(&total, level as f32);
        apart(spline.at(0.0).0, total[0]).max(apart(spline.at(1.0).0, total[level]))
    });
    let ends = ends.fold(0.0, f32::max);
    let row = |level: usize| {
        let text = |[up, out]: [f32; 2]| format!("{up:.2} up, {out:.2} out");
        vec![level.to_string(), text(total[level]), text(printed[level])]
    };
    FigureOutput {
        plates: vec![Plate {
            name: "splines",
            caption: "Levels 1 to 4 with their control points (red): θ as the bend of the whole blade, and as printed".to_owned(),
            image: laid_out(&charts, LEVELS),
        }],
        measured: Measured {
            header: texts(["level", "tip, bend of the whole", "tip, as printed"]),
            rows: (1..=LEVELS).map(row).collect(),
            remarks: vec![format!("β = {:.3}, θ = {:.1}°.", growth.height, growth.bend.to_degrees())],
        },
        claims: vec![
            Claim::new(
                "The stem begins in the root and ends in the tip",
                Verdict::of(ends < 1e-5 && apart(clamped(&total, 1.0), total[LEVELS]) < 1e-5),
                format!("it is at most {ends:.1e} away"),
            ),
            Claim::new(
                "A blade that turns by θ at each level stays above its root",
                Verdict::of(printed[LEVELS][0] > 0.0),
                format!(
                    "printed, its tip is {:.2} above the root; with θ as the whole bend, {:.2}",
                    printed[LEVELS][0], total[LEVELS][0]
                ),
            ),
        ], ..FigureOutput::default() }
}

fn drawn(growth: &Growth, bend: Bend, level: usize, job: GalleryJob) -> Image {
    let points = growth.points(bend);
    let spline = Spline::of(&points, level as f32);
    let low = if bend == Bend::Printed { -2.5 } else { 0.0 };
    let side = job.choose(300, 120);
    let mut chart =
        Chart::new([side, side], [-0.5, 3.0], [low, low + 3.5]).even().axes(0.5, ["outwards", "up"]);
    chart.line(&[[-0.5, 0.0], [3.0, 0.0]], GREY, 1.5);
    let place = |[up, out]: [f32; 2]| [out, up];
    chart.controls(&points[..=level].iter().map(|&point| place(point)).collect::<Vec<_>>(), RED);
    let curve: Vec<_> = (0..=80).map(|step| place(spline.at(step as f32 / 80.0).0)).collect();
    chart.line(&curve, GREEN, 2.6);
    for (number, &point) in points[..=level].iter().enumerate() {
        chart.word(&format!("P{number}"), place(point), RED);
    }
    let title =
        if bend == Bend::Printed { format!("level {level}, as printed") } else { format!("level {level}") };
    chart.image().titled(&title)
}

fn apart(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
