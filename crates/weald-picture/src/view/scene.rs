//! The light that reaches each pixel of a view.

use std::f32::consts::FRAC_1_PI;
use std::ops::Deref;

use super::camera::{self, Camera};
use super::facets;
use super::ground_kinds::{SurfacePoint, bed_of};
use super::keys::View;
use super::lit_scene::{CUT_WATER, LitScene};
use super::pixel_mean::PixelMean;
use super::skylight::{self, Seen};
use super::terrain::{Hit, Ray};
use super::vector::{Vector, add, dot, filter, scale, unit};
use super::water;
use crate::colour::{linear_of_hex, mix};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// Marches the rays of pixels through a scene, on the CPU.
#[derive(Debug)]
pub struct RayMarcher {
    scene: LitScene,
    pixels: [usize; 2],
    samples: Vec<[f32; 2]>,
    ray_angle: f32,
}

/// A point of dry ground that is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundSpot {
    /// The place of the landscape that it is like.
    pub(super) place: [f32; 2],
    /// Height of the smooth ground, and its rise by the cell.
    pub(super) surface: [f32; 3],
    /// The same of the place that it is like.
    pub(super) own: [f32; 3],
    pub(super) point: Vector,
    pub(super) footprint: f32,
    /// Direction in which it is looked at.
    pub(super) direction: Vector,
}

/// A point of water that is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct WaterSpot {
    pub(super) point: Vector,
    /// Metres of water, without exaggeration.
    pub(super) depth: f32,
    /// Share of water: less than all where stones stand out of it.
    pub(super) share: f32,
    /// Share of foam.
    pub(super) foam: f32,
    /// Size of a pixel in metres.
    pub(super) footprint: f32,
}

impl Deref for RayMarcher {
    type Target = LitScene;

    fn deref(&self) -> &LitScene {
        &self.scene
    }
}

/// Rays of a pixel beyond which more of them do not show finer detail.
const MOST_BESIDE: usize = 4;

/// The angle in radians that a ray stands for where a pixel has so many: a pixel's over the root of their number. Filtered
/// over a whole pixel each, their mean would be blurred twice.
fn ray_angle(camera: &Camera, width: usize, rays: usize) -> f32 {
    camera.pixel_angle(width) / (rays.min(MOST_BESIDE) as f32).sqrt()
}

impl RayMarcher {
    /// The view from its own camera, or from another.
    pub(super) fn new(view: &View, landscape: &Landscape, from: Option<Camera>) -> Result<Self, Error> {
        let scene = LitScene::with_crags(view, landscape)?;
        let scene = match from {
            Some(camera) => scene.seen_from(camera),
            None => scene,
        };
        let pixels = [view.width as usize, view.height as usize];
        let samples = camera::samples(view.samples);
        let ray_angle = ray_angle(&scene.camera, pixels[0], samples.len());
        Ok(Self { scene, pixels, samples, ray_angle })
    }

    /// For pictures of a scene that are made row by row, of one ray a pixel; the camera is that of the scene.
    pub fn of(scene: LitScene, pixels: [usize; 2]) -> Self {
        let samples = camera::samples(1);
        let ray_angle = ray_angle(&scene.camera, pixels[0], samples.len());
        Self { scene, pixels, samples, ray_angle }
    }

    /// The scene.
    pub fn scene(&self) -> &LitScene {
        &self.scene
    }

    /// Looks from another camera, at so many columns and rows of pixels.
    pub fn look_from(&mut self, camera: Camera, pixels: [usize; 2]) {
        self.scene.look_from(camera);
        self.pixels = pixels;
        self.ray_angle = ray_angle(&camera, pixels[0], self.samples.len());
    }

    /// The bytes of a row of pixels from left to right, red, green and blue of each; row 0 is the uppermost.
    pub fn row(&self, y: usize) -> Vec<u8> {
        (0..self.pixels[0]).flat_map(|x| self.pixel([x, y])).collect()
    }

    /// The bytes of a pixel, counted from the top left. No more rays are marched than its mean needs.
    pub(super) fn pixel(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let mut mean = PixelMean::default();
        for offset in &self.samples {
            let across = 2.0 * (x as f32 + 0.5 + offset[0]) / self.pixels[0] as f32 - 1.0;
            let up = 1.0 - 2.0 * (y as f32 + 0.5 + offset[1]) / self.pixels[1] as f32;
            // One ray into the sun must not outshine all others of its pixel.
            let light = self.tone.limited(self.light(&self.camera.ray([across, up])));
            mean.add(light, self.tone.brightness(light));
            if mean.is_known() {
                break;
            }
        }
        self.tone.bytes(mean.light(), [x, y])
    }

