//! Rivers by velocity-dependent erosion, without and with thermal weathering.

use super::han::{self, FinishedRun, MEANING, RULE, Run, header, row, weathered};
use super::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, views};
use weald_core::error::Error;
use weald_picture::{Image, Picture, Section};

pub(super) const FIGURE: Figure = Figure {
    id: "erosion",
    title: "Rivers, without and with thermal weathering",
    source: "Han 2015, doi 10.7583/JKGS.2015.15.6.171, Fig. 6",
    shows: "Erosion that depends on the velocity of water cuts a network of channels; thermal weathering opens \
            them into V-shaped valleys with mountains between.",
    seconds: 4,
    make: Make::Alone(make),
};

/// Tangent of the angle at which the ground rests.
const TALUS: f64 = 0.8;

fn make(job: GalleryJob) -> Result<FigureOutput, Error> {
    let runs = [
        Run::new(job, "water only", "erosion = 0.0"),
        Run::new(job, "erosion", ""),
        Run::new(job, "erosion and weathering", &weathered(TALUS)),
    ];
    let runs = han::run_all(&runs)?;
    let width = job.choose(520, 32);
    let relief = views::sheet(&runs, 3, |landscape| views::relief(landscape, width))?;
    let flow = views::sheet(&runs, 3, |landscape| views::flow(landscape, width))?;
    Ok(FigureOutput {
        plates: vec![
            views::plate("relief", "Ground and water", &runs, relief),
            views::plate(
                "flow",
                "Rivers and lakes, rivers as wide as the root of their mean discharge,",
                &runs,
                flow,
            ),
            section(job, &runs)?,
        ],
        measured: measured(&runs),
        claims: claims(&runs),
        ..FigureOutput::default()
    })
}

/// The mountains of the middle cut open.
fn section(job: GalleryJob, runs: &[FinishedRun]) -> Result<Plate, Error> {
    let (side, corner) = job.choose((112, 96), (16, 8));
    let cut = |ran: &FinishedRun| -> Result<Image, Error> {
        let part = views::part(&ran.landscape, [corner; 2], side)?;
        let picture = Section {
            width: job.choose(1120, 64),
            exaggeration: Some(1.0),
            water: false,
            ..Section::default()
        };
        Ok(picture.render(&part)?.titled(&ran.run.name))
    };
    let images = runs.iter().map(cut).collect::<Result<Vec<_>, _>>()?;
    let what = format!("{side} cells of the mountains cut open from west to east, from top to bottom,");
    Ok(views::plate("section", &what, runs, views::laid_out(&images, 1)))
}

fn measured(runs: &[FinishedRun]) -> Measured {
    let more = ["valley width", "shape", "steepest tenth, °"].map(str::to_owned);
    let row = |ran: &FinishedRun| {
        let [width, shape] = form(ran);
        let more = [format!("{width:.1}"), format!("{shape:.2}"), format!("{:.0}", steep_deg(ran))];
        [row(ran), more.to_vec()].concat()
    };
    Measured {
        header: [header(), more.to_vec()].concat(),
        rows: runs.iter().map(row).collect(),
        remarks: vec![MEANING.to_owned(), MEANING_OF_FORM.to_owned()],
    }
}

const MEANING_OF_FORM: &str = "Valleys as rows and columns of the grid cut them, where they are a cell \
                               deep or more: mean width at half their depth in cells, and `shape`, the \
                               ratio of their widths at a quarter and at three quarters of the depth, a \
                               third for a V and 1 for a slot. The steepest tenth: slope that one cell in \
                               ten exceeds.";

/// Width and shape of the valleys; 0 where there are none.
fn form(ran: &FinishedRun) -> [f64; 2] {
    ran.measures.valleys.map_or([0.0; 2], |form| [form.width, form.shape])
}

/// Slope in degrees that one cell in ten exceeds.
fn steep_deg(ran: &FinishedRun) -> f64 {
    let (ground, size) = (ran.ground(), ran.ground().size());
    let slope = |x: usize, y: usize| {
        let east = f64::from(ground.at(x + 1, y) - ground.at(x - 1, y)) / 2.0;
        let south = f64::from(ground.at(x, y + 1) - ground.at(x, y - 1)) / 2.0;
        (east * east + south * south).sqrt()
    };
    let mut slopes: Vec<f64> =
        (1..size.rows - 1).flat_map(|y| (1..size.columns - 1).map(move |x| slope(x, y))).collect();
    slopes.sort_unstable_by(f64::total_cmp);
    libm::atan(slopes[slopes.len() * 9 / 10]).to_degrees()
}

fn claims(runs: &[FinishedRun]) -> Vec<Claim> {
    let [water, eroded, weathered] = [&runs[0], &runs[1], &runs[2]];
    let [[slot, slot_shape], [valley, valley_shape]] = [form(eroded), form(weathered)];
    let [steep, rests] = [steep_deg(eroded), steep_deg(weathered)];
    let talus = libm::atan(TALUS).to_degrees();
    vec![
        Claim::new(
            "Erosion by velocity makes a network of rivers",
            Verdict::of(eroded.is_network(water)),
            format!(
                "`chan` {:.4} against {:.4} of water only, `reach` {:.2}, `drains` {:.2}; {RULE}",
                eroded.measures.chan, water.measures.chan, eroded.measures.reach, eroded.measures.drains
            ),
        ),
        Claim::new(
            "Thermal weathering turns slots into V-shaped valleys",
            Verdict::of(valley > 1.3 * slot && valley_shape < slot_shape && rests < talus + 3.0),
            format!(
                "valleys widen from {slot:.1} to {valley:.1} cells, their shape goes from {slot_shape:.2} \
                 to {valley_shape:.2}, the slope of the steepest tenth from {steep:.0}° to {rests:.0}°, \
                 where tan φ is {talus:.0}°"
            ),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};

    #[test]
    fn the_steepest_tenth_of_a_plane_is_as_steep_as_the_plane() {
        let plane =
            Field::from_function(Size::square(12).expect("small"), |x, y| 3.0 * x as f32 + 4.0 * y as f32);
        let deg = steep_deg(&han::finished(plane));
        assert!((deg - libm::atan(5.0).to_degrees()).abs() < 1e-6, "{deg}°");
    }
}
