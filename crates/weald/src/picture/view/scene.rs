//! The light that reaches each pixel of a view.

use super::View;
use super::camera::Camera;
use super::cover::{Cover, Spot};
use super::haze::Haze;
use super::setting::Setting;
use super::side::SideLight;
use super::sky::Sky;
use super::skylight::{self, Seen, Skylight};
use super::surface::Surface;
use super::terrain::{Hit, Ray};
use super::tone::Tone;
use super::vector::{Vector, add, dot, filter, mirrored, scale, subtract, towards, unit};
use super::water;
use crate::error::Error;
use crate::grid::{Field, Size};
use crate::landscape::Landscape;
use crate::picture::colour::{Linear, linear_of_hex, mix};

/// Most cells, along the longer side, for which the visible sky is known.
const SKYLIGHT_CELLS: usize = 1024;

/// Cells of the plain along the landscape's side for which the visible sky is known; the plain is three such sides wide.
const PLAIN_CELLS: usize = 64;

/// How many times as far as to the middle of the landscape one sees through the haze.
const CLEAR: f64 = 7.0;

/// Distance, in diagonals of the landscape, over which the plain is lost in the haze.
const PLAIN_REACH: f32 = 2.6;

/// Share of the light on level ground that sunlit ground around sends into shadows.
const BOUNCE: f32 = 0.5;

/// Colour of the plain.
const PLAIN: u32 = 0xc9_c4b8;

/// Colour of water in a cut side.
const CUT_WATER: u32 = 0x1d_4a58;

/// Everything that a pixel needs to know.
pub(super) struct Scene {
    setting: Setting,
    cover: Cover,
    camera: Camera,
    sky: Sky,
    skylight: Skylight,
    plain_light: Skylight,
    open: Seen,
    sides: SideLight,
    haze: Haze,
    tone: Tone,
    /// Radiance of the ground around that is seen from hidden places.
    bounce: Vector,
    plain: Linear,
    pixels: [usize; 2],
    samples: Vec<[f32; 2]>,
    pixel_angle: f32,
    is_empty: bool,
}

impl Scene {
    pub(super) fn new(view: &View, landscape: &Landscape) -> Result<Self, Error> {
        let (setting, sites) = Setting::new(view, landscape)?;
        let sun = towards(view.sun_azimuth_deg, view.sun_altitude_deg);
        let sky = Sky::new(sun, view.sun_diameter_deg);
        let terrain = &setting.terrain;
        let camera = Camera::new(view, terrain, setting.exaggeration);
        let level = sky.on_level_ground();
        let cover = Cover::new(sites, setting.limits);
        let bounce = scale(filter(cover.mean(), level), BOUNCE * std::f32::consts::FRAC_1_PI);
        let plain = linear_of_hex(PLAIN);
        let plain_radiance = scale(filter(plain, level), std::f32::consts::FRAC_1_PI);
        let centre = {
            let size = terrain.top.size();
            terrain.point([0.5 + 0.5 * size.columns as f32, 0.5 + 0.5 * size.rows as f32], 0.0)
        };
        let away = subtract(camera.eye, centre);
        let visibility =
            view.visibility.unwrap_or(CLEAR * f64::from(dot(away, away).sqrt().max(extent(&setting))));
        let pixels = [view.width as usize, view.height as usize];
        Ok(Self {
            skylight: Skylight::new(&sky, &terrain.top, terrain.spacing, SKYLIGHT_CELLS),
            plain_light: plain_light(&sky, &setting),
            open: skylight::open(&sky),
            sides: SideLight::new(&sky, plain_radiance),
            haze: Haze::new(visibility, setting.exaggeration),
            tone: Tone::new(level, view.exposure),
            samples: samples(view.samples),
            pixel_angle: camera.pixel_angle(pixels[0]),
            is_empty: !Setting::has_land(landscape),
            bounce,
            plain,
            pixels,
            sky,
            camera,
            cover,
            setting,
        })
    }

    /// The bytes of a pixel, counted from the top left.
    pub(super) fn pixel(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let mut sum = [0.0; 3];
        for offset in &self.samples {
            let across = 2.0 * (x as f32 + 0.5 + offset[0]) / self.pixels[0] as f32 - 1.0;
            let up = 1.0 - 2.0 * (y as f32 + 0.5 + offset[1]) / self.pixels[1] as f32;
            // One ray into the sun must not outshine all others of its pixel.
            let light = self.tone.limited(self.light(&self.camera.ray([across, up])));
            sum = add(sum, light);
        }
        self.tone.bytes(scale(sum, 1.0 / self.samples.len() as f32), [x, y])
    }