    /// The light that comes along a ray to the eye.
    fn light(&self, ray: &Ray) -> Vector {
        let hit = self.setting.trace(ray, [0.0, f32::INFINITY]).filter(|_| !self.is_empty);
        // No ground is as high as clouds are: what rises and meets some does not come to them.
        let is_below = hit.is_some() && ray.direction[2] > 0.0;
        let radiance = self.light_behind_clouds(ray, hit);
        match &self.clouds {
            Some(clouds) if !is_below => {
                clouds.before((&self.sky, self.haze), ray, self.ray_angle).over(radiance)
            }
            _ => radiance,
        }
    }

    /// The same without clouds, of a ray that met something or nothing.
    fn light_behind_clouds(&self, ray: &Ray, hit: Option<Hit>) -> Vector {
        let around = self.setting.around.as_ref();
        if let Some(hit) = hit {
            return match around {
                Some(around) if around.is_beyond(hit.place) => self.met_beyond(around, ray, &hit),
                _ => self.haze.veil(self.met(ray, &hit), ray, hit.ray_length, &self.sky),
            };
        }
        if ray.direction[2] < 0.0 {
            return around.map_or_else(|| self.plain(ray), |around| self.farthest(around, ray));
        }
        self.haze.before_sky(self.sky.radiance_with_sun(ray.direction), ray, &self.sky)
    }

    /// The light that starts at what a ray met.
    fn met(&self, ray: &Ray, hit: &Hit) -> Vector {
        let point = ray.at(hit.ray_length);
        if let Some(normal) = hit.side {
            return self.side(hit.place, point, normal);
        }
        let footprint = self.footprint(hit.ray_length);
        let ground = self.setting.bed.at(hit.place);
        let depth =
            self.setting.level.as_ref().map_or(f32::NEG_INFINITY, |level| level.at(hit.place) - ground);
        let spot = || {
            let (surface, direction) = (self.setting.bed.with_slope(hit.place), ray.direction);
            GroundSpot { place: hit.place, surface, own: surface, point, footprint, direction }
        };
        if depth > 0.0 {
            return self.shore(ray, hit, &spot(), depth);
        }
        let river = self.river(ray, hit, 1.0);
        // No tree stands in a river, and its banks are wet.
        let above = (-depth).min(river.above * self.setting.exaggeration);
        let land = if river.share < 1.0 { self.ground(&spot(), above) } else { [0.0; 3] };
        if river.share <= 0.0 {
            return land;
        }
        let water = WaterSpot { point, depth: river.depth, share: river.share, foam: 0.0, footprint };
        mix(land, self.lake(ray, hit, &water), river.share)
    }

    pub(super) fn footprint(&self, ray_length: f32) -> f32 {
        ray_length * self.ray_angle
    }

    /// Share of the sun's disc that is seen from a point: the part of a disc that a straight horizon leaves free, through the
    /// clouds.
    pub(super) fn sun_seen(&self, point: Vector) -> f32 {
        let sun = self.sky.sun;
        let run = (sun[0] * sun[0] + sun[1] * sun[1]).sqrt().max(1e-6);
        let altitude = libm::atan2f(sun[2], run);
        let radius = self.sky.sun_radius;
        let steepness = |altitude: f32| libm::tanf(altitude.clamp(1e-4, 1.57));
        let limits = [steepness(altitude - radius), steepness(altitude + radius)];
        let horizon = libm::atanf(self.setting.terrain.horizon(point, sun, limits));
        let free = ((altitude - horizon) / radius).clamp(-1.0, 1.0);
        let through = self.clouds.as_ref().map_or(1.0, |clouds| clouds.through(&self.sky, point));
        through * (0.5 + (free * (1.0 - free * free).sqrt() + libm::asinf(free)) * FRAC_1_PI)
    }

    /// Light of sun and sky on a normal.
    pub(super) fn lit(&self, point: Vector, normal: Vector, seen: &Seen) -> Vector {
        let facing = dot(normal, self.sky.sun).max(0.0);
        add(self.sunlight(point, facing), skylight::on(seen, normal, self.bounce))
    }

    /// Light of the sun on what faces it so much.
    fn sunlight(&self, point: Vector, facing: f32) -> Vector {
        let sun = if facing > 0.0 { facing * self.sun_seen(point) } else { 0.0 };
        scale(self.sky.sunlight, sun)
    }

