//! The trees of the woods of a scene, one by one, for those who draw them as such.

use super::ground_kinds::{SurfacePoint, UPRIGHT, bed_of};
use super::lit_scene::LitScene;
use super::water;
use super::woods::Tree;

/// Size in metres of a pixel at which a tree is asked whether it stands: smaller patches do not matter to it.
const FOOTPRINT: f32 = 3.0;

/// Metres by which the drawn ground may lie above the bed, as on a steep shore, whose edge is rounded.
const LIFTED: f32 = 0.25;

/// Share of a river in which no tree stands.
const IN_RIVER: f32 = 0.1;

impl LitScene {
    /// Whether there may be trees on its ground.
    pub fn has_woods(&self) -> bool {
        self.cover.has_woods() && !self.is_empty
    }

    /// The tree that stands in a square of the lattice of woods, 7 m wide, counted eastward and northward from the
    /// north-western corner, and whether it is a conifer; `None` where none does.
    pub fn tree_in(&self, square: [i32; 2]) -> Option<(Tree, bool)> {
        let tree = Tree::of(square);
        let terrain = &self.setting.terrain;
        let place = terrain.place([tree.place[0], tree.place[1], 0.0]);
        if !terrain.is_valid(place) {
            return None;
        }
        let river = self.setting.rivers.as_ref().map_or(0.0, |rivers| rivers.at(self.share(place)));
        let spot = self.wooded_ground(place);
        let lifted = terrain.top.at(place) - self.setting.bed.at(place);
        let [density, conifers] = self.cover.wood(&spot);
        let stands = river < IN_RIVER && lifted < LIFTED && tree.rank < density;
        stands.then_some((tree, tree.chance < conifers))
    }

    /// The ground under a tree.
    fn wooded_ground(&self, place: [f32; 2]) -> SurfacePoint {
        let (terrain, stretch) = (&self.setting.terrain, self.setting.exaggeration);
        let [height, east, south] = self.setting.bed.with_slope(place);
        let normal = terrain.normal([east, south]);
        let run = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        let above = self.setting.level.as_ref().map_or(f32::INFINITY, |level| height - level.at(place));
        let beach = water::beach(height - above, self.sea().unwrap_or(f32::MIN));
        SurfacePoint {
            place,
            point: terrain.point(place, height / stretch),
            slope: run / normal[2].max(1e-3) / stretch,
            fall: [normal[0], normal[1]].map(|part| part / run.max(1e-6)),
            footprint: FOOTPRINT,
            sight: UPRIGHT,
            above: above / stretch,
            beach,
            bed: bed_of([height, east, south], stretch),
        }
    }
}
