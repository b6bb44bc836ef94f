//! Taking from a column of materials from the top down, and laying down what is too much: the exchange that
//! force-based erosion and dissolution share (Šťava et al. 2008).
//!
//! Where there is room for more, each material gives the share that is its own of the room left under the
//! thickness above it, `min(d_k, K_k max(0, room - Σ_above d))`, and no more than there is; bedrock has no end.
//! Where the room is negative, the share `deposition` of the surplus settles. Thicknesses are those before the
//! exchange, so that materials whose shares are 1 together give no more than the room.

use pulp::Arch;

use crate::erode::pipes::without_negligible;
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;

/// Shares of the materials, and what settles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Digging {
    /// Share of the unused transport capacity that each material gives in a step, bedrock first.
    pub(crate) shares: Vec<f32>,
    /// Material that settles.
    pub(crate) deposit: usize,
    /// Share of the surplus that settles in a step.
    pub(crate) deposition: f32,
}

kernel! {
    /// Takes from one material. What was taken is what its rounded thickness lost, so that nothing vanishes.
    pub(crate) struct Dig {
        reads { room }
        updates { thickness, above, taken }
        writes {}
        constants { share: f32 }
    }
    fn cell() {
        let wanted = share * (room - above).max(0.0);
        let left = without_negligible(thickness - wanted.min(thickness));
        taken += thickness - left;
        above += thickness;
        thickness = left;
    }
}

kernel! {
    /// Takes from the bedrock.
    pub(crate) struct DigBedrock {
        reads { room, above }
        updates { change, taken }
        writes {}
        constants { share: f32 }
    }
    fn cell() {
        let left = change - share * (room - above).max(0.0);
        taken += change - left;
        change = left;
    }
}

/// One and a half times half the distance of a number to the next: a number less this share of itself rounds to
/// the next lower one.
const LAST_DIGIT: f32 = 1.5 * 0.5 * f32::EPSILON;

kernel! {
    /// Lays down a share of the surplus, and adds what was taken. A thickness that rounds up by more than is
    /// carried is rounded down, so that the rest is never negative.
    pub(crate) struct LayDown {
        reads { found, room, taken }
        updates { thickness }
        writes { carried }
        constants { deposition: f32 }
    }
    fn cell() {
        let up = thickness + deposition * (-room).max(0.0);
        let down = (up - up.abs() * LAST_DIGIT).max(thickness);
        let after = if up - thickness <= found { up } else { down };
        carried = without_negligible(found + (taken - (after - thickness)));
        thickness = after;
    }
}

/// Rows of one exchange.
pub(crate) struct DigScratch {
    /// Unused transport capacity; negative for a surplus.
    pub(crate) room: Ring,
    above: Ring,
    taken: Ring,
}

impl DigScratch {
    pub(crate) fn new(columns: usize) -> Self {
        let ring = || Ring::new(columns, 1);
        Self { room: ring(), above: ring(), taken: ring() }
    }
}

impl Digging {
    /// Exchanges row `y` of the materials with what is carried, by the room in `scratch`.
    pub(crate) fn exchange(
        &self,
        (solid, y): (&mut [Ring], usize),
        (found, carried): (&[f32], &mut [f32]),
        scratch: &mut DigScratch,
        arch: Arch,
    ) {
        let DigScratch { room, above, taken } = scratch;
        above.here_mut(0).fill(0.0);
        taken.here_mut(0).fill(0.0);
        for (material, &share) in self.shares.iter().enumerate().rev() {
            let (room, layer) = (room.here(0), solid[material].here_mut(y));
            if material == 0 {
                DigBedrock { room, above: above.here(0), change: layer, taken: taken.here_mut(0), share }
                    .run(arch);
            } else {
                let (above, taken) = (above.here_mut(0), taken.here_mut(0));
                Dig { room, thickness: layer, above, taken, share }.run(arch);
            }
        }
        LayDown {
            found,
            room: room.here(0),
            taken: taken.here(0),
            thickness: solid[self.deposit].here_mut(y),
            carried,
            deposition: self.deposition,
        }
        .run(arch);
    }
}