    /// Dry ground, so many metres above the water beside it.
    pub(super) fn ground(&self, spot: &GroundSpot, above: f32) -> Vector {
        let GroundSpot { place, surface: [height, east, south], own, point, footprint, direction } = *spot;
        let terrain = &self.setting.terrain;
        let normal = terrain.normal([east, south]);
        let stretch = self.setting.exaggeration;
        let run = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        let fall = [0, 1].map(|axis| normal[axis] / run.max(1e-6));
        let slope = run / normal[2].max(1e-3) / stretch;
        let [level, sea] = [height - above, self.sea().unwrap_or(f32::MIN)];
        let beach = water::beach(level, sea);
        let sight = [-direction[0], -direction[1], -direction[2] / stretch];
        let spot = SurfacePoint {
            place,
            point: [point[0], point[1], height / stretch],
            slope,
            fall,
            footprint,
            sight,
            above: above / stretch,
            beach,
            bed: bed_of(own, stretch),
        };
        let skin = self.cover.at(&spot);
        let rough = unit([
            normal[0] - normal[2] * skin.bump[0] * stretch,
            normal[1] - normal[2] * skin.bump[1] * stretch,
            normal[2],
        ]);
        let width = water::swash_width(level, sea);
        let albedo = water::wetted(skin.albedo, above, water::wet_reach(width, slope, terrain.cell()));
        let seen = self.skylight.at(self.share(place));
        let facing = facets::facing_sun([normal, rough, self.sky.sun], slope);
        let light = add(self.sunlight(point, facing), skylight::on(&seen, rough, self.bounce));
        scale(filter(albedo, light), FRAC_1_PI)
    }

    /// A cut side.
    fn side(&self, place: [f32; 2], point: Vector, normal: Vector) -> Vector {
        let stretch = self.setting.exaggeration;
        let surface = self.setting.bed.at(place);
        let albedo = if point[2] > surface {
            linear_of_hex(CUT_WATER)
        } else {
            self.setting.strata.albedo(place, point, [point[2] / stretch, surface / stretch])
        };
        let facing = dot(normal, self.sky.sun).max(0.0);
        let outside = add(point, scale(normal, 1.5 * self.setting.terrain.cell()));
        let sun = if facing > 0.0 { facing * self.sun_seen(outside) } else { 0.0 };
        let light = add(scale(self.sky.sunlight, sun), self.sides.on(normal));
        scale(filter(albedo, light), FRAC_1_PI)
    }

