//! Slippage: every material slides off slopes steeper than its own talus (Šťava et al. 2008).
//!
//! Material `k`, whose top stands at `h_k`, gives each lower neighbour `strength · max(0, h_k - h_k,n - T_k)`,
//! all materials and cells from one old surface, scaled so that no cell gives more than it has; bedrock has no
//! end. Stable while `strength` times the number of materials is at most 1/4. With softening, ground that is
//! rougher than its talus allows loses its hold: `T := max(0, T - 10 max(0, |mean of the neighbours - h| - T /
//! 100))`, and an edge has the mean of its two cells.

mod kernels;

use super::planes::{Pile, Planes};
use crate::erode::before;
use crate::erode::sweep::Sweep;
use crate::erode::thermal::{Apply, Axis, Ground};
use kernels::{AvailableShare, Slid, SoftAxis, Softened};
use weald_engine::stencil::ring::Ring;

/// Constants of the method.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slippage {
    /// Steepest slope that rests, as a tangent, for each material, bedrock first.
    pub(crate) talus: Vec<f32>,
    /// Share of the excess that slides in a step.
    pub(crate) strength: f32,
    pub(crate) softening: bool,
}

/// Rows in flight of one material.
struct Sliding {
    /// Height of its top.
    top: Ring,
    /// Its talus, where it softens.
    talus: Ring,
    to_east: Ring,
    to_south: Ring,
    share: Ring,
}

/// Rows in flight within the slippage.
pub(crate) struct SlippageScratch {
    materials: Vec<Sliding>,
    still: Ring,
}

impl SlippageScratch {
    pub(crate) fn new(columns: usize, materials: usize) -> Self {
        let ring = |depth| Ring::new(columns, depth);
        let sliding =
            |_| Sliding { top: ring(3), talus: ring(2), to_east: ring(2), to_south: ring(3), share: ring(3) };
        Self { materials: (0..materials).map(sliding).collect(), still: Ring::still(columns) }
    }
}

/// What the slippage reads.
pub(crate) struct SlippageRows<'a> {
    /// Change of the bedrock and thickness of the materials on it.
    pub(crate) solid: &'a [Ring],
    pub(crate) base: &'a Ring,
    pub(crate) sweep: Sweep<'a>,
}

impl Slippage {
    /// Rows by which the output lies behind the newest input.
    pub(crate) fn lag(&self) -> usize {
        if self.softening { 3 } else { 2 }
    }

    /// Slides the next rows that are ready.
    pub(crate) fn advance(
        &self,
        rows: &SlippageRows<'_>,
        scratch: &mut SlippageScratch,
        (planes, output): (Planes, &mut [Ring]),
    ) {
        if let Some(y) = rows.sweep.behind(0) {
            tops(rows, scratch, y);
        }
        let SlippageScratch { materials, still } = scratch;
        for (material, sliding) in materials.iter_mut().enumerate() {
            if self.softening
                && let Some(y) = rows.sweep.behind(1)
            {
                soften(rows, sliding, y, self.talus[material]);
            }
            if let Some(y) = rows.sweep.behind(self.lag() - 1) {
                self.want(rows, sliding, y, self.talus[material]);
                if material > 0 {
                    available_share(rows, sliding, still, (y, &rows.solid[material]));
                }
            }
            if let Some(y) = rows.sweep.behind(self.lag()) {
                let (solid, after) = (&rows.solid[material], &mut output[planes.of(material)]);
                match material {
                    0 => bedrock_slid(rows, sliding, still, y, (solid, after)),
                    _ => slid(rows, sliding, still, y, (solid, after)),
                }
            }
        }
    }

