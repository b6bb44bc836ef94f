//! Figure 8 and tables 1 to 3: frames per second against the number of sets, the level of growth and the distance.

use super::chart::{Chart, GREEN, RED};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::error::Error;
use weald_picture::{GrassRate, RenderDevice};

pub(in crate::figures) const FIGURE_8: Figure = Figure {
    id: "grass-8",
    title: "How fast grass is drawn",
    source: "Kim and Cho 2009, fig. 8, tables 1 to 3 (Core 2 Duo E8500, GeForce 9600 GT)",
    shows: "Frames per second against sets of six blades (table 1, fig. 8), against levels of growth (table 2), and from \
        afar, from the eye level and from near (table 3). Tables 1 and 2 draw every set with all its vertices; table \
        3 leaves out those that are not in sight.",
    seconds: 150,
    make: Make::Drawn(make),
};

/// Sets from which on more of them take longer to be drawn.
const FEW: u64 = 4_000;

/// Lowest and highest rate of the chart, as powers of ten.
const RATES: [f32; 2] = [-2.0, 4.0];

fn make(job: GalleryJob, device: &dyn RenderDevice) -> Result<FigureOutput, Error> {
    let rates = device.grass_rates(job.choose(u32::MAX, 100))?;
    let of = |table: u8| rates.iter().filter(move |rate| rate.table == table);
    let levels: Vec<_> = of(2).filter(|rate| rate.sets > 75_000).collect();
    let mut claims = claims_of_sets(&of(1).collect::<Vec<_>>());
    if let [first, .., last] = levels[..] {
        claims.push(claim_of_levels(first, last));
    }
    let [width, height] = rates.first().map_or([0, 0], |rate| rate.size);
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "sets",
            caption: "Frames per second against sets, as powers of ten: here (green) and in the source (red)"
                .to_owned(),
            image: chart(&of(1).collect::<Vec<_>>(), job).image(),
        }],
        measured: Measured {
            header: texts(["table", "view", "level", "sets", "drawn", "frames/s here", "in the source"]),
            rows: rates.iter().map(row).collect(),
            remarks: vec![format!(
                "Drawn in {width} × {height} pixels with 4 samples on {}; rates differ from run to run.",
                device.adapter()
            )],
        },
        claims,
        ..FigureOutput::default()
    })
}

fn row(rate: &GrassRate) -> Vec<String> {
    vec![
        rate.table.to_string(),
        rate.view.to_owned(),
        rate.level.to_string(),
        rate.sets.to_string(),
        rate.drawn.to_string(),
        format!("{:.2}", rate.rate),
        format!("{:.2}", rate.source),
    ]
}

fn chart(rates: &[&GrassRate], job: GalleryJob) -> Chart {
    let mut chart = Chart::new(job.choose([560, 400], [160, 120]), [0.0, 5.2], RATES);
    chart = chart.axes(1.0, ["log sets", "log frames/s"]);
    let log = |value: f64| value.log10() as f32;
    let line = |of: fn(&GrassRate) -> f64| -> Vec<_> {
        rates.iter().map(|rate| [log(rate.sets.max(1) as f64), log(of(rate)).max(RATES[0])]).collect()
    };
    chart.line(&line(|rate| rate.source), RED, 1.6);
    chart.line(&line(|rate| rate.rate), GREEN, 1.6);
    chart
}

/// Frames per second at which the source draws the most sets.
const SOURCE_RATE: f64 = 12.0;

fn claims_of_sets(rates: &[&GrassRate]) -> Vec<Claim> {
    // Few sets take no longer than the ground they stand on.
    let many: Vec<_> = rates.iter().filter(|rate| rate.sets > FEW).collect();
    let falls = many.windows(2).all(|pair| pair[1].rate < pair[0].rate);
    let [first, last] =
        [rates.first(), rates.last()].map(|rate| rate.map_or((0, 0.0), |rate| (rate.sets, rate.rate)));
    vec![
        Claim::new(
            "More sets are drawn more slowly",
            Verdict::of(falls && last.1 < first.1),
            format!("{:.1} frames per second with {} sets, {:.2} with {}", first.1, first.0, last.1, last.0),
        ),
        Claim::new(
            "100,000 sets are drawn at 12 frames per second",
            Verdict::of(last.1 >= SOURCE_RATE),
            format!("{:.2} with {}", last.1, last.0),
        ),
    ]
}

fn claim_of_levels(first: &GrassRate, last: &GrassRate) -> Claim {
    Claim::new(
        "Time goes with the level, as vertices do",
        Verdict::of(first.rate > 1.5 * last.rate),
        format!(
            "level {} is drawn {:.1} times as fast as level {}; in the source {:.1} times",
            first.level,
            first.rate / last.rate,
            last.level,
            first.source / last.source
        ),
    )
}
