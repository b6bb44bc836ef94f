//! Ground and water beyond the border of a landscape: where rays meet them, and what they look like.

use super::camera::Camera;
use super::intersection::{CLOSE, close_in};
use super::scene::{GroundSpot, RayMarcher, WaterSpot};
use super::setting::Setting;
use super::surroundings::{REACH, Surroundings};
use super::terrain::{Hit, Ray};
use super::vector::{Vector, filter, scale};
use crate::colour::mix;
use std::f32::consts::FRAC_1_PI;

/// A step along a ray: the share of its height above the ground, and at least a share of its length so far and of a cell.
const STEP: f32 = 0.4;
const MIN_STEP: f32 = 0.008;
const MIN_CELLS: f32 = 0.5;

/// Metres of water in which no bed is seen.
const OPEN_SEA: f32 = 1000.0;

/// Least height of the eye above the ground, in metres.
const CLEARANCE: f32 = 2.0;

impl Setting {
    /// What a ray meets between two lengths: of the landscape, or of what goes on around it.
    pub(super) fn trace(&self, ray: &Ray, [near, far]: [f32; 2]) -> Option<Hit> {
        let Some(around) = &self.around else { return self.terrain.trace(ray, [near, far]) };
        let cells = around.cells[0].max(around.cells[1]);
        let far = far.min(1.5 * REACH * cells * self.terrain.spacing[0].max(self.terrain.spacing[1]));
        let crossing = self.terrain.line(ray.from, ray.direction).crossing(&self.terrain.top);
        let crossing = crossing.map(|[enter, leave]| [enter.max(near), leave.min(far)]);
        let Some([enter, leave]) = crossing.filter(|[enter, leave]| enter < leave) else {
            return self.march(around, ray, [near, far]);
        };
        let within = || self.terrain.trace(ray, [enter, leave]).map(|hit| Hit { side: None, ..hit });
        self.march(around, ray, [near, enter])
            .or_else(within)
            .or_else(|| self.march(around, ray, [leave, far]))
    }

    /// What a ray meets of the ground around, in steps.
    fn march(&self, around: &Surroundings, ray: &Ray, span: [f32; 2]) -> Option<Hit> {
        let [near, far] = below(around.bounds[1], ray, span)?;
        let above = |ray_length: f32| {
            ray.at(ray_length)[2] - self.top_beyond(around, self.terrain.place(ray.at(ray_length)))
        };
        let (mut before, mut ray_length) = ((near, 0.0), near);
        loop {
            let here = (ray_length, above(ray_length));
            if here.1 <= 0.0 {
                let ray_length = close_in([before, here], CLOSE * self.terrain.cell(), above);
                return Some(Hit { ray_length, place: self.terrain.place(ray.at(ray_length)), side: None });
            }
            if ray_length >= far {
                return None;
            }
            before = here;
            let step = (STEP * here.1).max(MIN_CELLS * self.terrain.cell() + MIN_STEP * ray_length);
            ray_length = (ray_length + step).min(far);
        }
    }

    /// Height of the ground or the water at a place beyond the border.
    pub(super) fn top_beyond(&self, around: &Surroundings, place: [f32; 2]) -> f32 {
        let [height, share] = around.height(&self.bed, place);
        let cell = self.terrain.cell();
        let level = self.level.as_ref().map(|level| around.level(level, [height, share], place, cell));
        level.map_or(height, |level| level.max(height))
    }

    /// A camera lifted out of the ground around the landscape.
    pub(super) fn above_ground(&self, mut camera: Camera) -> Camera {
        let place = self.terrain.place(camera.eye);
        if let Some(around) = self.around.as_ref().filter(|around| around.is_beyond(place)) {
            camera.eye[2] = camera.eye[2].max(self.top_beyond(around, place) + CLEARANCE);
        }
        camera
    }
}

/// The part of a span in which a ray is below a height.
fn below(highest: f32, ray: &Ray, [mut near, mut far]: [f32; 2]) -> Option<[f32; 2]> {
    let (height, rise) = (ray.from[2], ray.direction[2]);
    let to_top = (highest - height) / rise;
    if rise > 0.0 {
        far = far.min(to_top);
    } else if rise < 0.0 {
        near = near.max(to_top);
    } else if height > highest {
        return None;
    }
    (near < far).then_some([near, far])
}

impl RayMarcher {
    /// The light that comes to the eye from what a ray met beyond the border.
    pub(super) fn met_beyond(&self, around: &Surroundings, ray: &Ray, hit: &Hit) -> Vector {
        let veiled = self.haze.veil(self.beyond(around, ray, hit), ray, hit.ray_length, &self.sky);
        if around.is_at_sea(ray.at(hit.ray_length)[2]) {
            return veiled;
        }
        mix(veiled, self.farthest(around, ray), around.lost_share(hit.place))
    }

    /// The light along a ray below the horizon that meets nothing of what is drawn: of the open sea, or of even land.
    pub(super) fn farthest(&self, around: &Surroundings, ray: &Ray) -> Vector {
        let reach = REACH * around.cells[0].max(around.cells[1]) * self.setting.terrain.cell();
        let far = self.setting.terrain.place(ray.at(reach));
        let (height, is_sea) = around.plain_at(far);
        let ray_length = ((height - ray.from[2]) / ray.direction[2].min(-1e-6)).max(0.0);
        let radiance = if is_sea {
            let point = ray.at(ray_length);
            let place = [0, 1].map(|axis| far[axis].clamp(0.5, around.cells[axis] + 0.5));
            let footprint = self.footprint(ray_length);
            let spot = WaterSpot { point, depth: OPEN_SEA, share: 1.0, foam: 0.0, footprint };
            self.lake(ray, &Hit { ray_length, place, side: None }, &spot)
        } else {
            scale(filter(self.plain, self.sky.on_flat_ground()), FRAC_1_PI)
        };
        self.haze.veil(radiance, ray, ray_length, &self.sky)
    }

    /// The light that starts at what a ray met beyond the border.
    fn beyond(&self, around: &Surroundings, ray: &Ray, hit: &Hit) -> Vector {
        let (setting, point) = (&self.setting, ray.at(hit.ray_length));
        let beyond = around.at(&setting.bed, hit.place);
        let cell = setting.terrain.cell();
        let ground = [beyond.surface[0], beyond.share];
        let level = setting.level.as_ref().map(|level| around.level(level, ground, hit.place, cell));
        let depth = level.map_or(f32::NEG_INFINITY, |level| level - beyond.surface[0]);
        let like = Hit { place: beyond.place, ..*hit };
        let footprint = self.footprint(hit.ray_length);
        let (surface, own, direction) = (beyond.surface, beyond.own, ray.direction);
        let spot = GroundSpot { place: beyond.place, surface, own, point, footprint, direction };
        if depth > 0.0 {
            return self.shore(ray, &like, &spot, depth);
        }
        let there = Hit { place: beyond.river, ..*hit };
        let river = self.river(ray, &there, Surroundings::river_share(&beyond));
        let land = self.ground(&spot, (-depth).min(river.above * setting.exaggeration));
        if river.share <= 0.0 {
            return land;
        }
        let water = WaterSpot { point, depth: river.depth, share: river.share, foam: 0.0, footprint };
        mix(land, self.lake(ray, &like, &water), river.share)
    }
}