    /// The light that comes along a ray to the eye.
    fn light(&self, ray: &Ray) -> Vector {
        if let Some(hit) = self.setting.terrain.trace(ray, [0.0, f32::INFINITY]).filter(|_| !self.is_empty) {
            return self.haze.veil(self.met(ray, &hit), ray, hit.way, &self.sky);
        }
        if ray.direction[2] < 0.0 {
            return self.plain(ray);
        }
        self.sky.radiance_with_sun(ray.direction)
    }

    /// The light that starts at what a ray met.
    fn met(&self, ray: &Ray, hit: &Hit) -> Vector {
        let point = ray.at(hit.way);
        if let Some(normal) = hit.side {
            return self.side(hit.place, point, normal);
        }
        let footprint = self.footprint(hit.way);
        let ground = self.setting.bed.at(hit.place);
        let depth =
            self.setting.level.as_ref().map_or(f32::NEG_INFINITY, |level| level.at(hit.place) - ground);
        if depth > 0.0 {
            return self.lake(ray, hit, point, depth / self.setting.exaggeration);
        }
        let river = self.setting.rivers.as_ref().map_or(0.0, |rivers| rivers.at(self.share(hit.place)));
        let land = if river < 1.0 { self.ground(hit.place, point, footprint, -depth) } else { [0.0; 3] };
        if river <= 0.0 {
            return land;
        }
        mix(land, self.lake(ray, hit, point, 1.2 * river), river)
    }

    fn footprint(&self, way: f32) -> f32 {
        way * self.pixel_angle
    }

    /// A place in shares of the landscape.
    fn share(&self, place: [f32; 2]) -> [f32; 2] {
        let size = self.setting.terrain.top.size();
        [(place[0] - 0.5) / size.columns as f32, (place[1] - 0.5) / size.rows as f32]
    }

    /// Share of the sun's disc that is seen from a point: the part of a disc that a straight horizon leaves free.
    fn sun_seen(&self, point: Vector) -> f32 {
        let sun = self.sky.sun;
        let run = (sun[0] * sun[0] + sun[1] * sun[1]).sqrt().max(1e-6);
        let altitude = libm::atan2f(sun[2], run);
        let radius = self.sky.sun_radius;
        let steepness = |altitude: f32| libm::tanf(altitude.clamp(1e-4, 1.57));
        let limits = [steepness(altitude - radius), steepness(altitude + radius)];
        let horizon = libm::atanf(self.setting.terrain.horizon(point, sun, limits));
        let free = ((altitude - horizon) / radius).clamp(-1.0, 1.0);
        0.5 + (free * (1.0 - free * free).sqrt() + libm::asinf(free)) * std::f32::consts::FRAC_1_PI
    }

    /// Light of sun and sky on a normal.
    fn lit(&self, point: Vector, normal: Vector, seen: &Seen) -> Vector {
        let facing = dot(normal, self.sky.sun).max(0.0);
        let sun = if facing > 0.0 { facing * self.sun_seen(point) } else { 0.0 };
        add(scale(self.sky.sunlight, sun), skylight::on(seen, normal, self.bounce))
    }

    /// Dry ground, so many metres above the water beside it.
    fn ground(&self, place: [f32; 2], point: Vector, footprint: f32, above: f32) -> Vector {
        let [height, east, south] = self.setting.bed.with_slope(place);
        let terrain = &self.setting.terrain;
        let normal = terrain.normal([east, south]);
        let stretch = self.setting.exaggeration;
        let steep = (1.0 - normal[2] * normal[2]).max(0.0).sqrt() / normal[2].max(1e-3) / stretch;
        let run = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt().max(1e-6);
        let fall = [normal[0] / run, normal[1] / run];
        let spot =
            Spot { place, fall, point: [point[0], point[1], height / stretch], slope: steep, footprint };
        let skin = self.cover.at(&spot);
        let rough = unit([
            normal[0] - normal[2] * skin.bump[0] * stretch,
            normal[1] - normal[2] * skin.bump[1] * stretch,
            normal[2],
        ]);
        let albedo = water::wetted(skin.albedo, above, terrain.cell());
        let light = self.lit(point, rough, &self.skylight.at(self.share(place)));
        scale(filter(albedo, light), std::f32::consts::FRAC_1_PI)
    }

