//! Figure 16: parts of the fern turn and grow about their joints.

use super::panels::{Panel, deformation, points, row, shape};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::fractal::Look;
use weald_plants::ifs::deform::Part;
use weald_plants::ifs::map::distance;
use weald_plants::ifs::{Code, Deform, Ifs};

pub(in crate::figures) const FIGURE_16: Figure = Figure {
    id: "ifs-16",
    title: "Parts turn and grow about their joints",
    source: "Han and Kim 2007, fig. 16, eq. 17 to 20",
    shows: "The first left frond [2] turns, the second right one [1,3] turns the other way, the third right one [1,1,3] \
            grows. The source prints [3,…] for the second right frond; by its own fig. 15 it is [1,3]. Its angles and its \
            factor are lost; here they are 35°, -30° and 1.6.",
    seconds: 4,
    make: Make::Alone(make),
};

/// Prefix, angle in degrees, and factor.
const PARTS: [(&str, f64, f64); 3] = [("2", 35.0, 1.0), ("13", -30.0, 1.0), ("113", 0.0, 1.6)];

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let ifs = shape("fern");
    let parts: Vec<Part> = PARTS
        .iter()
        .map(|&(prefix, angle, factor)| Part::turned(prefix_of(&ifs, prefix), angle.to_radians(), factor))
        .collect();
    let bent = deformation(&ifs, parts.iter().copied().map(Deform::Part).collect())?;
    let motion = |point, code: &_| bent.apply(point, code);
    let panels = [
        Panel { title: "undeformed", motion: None },
        Panel { title: "[2] and [1,3] turned, [1,1,3] enlarged", motion: Some(&motion) },
    ];
    let image = row(&ifs, &Look::default(), &panels, job)?;
    let points = points(&ifs, job);
    let gap = |part: &Part| {
        let joint = ifs.point(&part.prefix);
        distance(bent.apply(joint, &part.prefix), joint)
    };
    let gaps: Vec<f64> = parts.iter().map(gap).collect();
    let rows = parts.iter().zip(&gaps).zip(PARTS).map(|((part, gap), (_, angle, factor))| {
        let share = points.iter().filter(|(_, code)| code.starts_with(&part.prefix)).count() as f64
            / points.len() as f64;
        vec![
            format!("{:?}", part.prefix),
            format!("{angle}°"),
            format!("{factor}"),
            format!("{gap}"),
            format!("{share:.4}"),
        ]
    });
    let outside: Vec<_> =
        points.iter().filter(|(_, code)| !parts.iter().any(|part| code.starts_with(&part.prefix))).collect();
    let same = outside.iter().filter(|(point, code)| bent.apply(*point, code) == *point).count();
    let measured = Measured {
        header: texts([
            "part",
            "turned by",
            "grown by",
            "distance of the joint from where it was",
            "share of the points",
        ]),
        rows: rows.collect(),
        remarks: vec![format!("Of {} other points {same} keep every bit.", outside.len())],
    };
    let caption = "The fern, and the fern with three parts moved".to_owned();
    Ok(FigureOutput {
        plates: vec![Plate { name: "parts", caption, image }],
        measured,
        claims: vec![
            Claim::new(
                "A part-wise map keeps its joint",
                Verdict::of(gaps.iter().all(|&gap| gap == 0.0)),
                format!("distances of the three joints: {gaps:?}"),
            ),
            Claim::new(
                "All other points stay",
                Verdict::of(same == outside.len()),
                format!("{same} of {} to the bit", outside.len()),
            ),
        ],
        ..FigureOutput::default()
    })
}

fn prefix_of(ifs: &Ifs, text: &str) -> Code {
    Code::parse(ifs.digits(), text).expect("digits of the fern")
}
