//! A landscape lit and made ready to be drawn: what the ray-marched view and a renderer on a GPU share.

use std::f32::consts::FRAC_1_PI;

use super::camera::{self, Camera};
use super::clouds::Clouds;
use super::cover::Cover;
use super::haze::Haze;
use super::keys::View;
use super::setting::{GroundOf, Setting};
use super::side::SideLight;
use super::sky::Sky;
use super::skylight::{self, Seen, Skylight};
use super::surface::Surface;
use super::surroundings::{HeightsBeyond, Surroundings};
use super::terrain::{Ray, Terrain};
use super::tone::Tone;
use super::vector::{Vector, dot, filter, scale, subtract, towards};
use crate::colour::{Linear, linear_of_hex};
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;

/// Optical depth of the haze between the eye and the middle of the landscape.
const DEFAULT_HAZE: f32 = 0.13;

/// Distance, in diagonals of the landscape, over which the plain is lost in the haze.
const PLAIN_REACH: f32 = 2.6;

/// Share of the light on flat ground that sunlit ground around sends into shadows.
const BOUNCE: f32 = 0.8;

/// Colour of the plain.
const PLAIN: u32 = 0xd0_c6b4;

/// Cells of the plain along the landscape's side for which the visible sky is known; the plain is three such sides wide.
const PLAIN_CELLS: usize = 40;

/// Colour of water in a cut side.
pub(super) const CUT_WATER: u32 = 0x1d_4a58;

/// A landscape with its light, air and camera, as a [`View`] describes them.
#[derive(Debug)]
pub struct LitScene {
    pub(super) setting: Setting,
    pub(super) cover: Cover,
    pub(super) camera: Camera,
    pub(super) sky: Sky,
    pub(super) skylight: Skylight,
    pub(super) plain_light: Skylight,
    pub(super) open: Seen,
    pub(super) sides: SideLight,
    pub(super) haze: Haze,
    pub(super) clouds: Option<Clouds>,
    pub(super) tone: Tone,
    /// Radiance of the ground around that is seen from hidden places.
    pub(super) bounce: Vector,
    /// Colour of the plain, or of the last ground before the horizon.
    pub(super) plain: Linear,
    pub(super) is_empty: bool,
    /// How far one sees at the lowest ground, where the view says so.
    visibility: Option<f64>,
}

impl LitScene {
    /// The scene of a view of a landscape.
    ///
    /// # Errors
    /// [`Error::Limit`] where a map of it would be too large, [`Error::Run`] for a layer that is missing.
    pub fn new(view: &View, landscape: &Landscape) -> Result<Self, Error> {
        Self::on_ground(GroundOf::default(), view, landscape)
    }

    /// The scene of a view with crags on what is steep: those are finer than the cells of the landscape, which the scene then
    /// has more of. For pictures of a landscape that does not change.
    ///
    /// # Errors
    /// As [`LitScene::new`].
    pub fn with_crags(view: &View, landscape: &Landscape) -> Result<Self, Error> {
        Self::on_ground(GroundOf { has_crags: true, ..GroundOf::default() }, view, landscape)
    }

    /// The scene of the same view when its landscape has changed: heights count from where they did, so that cameras stay
    /// what they are, and haze and exposure are as they were.
    ///
    /// # Errors
    /// As [`LitScene::new`].
    pub fn changed(&self, view: &View, landscape: &Landscape) -> Result<Self, Error> {
        let ground_of = GroundOf { from: Some(self.setting.low), has_crags: self.setting.has_crags };
        let scene = Self::on_ground(ground_of, view, landscape)?;
        Ok(Self { haze: self.haze, tone: self.tone, camera: self.camera, ..scene })
    }