    /// Water of a depth.
    fn lake(&self, ray: &Ray, hit: &Hit, point: Vector, depth: f32) -> Vector {
        let terrain = &self.setting.terrain;
        let back = scale(ray.direction, -1.0);
        let footprint = self.footprint(hit.way) / back[2].max(0.05).sqrt();
        let normal = water::ripples(point, 0.7 * terrain.cell(), footprint);
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
        let below = water::body(self.cover.gravel(), depth, light);
        let surface = add(scale(reflection, share), scale(below, 1.0 - share));
        add(surface, scale(self.sky.sunlight, glint))
    }

    /// The light that water mirrors: land with its own colours, water on it as the sky that it mirrors.
    fn mirrored_light(&self, ray: &Ray) -> Vector {
        let terrain = &self.setting.terrain;
        let start = 0.4 * terrain.cell();
        let Some(hit) = terrain.trace(ray, [start, f32::INFINITY]).filter(|hit| hit.side.is_none()) else {
            return self.sky.radiance(ray.direction);
        };
        let point = ray.at(hit.way);
        let ground = self.ground(hit.place, point, (0.25 * terrain.cell()).max(self.footprint(hit.way)), 1e9);
        self.haze.veil(ground, ray, hit.way, &self.sky)
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
        let outside = add(point, scale(normal, 0.01 * self.setting.terrain.cell()));
        let sun = if facing > 0.0 { facing * self.sun_seen(outside) } else { 0.0 };
        let light = add(scale(self.sky.sunlight, sun), self.sides.on(normal));
        scale(filter(albedo, light), std::f32::consts::FRAC_1_PI)
    }

    /// The plain that the landscape stands on, which is lost in the haze of the horizon.
    fn plain(&self, ray: &Ray) -> Vector {
        let terrain = &self.setting.terrain;
        let way = (terrain.base - ray.from[2]) / ray.direction[2];
        let mut point = ray.at(way);
        point[2] = terrain.base;
        let share = self.share(terrain.place(point)).map(|share| (share + 1.0) / 3.0);
        let inside = share.iter().all(|share| (0.0..=1.0).contains(share));
        let seen = if inside { self.plain_light.at(share) } else { self.open };
        let light = self.lit(point, [0.0, 0.0, 1.0], &seen);
        let radiance = scale(filter(self.plain, light), std::f32::consts::FRAC_1_PI);
        let near = self.haze.veil(radiance, ray, way, &self.sky);
        let reach = PLAIN_REACH * extent(&self.setting);
        let lost = 1.0 - libm::expf(-(way / reach) * (way / reach) * 0.25);
        mix(near, self.sky.radiance([ray.direction[0], ray.direction[1], 0.0]), lost)
    }
}

/// The diagonal of the landscape in metres.
fn extent(setting: &Setting) -> f32 {
    let (size, spacing) = (setting.terrain.top.size(), setting.terrain.spacing);
    let sides = [size.columns as f32 * spacing[0], size.rows as f32 * spacing[1]];
    (sides[0] * sides[0] + sides[1] * sides[1]).sqrt()
}

/// The sky that is seen from the plain, three times as wide as the landscape.
fn plain_light(sky: &Sky, setting: &Setting) -> Skylight {
    let terrain = &setting.terrain;
    let (inner, size) = (terrain.top.size(), Size { columns: 3 * PLAIN_CELLS, rows: 3 * PLAIN_CELLS });
    let share =
        |cell: usize, cells: usize| 0.5 + ((cell as f32 + 0.5) / PLAIN_CELLS as f32 - 1.0) * cells as f32;
    let height = Field::from_function(size, |x, y| {
        let place = [share(x, inner.columns), share(y, inner.rows)];
        if terrain.is_land(place) { terrain.top.at(place) } else { terrain.base }
    });
    let spacing = [0, 1]
        .map(|axis| terrain.spacing[axis] * [inner.columns, inner.rows][axis] as f32 / PLAIN_CELLS as f32);
    Skylight::new(sky, &Surface::new(&height), spacing, 3 * PLAIN_CELLS)
}

/// Places of the rays within a pixel, from its middle: spread by the plastic number (M. Roberts 2018) and drawn
/// towards the middle as a tent filter weighs them, two pixels wide.
fn samples(count: u32) -> Vec<[f32; 2]> {
    let tent = |share: f64| {
        if share < 0.5 { (2.0 * share).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * share).sqrt() }
    };
    let place = |sample: u32, step: f64| {
        let share = 0.5 + f64::from(sample) * step;
        tent(share - share.floor()) as f32 * 0.8
    };
    (0..count)
        .map(|sample| [place(sample, 0.754_877_666_246_692_8), place(sample, 0.569_840_290_998_053_3)])
        .collect()
}
