//! Beds of rock where they are seen: layers of their own tone with joints between them, which stand out as ledges.
//!
//! Beds dip and are folded; each has a tone and a thickness by chance. Below each is a joint, dark and sunk, and above it a ledge on which
//! the face lies back. What is finer than a pixel fades out.

use super::vector::ramp;
use weald_core::grain::bits;

/// How steeply beds dip, as rise over run, and where to, eastward and northward.
const DIP: f32 = 0.14;
const DIP_TOWARDS: [f32; 2] = [0.8, -0.6];

/// Height of a bed's face over its thickness; the ledge above it takes the rest.
const FACE: f32 = 0.72;

/// Range of where a bed begins, in mean thicknesses, about where it would if all were equally thick.
const UNEVEN: f32 = 0.85;

/// Beds at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beds {
    /// Tone of the bed, from -0.5 to 0.5.
    pub(super) tone: f32,
    /// Share of the darkness of a joint.
    pub(super) joint: f32,
    /// How much steeper the face is than the slope, or, on ledges, less.
    pub(super) ledge: f32,
}

/// What beds are looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct BedSpot {
    pub(super) point: [f32; 3],
    /// By how many beds they are folded there.
    pub(super) fold: f32,
    /// Thickness of a bed in metres.
    pub(super) thickness: f32,
    /// Height of a pixel on the face in metres.
    pub(super) footprint: f32,
}

/// How much deeper in the pile of beds that dip a place is, in metres, than the north-western corner.
pub(super) fn dip([x, y]: [f32; 2]) -> f32 {
    DIP * (DIP_TOWARDS[0] * x + DIP_TOWARDS[1] * y)
}

/// Which bed a point lies in, and how far up in it.
fn level(spot: &BedSpot, dips: bool) -> f32 {
    let [x, y, z] = spot.point;
    (z + if dips { dip([x, y]) } else { 0.0 }) / spot.thickness + spot.fold
}

/// A random number of a bed, from -0.5 to 0.5.
fn chance(bed: f32, what: i32, seed: u32) -> f32 {
    (bits(bed as i32, what, seed) >> 8) as f32 / 16_777_216.0 - 0.5
}

/// Which bed lies at a level, where it begins there, and how thick it is beside the mean one.
fn bed_at(level: f32, seed: u32) -> [f32; 3] {
    let begins = |bed: f32| bed + UNEVEN * chance(bed, 7, seed);
    let middle = level.floor();
    let number = if level < begins(middle) {
        middle - 1.0
    } else if level < begins(middle + 1.0) {
        middle
    } else {
        middle + 1.0
    };
    let first = begins(number);
    [number, first, begins(number + 1.0) - first]
}

/// The beds at a point; level ones where they do not dip.
pub(super) fn beds(spot: &BedSpot, dips: bool, seed: u32) -> Beds {
    let level = level(spot, dips);
    let [number, first, thick] = bed_at(level, seed);
    let within = (level - first) / thick;
    let blur = spot.footprint / (thick * spot.thickness);
    let seen = 1.0 - ramp(blur, 0.25, 0.8);
    let tone = |bed: f32| chance(bed, 5, seed);
    let edge = ramp(within, 0.0, (1.5 * blur).clamp(0.06, 0.5));
    let deep = tone(number + 1000.0).abs() + 0.5;
    Beds {
        tone: seen * (tone(number - 1.0) * (1.0 - edge) + tone(number) * edge),
        joint: seen * deep * (1.0 - ramp(within, 0.0, 0.16 + blur)),
        ledge: seen * (0.4 - 1.4 * ramp(within, FACE - 0.08, FACE + 0.08)),
    }
}

/// How much higher ground stands for the beds there than without them, over the thickness of one: it rises as fast with each
/// face as it falls back on the ledge above it.
pub(super) fn stepped(spot: &BedSpot) -> f32 {
    let level = level(spot, true);
    let within = level - level.floor();
    within.min(1.0 - within) - 0.25
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(point: [f32; 3], footprint: f32) -> Beds {
        beds(&BedSpot { point, fold: 0.0, thickness: 10.0, footprint }, true, 7)
    }

    #[test]
    fn beds_go_on_along_their_dip_and_change_across_it() {
        let start = [100.0, 200.0, 63.0];
        let along = |metres: f32| {
            let [east, north] = DIP_TOWARDS.map(|part| part * metres);
            at([start[0] + east, start[1] + north, start[2] - DIP * metres], 0.1)
        };
        for metres in [40.0, 300.0, 900.0] {
            assert!((along(metres).tone - along(0.0).tone).abs() < 1e-2, "{metres} m along the bed");
        }
        let tones: Vec<f32> =
            (0..12).map(|bed| at([100.0, 200.0, 63.0 + 10.0 * bed as f32], 0.1).tone).collect();
        assert!(tones.iter().any(|tone| (tone - tones[0]).abs() > 0.3), "{tones:?}");
    }

    #[test]
    fn beds_are_of_all_thicknesses_and_follow_each_other_without_gaps() {
        let (mut thinnest, mut thickest, mut above) = (f32::MAX, 0.0_f32, bed_at(0.0, 7));
        for step in 1..20_000_u16 {
            let level = f32::from(step) * 0.01;
            let [number, first, thick] = bed_at(level, 7);
            assert!(
                first <= level && level < first + thick + 1e-3,
                "{level} in {first} to {}",
                first + thick
            );
            if number > above[0] {
                assert!(number - above[0] == 1.0 && (first - above[1] - above[2]).abs() < 1e-3, "{level}");
                above = [number, first, thick];
            }
            (thinnest, thickest) = (thinnest.min(thick), thickest.max(thick));
        }
        assert!(thinnest < 0.4 && thickest > 1.6, "{thinnest} to {thickest} of the mean");
    }

    #[test]
    fn ground_rises_with_faces_and_falls_back_on_ledges_and_is_as_high_on_the_average() {
        let at = |height: f32| {
            let point = [100.0, 200.0, height];
            stepped(&BedSpot { point, fold: 0.3, thickness: 10.0, footprint: 0.0 })
        };
        let mean = (0..1000).map(|step| at(0.1 * step as f32)).sum::<f32>() / 1000.0;
        assert!(mean.abs() < 1e-2, "{mean}");
        let rises =
            (0..1000).map(|step| 10.0 * (at(0.1 * step as f32 + 0.05) - at(0.1 * step as f32)) / 0.05);
        let [up, down] = rises.fold([0; 2], |[up, down], rise| {
            [up + usize::from((rise - 1.0).abs() < 0.1), down + usize::from((rise + 1.0).abs() < 0.1)]
        });
        assert!((450..=510).contains(&up) && (450..=510).contains(&down), "{up} up, {down} down");
    }

    #[test]
    fn each_bed_has_a_steep_face_and_a_ledge_and_none_is_seen_from_afar() {
        let column = |footprint: f32| (0..100).map(move |step| at([0.0, 0.0, 0.1 * step as f32], footprint));
        assert!(column(0.1).any(|beds| beds.ledge > 0.3) && column(0.1).any(|beds| beds.ledge < -0.9));
        assert!(column(0.1).any(|beds| beds.joint > 0.3));
        assert!(column(50.0).all(|beds| beds.tone == 0.0 && beds.joint == 0.0 && beds.ledge == 0.0));
    }
}
