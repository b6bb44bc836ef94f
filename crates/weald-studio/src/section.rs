//! The ground along a line, and what is measured there.

use weald::Field;

use crate::pick::Target;

/// Fewest and most places that a line is looked at.
const PLACES: [usize; 2] = [64, 2000];

/// A line that is drawn over the landscape to measure it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Measuring {
    /// Whether the pointer draws it.
    pub(crate) is_on: bool,
    /// Its ends, in metres east and south.
    pub(crate) line: Option<[[f64; 2]; 2]>,
}

/// A place of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// Level distance from the beginning, in metres.
    pub(crate) along: f64,
    /// Elevation of the ground, in metres.
    pub(crate) ground: f64,
    /// Depth of the water, in metres.
    pub(crate) water: f64,
    /// Elevation of the bedrock, where that is known.
    pub(crate) bedrock: Option<f64>,
}

/// What is measured along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measures {
    /// Level distance, in metres.
    pub(crate) distance: f64,
    /// Length of the path over the ground, in metres.
    pub(crate) path: f64,
    /// Height gained from the beginning to the end, in metres.
    pub(crate) rise: f64,
    /// Slope from the beginning to the end, in degrees.
    pub(crate) mean_slope_deg: f64,
    /// The steepest piece of it, in degrees.
    pub(crate) steepest_deg: f64,
}

/// The ground from one place to another, every half of a cell; places outside the landscape are left out.
pub(crate) fn section(
    target: &Target<'_>,
    bedrock: Option<&Field>,
    [from, to]: [[f64; 2]; 2],
) -> Vec<Sample> {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let pieces = ((2.0 * length / target.cell) as usize).clamp(PLACES[0], PLACES[1]);
    let sample = |piece: usize| {
        let share = piece as f64 / pieces as f64;
        let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let place = target.at(at)?;
        let bedrock = bedrock.map(|bedrock| target.height_at(bedrock, at));
        Some(Sample { along: share * length, ground: place.ground, water: place.water, bedrock })
    };
    (0..=pieces).filter_map(sample).collect()
}

/// `None` where there are fewer than two places.
pub(crate) fn measures(samples: &[Sample]) -> Option<Measures> {
    let (first, last) = (samples.first()?, samples.last()?);
    let (distance, rise) = (last.along - first.along, last.ground - first.ground);
    if distance <= 0.0 {
        return None;
    }
    let (mut path, mut steepest_deg) = (0.0, 0.0_f64);
    for pair in samples.windows(2) {
        let [run, rise] = [pair[1].along - pair[0].along, pair[1].ground - pair[0].ground];
        path += run.hypot(rise);
        steepest_deg = steepest_deg.max(rise.abs().atan2(run).to_degrees());
    }
    let mean_slope_deg = rise.abs().atan2(distance).to_degrees();
    Some(Measures { distance, path, rise, mean_slope_deg, steepest_deg })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::Size;

    #[test]
    fn on_a_plane_all_measures_are_those_of_its_slope() {
        let size = Size::square(64).expect("legal");
        // Rises by 3 m in a cell of 4 m eastward.
        let ground = Field::from_function(size, |x, _| 3.0 * x as f32);
        let target = Target { ground: &ground, water: None, cell: 4.0, lowest: 0.0, exaggeration: 1.0 };
        let samples = section(&target, None, [[20.0, 100.0], [180.0, 100.0]]);
        let measured = measures(&samples).expect("a line");
        for (value, wanted) in [
            (measured.distance, 160.0),
            (measured.path, 200.0),
            (measured.rise, 120.0),
            (measured.mean_slope_deg, 0.75_f64.atan().to_degrees()),
            (measured.steepest_deg, 0.75_f64.atan().to_degrees()),
        ] {
            assert!((value - wanted).abs() < 1e-3, "{measured:?}");
        }
        let across = measures(&section(&target, None, [[100.0, 20.0], [100.0, 180.0]])).expect("a line");
        assert!(across.rise.abs() < 1e-9 && (across.path - 160.0).abs() < 1e-9, "{across:?}");
        assert_eq!(measures(&section(&target, None, [[100.0, 20.0]; 2])), None, "no line");
        assert!(section(&target, None, [[-900.0, 0.0], [-800.0, 0.0]]).is_empty(), "outside");
    }
}