    /// The plain that the landscape stands on, which is lost in the haze of the horizon.
    fn plain(&self, ray: &Ray) -> Vector {
        let terrain = &self.setting.terrain;
        let ray_length = (terrain.base - ray.from[2]) / ray.direction[2];
        let mut point = ray.at(ray_length);
        point[2] = terrain.base;
        let share = self.share(terrain.place(point)).map(|share| (share + 1.0) / 3.0);
        let inside = share.iter().all(|share| (0.0..=1.0).contains(share));
        let seen = if inside { self.plain_light.at(share) } else { self.open };
        let light = self.lit(point, [0.0, 0.0, 1.0], &seen);
        let radiance = scale(filter(self.plain, light), FRAC_1_PI);
        let near = self.haze.veil(radiance, ray, ray_length, &self.sky);
        let reach = self.plain_reach();
        let lost = 1.0 - libm::expf(-(ray_length / reach) * (ray_length / reach) * 0.25);
        mix(near, self.sky.radiance([ray.direction[0], ray.direction[1], 0.0]), lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Field, Size};

    /// Ground of 10 m cells with the water that fills it up to a level.
    fn marcher(
        view: &View,
        columns: usize,
        height: impl FnMut(usize, usize) -> f32,
        level: f32,
    ) -> RayMarcher {
        let size = Size::new(columns, 80).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        let ground = Field::from_function(size, height);
        let water = ground.values().iter().map(|ground| (level - ground).max(0.0)).collect();
        landscape.insert("water", "m", Field::from_values(size, water));
        landscape.insert("height", "m", ground);
        RayMarcher::new(view, &landscape, None).expect("it can be drawn")
    }

    fn low_sun() -> View {
        View { sun_azimuth_deg: 270.0, sun_altitude_deg: 20.0, sun_diameter_deg: 2.0, ..View::default() }
    }

    /// Metres, along a line eastward from a cliff that is `height` metres high, over which the sun comes out.
    fn penumbra(height: f32) -> f32 {
        let marcher = marcher(&low_sun(), 300, |x, _| if x < 30 { height } else { 0.0 }, -1.0);
        let seen = |metres: usize| marcher.sun_seen([300.0 + metres as f32, -400.0, 0.0]);
        let first = (20..2600).find(|&metres| seen(metres) > 0.1).expect("the sun comes out");
        let last = (first..2700).find(|&metres| seen(metres) > 0.9).expect("and is whole");
        (last - first) as f32
    }

    #[test]
    fn the_penumbra_is_as_wide_as_the_sun_makes_it_and_widens_with_the_distance() {
        let [near, far] = [150.0, 600.0].map(penumbra);
        assert!((far / near - 4.0).abs() < 0.5, "{near} m and {far} m");
        // From a tenth to nine tenths of a disc of 2° are 1.37°, on ground that the rays meet at 20°.
        let distance = 600.0 / libm::sinf(20_f32.to_radians());
        let expected = distance * 1.37_f32.to_radians() / libm::sinf(20_f32.to_radians());
        assert!((far / expected - 1.0).abs() < 0.15, "{far} m instead of {expected} m");
    }

    #[test]
    fn open_water_mirrors_the_sky_and_a_cliff_beside_it() {
        let marcher = marcher(&low_sun(), 120, |x, _| if x < 40 { 400.0 } else { 0.0 }, 20.0);
        let from = |direction: Vector| Ray { from: [700.0, -400.0, 20.0], direction: unit(direction) };
        for direction in [[1.0, 0.0, 0.3], [0.6, 0.5, 0.4], [0.0, 0.0, 1.0]] {
            let ray = from(direction);
            assert_eq!(marcher.mirrored_light(&ray), marcher.sky.radiance(ray.direction));
        }
        let cliff = from([-1.0, 0.0, 0.2]);
        let [mirrored, sky] = [marcher.mirrored_light(&cliff), marcher.sky.radiance(cliff.direction)];
        assert!(mirrored[2] < 0.7 * sky[2], "{mirrored:?} before a sky of {sky:?}");
    }

    #[test]
    fn the_sea_goes_on_without_a_leap_and_ends_in_a_line_before_the_sky() {
        let size = Size::square(48).expect("small");
        let mut landscape = Landscape::new(Domain { sea_level: Some(0.0), ..Domain::new(size, 40.0) });
        let away = |x: usize, y: usize| (x as f32 - 24.0).hypot(y as f32 - 24.0);
        let ground = Field::from_function(size, |x, y| 300.0 - 40.0 * away(x, y));
        let depths = ground.values().iter().map(|ground| (-ground).max(0.0)).collect();
        landscape.insert("water", "m", Field::from_values(size, depths));
        landscape.insert("height", "m", ground);
        let places = |at: [f64; 2]| Some(weald_core::parameter::Places(vec![at]));
        let (eye, target) = (places([1900.0, 1000.0]), places([4000.0, 1000.0]));
        let view = View { eye, target, eye_height: 800.0, visibility: Some(2e5), ..View::default() };
        let marcher = RayMarcher::new(&view, &landscape, None).expect("it can be drawn");
        // The mean of some directions, beside which waves are small.
        let up = |rise: f32| {
            let direction = |at: u8| unit([1.0, 0.02 * f32::from(at), rise]);
            let light = |at| marcher.light(&Ray { from: marcher.camera.eye, direction: direction(at) })[1];
            (0..60).map(light).sum::<f32>() / 60.0
        };
        let sea: Vec<f32> = (0..120).map(|at| up(-0.15 * 0.95_f32.powi(at))).collect();
        let leap = sea.windows(2).map(|pair| (pair[1] / pair[0] - 1.0).abs()).fold(0.0, f32::max);
        assert!(leap < 0.06, "neighbours differ by {leap}");
        let line = up(0.001) / up(-0.001);
        assert!(line > 1.05, "the sky is {line} times as bright as the sea below it");
    }

    #[test]
    fn each_of_many_rays_stands_for_its_share_of_a_pixel() {
        let seen = |samples: u32| {
            let mut marcher = marcher(&View { samples, ..low_sun() }, 60, |_, _| 0.0, -1.0);
            let first = marcher.footprint(1000.0);
            let camera = marcher.scene().camera();
            marcher.look_from(camera, [2 * marcher.pixels[0], 2 * marcher.pixels[1]]);
            [first, marcher.footprint(1000.0)]
        };
        let one = seen(1);
        assert!((one[0] / one[1] - 2.0).abs() < 0.05, "{one:?}");
        for (samples, share) in [(2, std::f32::consts::FRAC_1_SQRT_2), (4, 0.5), (6, 0.5)] {
            for (many, one) in seen(samples).into_iter().zip(one) {
                assert!((many / one - share).abs() < 1e-3, "{samples} rays: {many} of {one} m");
            }
        }
    }

    #[test]
    fn light_on_an_open_plain_is_that_of_sun_and_sky() {
        let marcher = marcher(&low_sun(), 60, |_, _| 0.0, -1.0);
        let point = [300.0, -400.0, 0.0];
        let light = marcher.lit(point, [0.0, 0.0, 1.0], &marcher.skylight.at([0.5; 2]));
        for (light, expected) in light.into_iter().zip(marcher.sky.on_flat_ground()) {
            assert!((light / expected - 1.0).abs() < 0.03, "{light} instead of {expected}");
        }
    }
}
