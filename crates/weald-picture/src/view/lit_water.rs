//! The light that water of a view sends to the eye: what it mirrors, its body and its bed, foam, and the stones of its edge.

use std::f32::consts::FRAC_1_PI;

use super::drawn_rivers::{RiverSpot, with_banks};
use super::scene::{GroundSpot, RayMarcher, WaterSpot};
use super::skylight;
use super::terrain::{Hit, Ray};
use super::vector::{Vector, add, dot, mirrored, ramp, scale, unit};
use super::water;
use crate::colour::mix;

/// Metres over which ripples draw out what water mirrors, for each metre that it is away.
const DRAWN_OUT: f32 = 0.02;

/// Pixels of the shortest waves that are seen one by one, near by and far away, and metres of water in a pixel where that changes:
/// shorter ones would be grain, and such long ones far out at sea the grain of wood.
const SEEN_WAVES: [f32; 2] = [4.0, 2.0];
const FAR_WAVES: [f32; 2] = [15.0, 40.0];

impl RayMarcher {
    /// A lake or the sea of a drawn depth, out of whose edge stones stand.
    pub(super) fn shore(&self, ray: &Ray, hit: &Hit, spot: &GroundSpot, depth: f32) -> Vector {
        let [_, east, south] = spot.surface;
        let water = self.water_spot(spot.point, depth, [east, south]);
        let land = if water.share < 1.0 { self.ground(spot, -depth) } else { [0.0; 3] };
        if water.share > 0.0 { mix(land, self.lake(ray, hit, &water), water.share) } else { land }
    }

    /// The river at a place that a ray met, where a share is kept of what the map has.
    pub(super) fn river(&self, ray: &Ray, hit: &Hit, kept: f32) -> RiverSpot {
        let Some(rivers) = &self.setting.rivers else {
            return RiverSpot { above: f32::INFINITY, ..RiverSpot::default() };
        };
        let terrain = &self.setting.terrain;
        let pixel = terrain.spacing[0] * terrain.top.size().columns as f32 / rivers.width as f32;
        let footprint = self.footprint(hit.ray_length) / (-ray.direction[2]).max(0.05).sqrt();
        let share = kept * rivers.at(self.share(hit.place));
        with_banks(share, ray.at(hit.ray_length), [pixel, footprint])
    }

    /// A point of a lake or the sea of a drawn depth over a bed that rises so by the cell.
    pub(super) fn water_spot(&self, point: Vector, depth: f32, rise: [f32; 2]) -> WaterSpot {
        let normal = self.setting.terrain.normal(rise);
        let slope = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt() / normal[2].max(1e-3);
        let eye = self.camera.eye;
        let away = [0, 1, 2].map(|axis| point[axis] - eye[axis]);
        let footprint = self.footprint(dot(away, away).sqrt());
        let width = water::swash_width(point[2], self.sea().unwrap_or(f32::MIN));
        let share = water::shore(point, depth / self.setting.exaggeration, slope, [width, footprint]);
        let away = depth / slope.max(0.02);
        let foam = water::breaking(slope) * water::swash(point, away, width, [0.0, footprint]);
        WaterSpot { point, depth: depth / self.setting.exaggeration, share, foam, footprint }
    }

    /// Water of a depth.
    pub(super) fn lake(&self, ray: &Ray, hit: &Hit, spot: &WaterSpot) -> Vector {
        let WaterSpot { point, depth, foam, .. } = *spot;
        let terrain = &self.setting.terrain;
        let back = scale(ray.direction, -1.0);
        let footprint = self.footprint(hit.ray_length) / back[2].max(0.05).sqrt();
        // From afar the waves that are seen are longer ones, as steep: what is mirrored is drawn out, up and down most.
        let far = ramp(footprint, FAR_WAVES[0], FAR_WAVES[1]);
        let seen_waves = SEEN_WAVES[0] + (SEEN_WAVES[1] - SEEN_WAVES[0]) * far;
        let length = (0.25 * terrain.cell()).min(6.0).max(seen_waves * footprint);
        let normal = water::ripples(point, length, footprint);
        let seen = self.skylight.at(self.share(hit.place));
        let share = water::mirrored_share(dot(back, normal));
        let mut direction = mirrored(ray.direction, normal);
        direction[2] = direction[2].max(0.01);
        let reflection = self.mirrored_light(&Ray { from: point, direction: unit(direction) });
        let sun = self.sun_seen(point);
        let light = add(
            scale(self.sky.sunlight, sun * self.sky.sun[2]),
            skylight::on(&seen, [0.0, 0.0, 1.0], self.bounce),
        );
        let glint = if sun > 0.0 { sun * water::glint(back, normal, self.sky.sun) } else { 0.0 };
        let bed = water::bed_albedo(self.cover.gravel(), point, depth, spot.footprint);
        let turbid = water::turbidity(point[2], self.sea().unwrap_or(f32::MIN));
        let below = water::body(bed, depth, turbid, light);
        let surface = add(scale(reflection, share), scale(below, 1.0 - share));
        let surface = add(surface, scale(self.sky.sunlight, glint));
        mix(surface, scale(light, water::FOAM * FRAC_1_PI), foam)
    }

    /// The light that water mirrors: land with its own colours, water on it as the sky that it mirrors.
    pub(super) fn mirrored_light(&self, ray: &Ray) -> Vector {
        let terrain = &self.setting.terrain;
        let start = 0.4 * terrain.cell();
        let Some(hit) = terrain.trace(ray, [start, f32::INFINITY]).filter(|hit| hit.side.is_none()) else {
            let upward = Ray { direction: water::upward(ray.direction), ..*ray };
            let sky = self.sky.radiance(upward.direction);
            let clouds = self.clouds.as_ref().map(|clouds| clouds.mirrored(&self.sky, &upward));
            return clouds.map_or(sky, |clouds| clouds.over(sky));
        };
        let point = ray.at(hit.ray_length);
        let footprint =
            (0.25 * terrain.cell()).max(self.footprint(hit.ray_length)).max(DRAWN_OUT * hit.ray_length);
        let surface = self.setting.bed.with_slope(hit.place);
        let spot = GroundSpot {
            place: hit.place,
            surface,
            own: surface,
            point,
            footprint,
            direction: ray.direction,
        };
        let ground = self.ground(&spot, 1e9);
        self.haze.veil(ground, ray, hit.ray_length, &self.sky)
    }
}