    fn on_ground(ground_of: GroundOf, view: &View, landscape: &Landscape) -> Result<Self, Error> {
        let (setting, sites) = Setting::new(view, landscape, ground_of)?;
        let sky = Sky::new(towards(view.sun_azimuth_deg, view.sun_altitude_deg), view.sun_diameter_deg);
        let terrain = &setting.terrain;
        let camera = setting.above_ground(Camera::new(view, terrain, setting.exaggeration));
        let cover = Cover::new(sites, &setting, sky.sun);
        // Where ground goes on to the horizon, the last of it is like the landscape.
        let plain = if setting.around.is_some() { cover.mean() } else { linear_of_hex(PLAIN) };
        let clouds = Clouds::new(view.clouds, &sky, [terrain.highest(), setting.exaggeration]);
        let lighting = clouds.map_or_else(|| sky.clone(), |clouds| clouds.over_ground(&sky));
        let level = lighting.on_flat_ground();
        let sent_back = |albedo: Linear, share: f32| scale(filter(albedo, level), share * FRAC_1_PI);
        Ok(Self {
            skylight: Skylight::new(&lighting, &terrain.top, terrain.spacing, setting.sky_cells),
            plain_light: light_of_plain(&lighting, &setting.terrain),
            open: skylight::open(&lighting),
            sides: SideLight::new(&lighting, sent_back(plain, 1.0)),
            bounce: sent_back(cover.mean(), BOUNCE),
            haze: haze(view.visibility, &camera, &setting),
            clouds,
            tone: Tone::new(&sky, view.exposure),
            is_empty: landscape.domain.valid_cells() == 0,
            visibility: view.visibility,
            plain,
            sky,
            camera,
            cover,
            setting,
        })
    }

    /// The camera of the view.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// The camera of another view of the same landscape.
    pub fn camera_of(&self, view: &View) -> Camera {
        self.setting.above_ground(Camera::new(view, &self.setting.terrain, self.setting.exaggeration))
    }

    /// The point in the middle of the landscape, half-way up.
    pub fn middle(&self) -> [f32; 3] {
        camera::middle(&self.setting.terrain)
    }

    /// Height of the highest ground.
    pub fn highest(&self) -> f32 {
        self.setting.terrain.highest()
    }

    /// The scene for another camera, with so much haze as suits it where the view does not say how much.
    #[must_use]
    pub fn seen_from(mut self, camera: Camera) -> Self {
        self.look_from(camera);
        self
    }

    pub(super) fn look_from(&mut self, camera: Camera) {
        self.haze = haze(self.visibility, &camera, &self.setting);
        self.camera = camera;
    }

    /// Columns and rows of the surfaces.
    pub fn cells(&self) -> [usize; 2] {
        let size = self.setting.terrain.top.size();
        [size.columns, size.rows]
    }

    /// Sides of a cell eastward and southward, in metres.
    pub fn spacing(&self) -> [f32; 2] {
        self.setting.terrain.spacing
    }

    /// Height of the plain that the landscape stands on, below 0.
    pub fn base(&self) -> f32 {
        self.setting.terrain.base
    }

    /// The height at which clouds begin that drift above it, as it is drawn; `None` where there are none.
    pub fn cloud_base(&self) -> Option<f32> {
        self.clouds.as_ref().map(|clouds| clouds.height)
    }

    /// Whether some of it has no data.
    pub fn has_holes(&self) -> bool {
        self.setting.terrain.land.is_some()
    }

    /// Whether there is water: lakes, or rivers thinner than cells.
    pub fn has_water(&self) -> bool {
        self.setting.level.is_some() || self.setting.rivers.is_some()
    }

    /// Direction of the sun, of length 1.
    pub fn sun(&self) -> [f32; 3] {
        self.sky.sun
    }

    /// Whether there is no land at all.
    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Height of the sea as it is drawn.
    pub(super) fn sea(&self) -> Option<f32> {
        self.setting.sea
    }

    /// A place in shares of the landscape.
    pub(super) fn share(&self, place: [f32; 2]) -> [f32; 2] {
        let size = self.setting.terrain.top.size();
        [(place[0] - 0.5) / size.columns as f32, (place[1] - 0.5) / size.rows as f32]
    }

    /// Distance in metres over which the plain is lost in the haze.
    pub(super) fn plain_reach(&self) -> f32 {
        PLAIN_REACH * self.setting.extent()
    }

    /// Height of the drawn ground, or of the water on it, at a point in metres eastward and southward of the
    /// north-western corner, above the lowest ground and times the exaggeration; `None` outside the land.
    pub fn top_at(&self, [east, south]: [f64; 2]) -> Option<f32> {
        let terrain = &self.setting.terrain;
        let place = terrain.place([east as f32, -south as f32, 0.0]);
        terrain.is_valid(place).then(|| terrain.top.at(place))
    }