    fn want(&self, rows: &SlippageRows<'_>, sliding: &mut Sliding, y: usize, talus: f32) {
        let links = rows.sweep.links(y);
        let Sliding { top, talus: softened, to_east, to_south, .. } = sliding;
        let [ground, ground_east, ground_south] = [top.here(y), top.east(y), top.here(rows.sweep.next(y))];
        let [link_east, link_south] = [links.east, links.south];
        let [to_east, to_south] = [to_east.here_mut(y), to_south.here_mut(y)];
        let strength = self.strength;
        if self.softening {
            let talus = softened.here(y);
            let [talus_east, talus_south] = [softened.east(y), softened.here(rows.sweep.next(y))];
            SoftAxis {
                ground,
                ground_east,
                ground_south,
                talus,
                talus_east,
                talus_south,
                link_east,
                link_south,
                to_east,
                to_south,
                strength,
            }
            .run(rows.sweep.arch);
        } else {
            Axis {
                ground,
                ground_east,
                ground_south,
                link_east,
                link_south,
                to_east,
                to_south,
                talus,
                strength,
            }
            .run(rows.sweep.arch);
        }
    }
}

/// Heights of the tops of all materials, from the bedrock up.
fn tops(rows: &SlippageRows<'_>, scratch: &mut SlippageScratch, y: usize) {
    let (base, change) = (rows.base.here(y), rows.solid[0].here(y));
    Ground { base, change, ground: scratch.materials[0].top.here_mut(y) }.run(rows.sweep.arch);
    for material in 1..scratch.materials.len() {
        let (below, above) = scratch.materials.split_at_mut(material);
        let ground = above[0].top.here_mut(y);
        ground.copy_from_slice(below[material - 1].top.here(y));
        Pile { thickness: rows.solid[material].here(y), ground }.run(rows.sweep.arch);
    }
}

fn soften(rows: &SlippageRows<'_>, sliding: &mut Sliding, y: usize, talus: f32) {
    let links = rows.sweep.links(y);
    let top = &sliding.top;
    let previous = rows.sweep.previous(y);
    Softened {
        ground: top.here(y),
        ground_east: top.east(y),
        ground_west: top.west(y),
        ground_south: top.here(rows.sweep.next(y)),
        ground_north: top.here(previous),
        link_east: links.east,
        link_west: links.west,
        link_south: links.south,
        link_north: links.north,
        neighbour_share: links.neighbour_share,
        softened: sliding.talus.here_mut(y),
        talus,
    }
    .run(rows.sweep.arch);
}

fn available_share(
    rows: &SlippageRows<'_>,
    sliding: &mut Sliding,
    still: &Ring,
    (y, thickness): (usize, &Ring),
) {
    let Sliding { to_east, to_south, share, .. } = sliding;
    AvailableShare {
        thickness: thickness.here(y),
        east: to_east.here(y),
        west: to_east.west(y),
        south: to_south.here(y),
        north: before(to_south, still, y, rows.sweep.span.start),
        share: share.here_mut(y),
    }
    .run(rows.sweep.arch);
}

fn bedrock_slid(
    rows: &SlippageRows<'_>,
    sliding: &Sliding,
    still: &Ring,
    y: usize,
    (change, after): (&Ring, &mut Ring),
) {
    Apply {
        before: change.here(y),
        to_east: sliding.to_east.here(y),
        from_west: sliding.to_east.west(y),
        to_south: sliding.to_south.here(y),
        from_north: before(&sliding.to_south, still, y, rows.sweep.span.start),
        change: after.here_mut(y),
    }
    .run(rows.sweep.arch);
}

fn slid(
    rows: &SlippageRows<'_>,
    sliding: &Sliding,
    still: &Ring,
    y: usize,
    (thickness, after): (&Ring, &mut Ring),
) {
    let Sliding { to_east, to_south, share, .. } = sliding;
    Slid {
        before: thickness.here(y),
        to_east: to_east.here(y),
        from_west: to_east.west(y),
        to_south: to_south.here(y),
        from_north: before(to_south, still, y, rows.sweep.span.start),
        share: share.here(y),
        share_east: share.east(y),
        share_west: share.west(y),
        share_south: share.here(rows.sweep.next(y)),
        share_north: before(share, still, y, rows.sweep.span.start),
        thickness: after.here_mut(y),
    }
    .run(rows.sweep.arch);
}
