//! A landscape made ready for a relief picture, and the colour of each of its pixels.

use rayon::prelude::*;

use super::automatic;
use super::colour::{Linear, encode, linear_of_hex, mix};
use super::contours::{Contours, automatic_interval, ramp};
use super::ground::{drawable, land_share};
use super::lakes::{Lakes, Rise};
use super::light::{Lights, shoulder};
use super::paint::Paint;
use super::rivers;
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use super::strokes::Strokes;
use super::texture::texture;
use super::{Image, PAPER};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

/// How much of the brightness texture shading may add or take.
const TEXTURE_STRENGTH: f32 = 0.28;

/// Brightness that sunlit slopes may gain over flat ground.
const SUNLIT_ROOM: f32 = 0.42;

/// The same on tints so light that little is left above them.
const MIN_HEADROOM: f32 = 0.05;

/// Which ground is drawn, and how it is lit.
pub(super) struct Shading<'a> {
    /// Layer of heights in metres.
    pub(super) of: &'a str,
    /// Where the light comes from, clockwise from north.
    pub(super) sun_azimuth_deg: f64,
    /// Height of the sun above the horizon.
    pub(super) sun_altitude_deg: f64,
    /// Factor on heights; `None` for one that suits the ground.
    pub(super) exaggeration: Option<f64>,
    /// Height between contours, 0 without any; `None` for one that suits the ground.
    pub(super) contours: Option<f64>,
    /// Whether lakes and rivers are drawn.
    pub(super) water: bool,
    /// Depth in metres from which water is drawn as a surface; `None` for one that suits the cells.
    pub(super) shallowest: Option<f64>,
    /// Least upslope area of a river in m²; `None` for one that suits the grid.
    pub(super) least_area: Option<f64>,
}

/// Everything that a pixel needs to know.
pub(super) struct Scene {
    sheet: Sheet,
    spline: Spline,
    /// Height above `low`.
    height: Field,
    /// Texture in units of its usual strength.
    texture: Field,
    land: Option<Field>,
    low: f32,
    /// Heights above `low` of the first and the last tint.
    tints: [f32; 2],
    /// Rise drawn for a rise of one metre a cell.
    steepness: [f32; 2],
    paint: Paint,
    lights: Lights,
    contours: Option<Contours>,
    water: Water,
    inks: Inks,
}

/// The fields along one row of pixels.
#[derive(Default)]
struct Rows {
    height: SplineRow,
    texture: SplineRow,
    land: SplineRow,
    level: SplineRow,
    depth: SplineRow,
    paint: [SplineRow; 3],
}

impl Scene {
    pub(super) fn new(
        shading: &Shading<'_>,
        landscape: &Landscape,
        sheet: Sheet,
        paint: Paint,
    ) -> Result<Self, Error> {
        let land = landscape.domain.valid.as_ref();
        let field = landscape.field(shading.of)?;
        let (low, high) = field.range(land).unwrap_or((0.0, 0.0));
        let mut height = drawable(field, land, &sheet);
        height.values_mut().iter_mut().for_each(|height| *height -= low);
        let spacing = spacing(landscape, &height);
        let exaggeration = shading.exaggeration.unwrap_or_else(|| automatic::exaggeration(&height, spacing));
        let interval = shading.contours.or_else(|| automatic_interval(f64::from(high - low)));
        let line = 0.85 * sheet.line();
        let contours = interval.filter(|&interval| interval > 0.0);
        let land = land_share(land, &sheet);
        let water = if shading.water { Water::of(landscape, &sheet, shading) } else { Water::default() };
        Ok(Self {
            spline: Spline::new(&sheet, height.size().columns, height.size().rows),
            texture: automatic::normalised(texture(&height), high - low),
            tints: automatic::tint_range(&height, land.as_ref(), water.lakes.as_ref()),
            height,
            land,
            low,
            steepness: spacing.map(|spacing| (exaggeration / spacing) as f32),
            paint,
            lights: Lights::new(shading.sun_azimuth_deg, shading.sun_altitude_deg),
            contours: contours.map(|interval| Contours { interval: interval as f32, lowest: low, line }),
            water,
            inks: Inks::default(),
            sheet,
        })
    }