    /// The point so many metres above the drawn ground at a place in metres eastward and southward; above what is drawn around
    /// it outside the land.
    pub fn above_ground(&self, place: [f64; 2], metres: f64) -> [f32; 3] {
        let ground = self.top_at(place).unwrap_or_else(|| self.around_at(place));
        let [east, south] = place;
        [east as f32, -south as f32, ground + metres as f32 * self.setting.exaggeration]
    }

    /// A camera that stands so many metres above the drawn ground at least: on its way between two points of a flight a hill
    /// may stand higher than both.
    pub fn kept_above_ground(&self, mut camera: Camera, metres: f64) -> Camera {
        let [east, north, height] = camera.eye;
        let [.., lowest] = self.above_ground([f64::from(east), f64::from(-north)], metres);
        camera.eye[2] = height.max(lowest);
        camera
    }

    /// Height of what is drawn around the landscape at such a point: of the plain, or of the ground or water there.
    fn around_at(&self, [east, south]: [f64; 2]) -> f32 {
        let place = self.setting.terrain.place([east as f32, -south as f32, 0.0]);
        self.setting.around.as_ref().map_or(self.base(), |around| self.setting.top_beyond(around, place))
    }

    /// How high the ground is that goes on beyond the border, for seven of the longer sides of the landscape; `None` where the
    /// landscape is a block.
    pub fn beyond(&self) -> Option<HeightsBeyond> {
        self.setting.around.as_ref().map(Surroundings::heights)
    }

    /// Height of the drawn ground under the water at such a point; `None` outside the land.
    pub fn bed_at(&self, [east, south]: [f64; 2]) -> Option<f32> {
        let terrain = &self.setting.terrain;
        let place = terrain.place([east as f32, -south as f32, 0.0]);
        terrain.is_valid(place).then(|| self.setting.bed.at(place))
    }

    /// Metres along a ray at which it meets the ground or the water on it, as far as that is not changed while it is drawn;
    /// `None` where it meets a cut side, or nothing of the land.
    pub fn met_by(&self, ray: &Ray) -> Option<f32> {
        let hit = self.setting.trace(ray, [0.0, f32::INFINITY]).filter(|_| !self.is_empty)?;
        let is_beyond = self.setting.around.as_ref().is_some_and(|around| around.is_beyond(hit.place));
        (hit.side.is_none() && !is_beyond).then_some(hit.ray_length)
    }

    /// Height at which an elevation in metres is drawn, above the lowest ground.
    pub fn drawn_height(&self, elevation: f64) -> f32 {
        (elevation - f64::from(self.setting.low)) as f32 * self.setting.exaggeration
    }
}

/// The haze of a view whose camera looks over the landscape.
fn haze(visibility: Option<f64>, camera: &Camera, setting: &Setting) -> Haze {
    let stretch = setting.exaggeration;
    let haze = if let Some(visibility) = visibility {
        Haze::new(visibility, stretch)
    } else {
        let away = subtract(setting.centre(), camera.eye);
        let ray_length = dot(away, away).sqrt().max(1e-3);
        let ray = Ray { from: camera.eye, direction: scale(away, 1.0 / ray_length) };
        Haze::of_depth(DEFAULT_HAZE, &ray, ray_length, stretch)
    };
    let height = (camera.eye[2] - setting.sea.unwrap_or(0.0)) / stretch;
    if setting.around.is_some() { haze.up_to_the_horizon(height) } else { haze }
}

/// The sky that is seen from the plain, three times as wide as the landscape.
fn light_of_plain(sky: &Sky, terrain: &Terrain) -> Skylight {
    let (inner, size) = (terrain.top.size(), Size { columns: 3 * PLAIN_CELLS, rows: 3 * PLAIN_CELLS });
    let share =
        |cell: usize, cells: usize| 0.5 + ((cell as f32 + 0.5) / PLAIN_CELLS as f32 - 1.0) * cells as f32;
    let height = Field::from_function(size, |x, y| {
        let place = [share(x, inner.columns), share(y, inner.rows)];
        if terrain.is_valid(place) { terrain.top.at(place) } else { terrain.base }
    });
    let spacing = [0, 1]
        .map(|axis| terrain.spacing[axis] * [inner.columns, inner.rows][axis] as f32 / PLAIN_CELLS as f32);
    Skylight::new(sky, &Surface::new(&height), spacing, 3 * PLAIN_CELLS)
}
