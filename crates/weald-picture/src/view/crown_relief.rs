//! Crowns of woods as they are seen aslant: those before hide what lies behind them.
//!
//! Relief mapping (Policarpo, Oliveira and Comba 2005, "Real-time relief mapping on arbitrary polygonal surfaces"): a line of
//! sight comes down to the domes of crowns in a few steps, and the wood is looked up where it meets them instead of where it meets
//! the ground. It is the finest layer of domes that is seen which has a height, and the next where that one fades.

use super::woods::{COARSER, GROUPS, LAYERS, MIDDLE_AGE, SEED, SPACING, dome, seen_of_layer, turned};

/// Height of the crowns of a layer beside their spacing, at most so many metres, and the steps in which a line of sight comes down
/// to them.
const RISE: f32 = 0.5;
const MOST_RISE: f32 = 12.0;
const STEPS: u32 = 4;

/// Where a line of sight to a point of the ground meets the crowns of a wood of a density, for a pixel of that footprint, as a
/// point to look at from straight above: `aslant` is how far the line goes aside a metre. Crowns before others hide them.
pub(super) fn seen_crown(point: [f32; 2], [density, footprint]: [f32; 2], aslant: [f32; 2]) -> [f32; 2] {
    let top = if density > 0.0 { highest(footprint) } else { 0.0 };
    let at = |up: f32| [0, 1].map(|axis| point[axis] + up * aslant[axis]);
    let mut above = [top, top - crown_height(at(top), density, footprint)];
    for step in 1..=STEPS {
        let up = top * (1.0 - step as f32 / STEPS as f32);
        let left = up - crown_height(at(up), density, footprint);
        if left <= 0.0 {
            return at(crossed_at(above, [up, left]));
        }
        above = [up, left];
    }
    point
}

/// At which height a line of sight crosses what stands on the ground, between a step at which it was so high and so far above that, and
/// one at which it is below: where it would were both straight.
fn crossed_at(before: [f32; 2], now: [f32; 2]) -> f32 {
    before[0] + before[1] / (before[1] - now[1]).max(1e-6) * (now[0] - before[0])
}

/// Share of each layer in the relief of a wood: of the finest that is seen, and of the next where that one fades.
fn reliefs(footprint: f32) -> impl Iterator<Item = (u32, f32, f32)> {
    let (mut finer, mut next) = (0.0, SPACING);
    (0..LAYERS).map(move |layer| {
        let spacing = next;
        next *= COARSER;
        let seen = seen_of_layer(layer, spacing, footprint);
        let share = seen.max(finer) - finer;
        finer = seen.max(finer);
        (layer, spacing, share)
    })
}

/// Metres above the ground that no crown is higher than.
fn highest(footprint: f32) -> f32 {
    reliefs(footprint).map(|(_, spacing, share)| share * (RISE * spacing).min(MOST_RISE)).sum()
}

/// Height of the crowns at a point in metres.
pub(super) fn crown_height(point: [f32; 2], density: f32, footprint: f32) -> f32 {
    let (mut sum, mut place) = (0.0, point);
    for (layer, spacing, share) in reliefs(footprint) {
        if layer > 0 {
            place = turned(place);
        }
        if share > 0.0 {
            let stands = if layer == 0 { [density, MIDDLE_AGE] } else { GROUPS };
            let dome = dome(place.map(|metres| metres / spacing), SEED + layer, stands);
            sum += share * (RISE * spacing).min(MOST_RISE) * dome.height;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowns_hide_what_lies_behind_them() {
        assert_eq!(seen_crown([31.0, 47.0], [0.9, 0.5], [0.0; 2]), [31.0, 47.0], "from straight above");
        let aslant = [2.0, -1.0];
        for footprint in [0.2, 3.0, 8.0, 30.0] {
            let (mut off, mut higher, count) = (0.0, 0, 2000);
            for at in 0..count {
                let point = [(at as f32 * 1.37) % 911.0, (at as f32 * 2.71) % 787.0];
                let seen = seen_crown(point, [0.9, footprint], aslant);
                let up = (seen[0] - point[0]) / aslant[0];
                off += (crown_height(seen, 0.9, footprint) - up).abs();
                // Nearer to the eye the line is above all crowns, but for those that its steps miss.
                let above = [0.25, 0.5, 0.75, 1.0].map(|share| up + share * (highest(footprint) - up));
                let crown = |up: &&f32| {
                    let there = [0, 1].map(|axis| point[axis] + **up * aslant[axis]);
                    crown_height(there, 0.9, footprint) > **up
                };
                higher += above.iter().filter(crown).count();
            }
            let off = off / (count as f32 * highest(footprint));
            let higher = higher as f32 / (4 * count) as f32;
            assert!(off < 0.12, "at {footprint} m: off the crowns by {off} of the highest");
            assert!(higher < 0.05, "at {footprint} m: {higher} of the line lies in crowns");
        }
    }
}
