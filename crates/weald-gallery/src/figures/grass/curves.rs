//! Figures 2 and 3: what soil and light do to a blade, with the control points that can be moved.

use super::chart::{Chart, GREEN, RED};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_picture::Image;
use weald_plants::grass::curves::JOINT;
use weald_plants::grass::{Curves, LightCurve};

/// Pixels between charts.
const GAP: usize = 12;

pub(in crate::figures) const FIGURE_2: Figure = Figure {
    id: "grass-2",
    title: "What soil does",
    source: "Kim and Cho 2009, fig. 2, eq. 2",
    shows: "f1 from the soil, 0 to 1, through three control values that can be moved: the better the soil, the more a \
        blade grows. The source's values are lost; ours are 0.1, 0.6, 1.",
    seconds: 1,
    make: Make::Alone(|job| Ok(soil(job))),
};

pub(in crate::figures) const FIGURE_3: Figure = Figure {
    id: "grass-3",
    title: "What light does",
    source: "Kim and Cho 2009, fig. 3, eq. 3 and 4",
    shows: "f2 for width and f3 for height from the light, in two arcs that meet at 0.3, through five control values: width \
        rises with light, height is greatest in weak light and falls in strong light. As printed, with the light itself in \
        both arcs (red), the curves jump where they should meet.",
    seconds: 1,
    make: Make::Alone(|job| Ok(light(job))),
};

fn sheet(job: GalleryJob) -> Chart {
    let size = job.choose([460, 340], [160, 120]);
    Chart::new(size, [0.0, 1.0], [0.0, 1.0])
}

fn soil(job: GalleryJob) -> FigureOutput {
    let curve = Curves::OF_THE_SOURCE.soil;
    let mut chart = sheet(job).axes(0.2, ["soil", "f1"]);
    let controls: Vec<_> = curve.values().into_iter().zip([0.0, 0.5, 1.0]).map(|(y, x)| [x, y]).collect();
    chart.controls(&controls, RED);
    chart.curve(|soil| curve.at(soil), [0.0, 1.0], GREEN);
    let at = |step: usize| curve.at(step as f32 / 1000.0);
    let rises = (0..1000).all(|step| at(step) < at(step + 1));
    FigureOutput {
        plates: vec![Plate {
            name: "soil",
            caption: "The answer to soil with its control points".to_owned(),
            image: chart.image(),
        }],
        measured: Measured::default(),
        claims: vec![Claim::new(
            "The better the soil, the more a blade grows",
            Verdict::of(rises),
            format!("f1 rises from {:.2} to {:.2}", at(0), at(1000)),
        )],
        ..FigureOutput::default()
    }
}

fn light(job: GalleryJob) -> FigureOutput {
    let Curves { width, height, .. } = Curves::OF_THE_SOURCE;
    let charts = [(width, "f2, width"), (height, "f3, height")].map(|(curve, name)| drawn(curve, name, job));
    let widest = (0..1000).all(|step| {
        let [here, there] = [step, step + 1].map(|step| width.at(step as f32 / 1000.0));
        here <= there + 1e-6
    });
    let [weak, strong] = [0.25, 1.0].map(|light| height.at(light));
    let jump = |curve: LightCurve| (curve.printed(JOINT + 1e-6) - curve.printed(JOINT)).abs();
    let gap = |curve: LightCurve| (curve.at(JOINT + 1e-6) - curve.at(JOINT)).abs();
    let row = |name: &str, curve: LightCurve| {
        vec![
            name.to_owned(),
            format!("{:.3}", jump(curve)),
            format!("{:.6}", gap(curve)),
            format!("{:.2}", curve.kink()),
        ]
    };
    FigureOutput {
        plates: vec![Plate {
            name: "light",
            caption: "The answers of width and height to light, with their control points; in red as printed"
                .to_owned(),
            image: Image::beside(&charts, GAP),
        }],
        measured: Measured {
            header: texts(["curve", "jump at 0.3 as printed", "jump here", "change of slope here"]),
            rows: vec![row("width", width), row("height", height)],
            remarks: Vec::new(),
        },
        claims: vec![
            Claim::new(
                "Width rises with light",
                Verdict::of(widest),
                format!("f2 goes from {:.2} to {:.2}", width.at(0.0), width.at(1.0)),
            ),
            Claim::new(
                "Height is great in weak light and falls in strong light",
                Verdict::of(weak > 2.0 * strong),
                format!("f3 is {weak:.2} at light 0.25 and {strong:.2} at 1"),
            ),
            Claim::new(
                "The printed arcs make one curve",
                Verdict::of(jump(width).max(jump(height)) < 1e-3),
                format!(
                    "they are up to {:.2} apart at 0.3; with t in place of the light they meet",
                    jump(width).max(jump(height))
                ),
            ),
        ],
        ..FigureOutput::default()
    }
}

fn drawn(curve: LightCurve, name: &str, job: GalleryJob) -> Image {
    let mut chart = sheet(job).axes(0.2, ["light", name]);
    for part in [[0.0, JOINT], [JOINT + 1e-6, 1.0]] {
        chart.curve(|light| curve.printed(light), part, RED);
    }
    let places = [0.0, 0.5 * JOINT, JOINT, 0.5 * (1.0 + JOINT), 1.0];
    let controls: Vec<_> = curve.values().into_iter().zip(places).map(|(y, x)| [x, y]).collect();
    chart.controls(&controls, GREEN);
    chart.curve(|light| curve.at(light), [0.0, 1.0], GREEN);
    chart.image()
}