    /// The picture.
    pub(super) fn draw(&self) -> Image {
        let mut rgb = vec![0; 3 * self.sheet.width * self.sheet.height];
        rgb.par_chunks_mut(3 * self.sheet.width).enumerate().for_each_init(
            Rows::default,
            |rows, (y, out)| {
                self.evaluate(y, rows);
                for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
                    pixel.copy_from_slice(&encode(self.pixel(x, y, rows)));
                }
            },
        );
        Image { width: self.sheet.width, height: self.sheet.height, rgb }
    }

    /// Evaluates the fields along row `y` of the sheet.
    fn evaluate(&self, y: usize, rows: &mut Rows) {
        self.spline.row(&self.height, y, &mut rows.height);
        self.paint.evaluate(&self.spline, y, &mut rows.paint);
        self.spline.row(&self.texture, y, &mut rows.texture);
        if let Some(land) = &self.land {
            self.spline.row(land, y, &mut rows.land);
        }
        if let Some(lakes) = &self.water.lakes {
            self.spline.row(&lakes.level, y, &mut rows.level);
            self.spline.row(&lakes.depth, y, &mut rows.depth);
        }
    }

    /// The colour of a pixel of the evaluated row.
    fn pixel(&self, x: usize, y: usize, rows: &Rows) -> Linear {
        let land = match &self.land {
            Some(_) => land_cover(Rise::at(&rows.land, x, self.cells_per_pixel())),
            None => 1.0,
        };
        if land <= 0.0 {
            return PAPER;
        }
        let mut colour = self.ground(x, rows);
        if let Some(rivers) = &self.water.rivers {
            colour = mix(colour, self.inks.river, rivers.row(y)[x]);
        }
        if let Some(lakes) = &self.water.lakes {
            let level = Rise::at(&rows.level, x, self.cells_per_pixel());
            let (lake, cover) = lakes.at(level, rows.depth.value[x], self.sheet.line());
            colour = mix(colour, lake, cover);
        }
        mix(PAPER, colour, land)
    }

    /// Lit and tinted ground with its contours.
    fn ground(&self, x: usize, rows: &Rows) -> Linear {
        let height = rows.height.value[x];
        let share = ((height - self.tints[0]) / (self.tints[1] - self.tints[0])).clamp(0.0, 1.0);
        let (east, south) = (rows.height.east[x], rows.height.south[x]);
        let light = self.lights.on(east * self.steepness[0], south * self.steepness[1]);
        let contrast = 0.84 + 0.28 * share;
        let texture = rows.texture.value[x];
        let bump = 1.0 + TEXTURE_STRENGTH * contrast * texture / (1.0 + texture * texture).sqrt();
        let tint =
            mix(self.paint.at(x, share, &rows.paint), self.inks.haze, 0.14 * (1.0 - ramp(share, 0.0, 0.45)));
        let lit = |c: usize| {
            let room = (1.0 / tint[c] - 1.0).clamp(MIN_HEADROOM, SUNLIT_ROOM);
            tint[c] * shoulder((1.0 + contrast * (light[c] - 1.0)).max(0.0) * bump, room)
        };
        let colour = std::array::from_fn(lit);
        let Some(contours) = &self.contours else { return colour };
        let rise = self.cells_per_pixel() * (east * east + south * south).sqrt();
        let ink = contours.ink(height + self.low, rise);
        mix(colour, std::array::from_fn(|c| colour[c] * self.inks.contour[c]), 0.62 * ink)
    }

    /// Cells of the drawn fields in one pixel.
    fn cells_per_pixel(&self) -> f32 {
        self.height.size().columns as f32 / self.sheet.width as f32
    }
}

/// Share of a pixel inside the half-land line.
fn land_cover(land: Rise) -> f32 {
    (0.5 + (land.value - 0.5) / land.by_pixel.max(1e-6)).clamp(0.0, 1.0)
}

/// Colours that do not depend on the ramp.
struct Inks {
    contour: Linear,
    river: Linear,
    haze: Linear,
}

impl Default for Inks {
    fn default() -> Self {
        let [contour, river, haze] = [0x6b_4a2f, 0x2a_79b0, 0xd5_e2ea].map(linear_of_hex);
        Self { contour, river, haze }
    }
}

/// Metres between the columns and between the rows of a drawn field.
fn spacing(landscape: &Landscape, drawn: &Field) -> [f64; 2] {
    let (whole, drawn) = (landscape.domain.size, drawn.size());
    [whole.columns as f64 / drawn.columns as f64, whole.rows as f64 / drawn.rows as f64]
        .map(|cells| cells * landscape.domain.cell)
}

/// What there is of water in a landscape.
#[derive(Default)]
struct Water {
    lakes: Option<Lakes>,
    rivers: Option<Strokes>,
}

impl Water {
    fn of(landscape: &Landscape, sheet: &Sheet, shading: &Shading<'_>) -> Self {
        let domain = &landscape.domain;
        let water = landscape.field("water").ok().zip(landscape.field(shading.of).ok());
        let lakes =
            water.and_then(|(water, ground)| Lakes::of([water, ground], domain, sheet, shading.shallowest));
        let flux = landscape.field("flux_x").ok().zip(landscape.field("flux_y").ok());
        let rivers = flux.and_then(|(x, y)| rivers::draw([x, y], domain, sheet, shading.least_area));
        Self { lakes, rivers }
    }
}
