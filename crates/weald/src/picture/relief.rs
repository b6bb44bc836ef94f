//! Shaded relief: height tints lit by several lights, texture shading, aerial perspective, contours, lakes and
//! rivers.
//!
//! The surface is a cubic B-spline on a sheet at least as fine as the grid; colours are mixed in linear light.
//! Aerial perspective after Eduard Imhof, "Kartographische Geländedarstellung" (1965): contrast grows with
//! height, and valleys lie in a light haze.

use rayon::prelude::*;

use super::colour::{Linear, encode, linear_of_hex, mix};
use super::contours::{Contours, automatic_interval, ramp};
use super::ground::{drawable, land_share};
use super::lakes::{Lakes, Rise};
use super::light::{Lights, shoulder};
use super::ramp::{Ramp, Tint};
use super::rivers;
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use super::strokes::Strokes;
use super::texture::texture;
use super::{Image, PAPER, Picture};
use crate::error::Error;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::recipe::parameter::LayerName;

crate::parameters! {
    /// A shaded relief picture.
    pub struct Relief {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Width of the picture. By default the longer side has one pixel a cell, but 1024 at least and 4096 at most.
        width: Option<u32> = None, range 16..=16384, unit "px";
        /// Colours of heights.
        ramp: Tint = Tint::Hypsometric;
        /// Where the light comes from, clockwise from north. Maps are lit from the north-west: lit from below,
        /// hills look like hollows.
        sun_azimuth_deg: f64 = 315.0, range 0.0..=360.0, unit "deg";
        /// Height of the sun above the horizon.
        sun_altitude_deg: f64 = 45.0, range 5.0..=90.0, unit "deg";
        /// Factor on heights before they are lit. By default the one with which the slope that one cell in ten
        /// exceeds becomes 45°, within 0.02 to 50.
        exaggeration: Option<f64> = None, range 0.01..=1000.0;
        /// Height between contours; 0 draws none. By default a step of the series 1, 2, 5 that gives about
        /// fourteen intervals.
        contours: Option<f64> = None, range 0.0..=100_000.0, unit "m";
        /// Whether lakes (layer `water`) and rivers (layers `flux_x`, `flux_y`) are drawn where they exist.
        water: bool = true;
    }
}

impl Picture for Relief {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        if self.water { ["water", "flux_x", "flux_y"].map(str::to_owned).to_vec() } else { Vec::new() }
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let sheet = Sheet::new(&landscape.domain, self.width)?;
        let scene = Scene::new(self, landscape, sheet)?;
        let mut rgb = vec![0; 3 * sheet.width * sheet.height];
        rgb.par_chunks_mut(3 * sheet.width).enumerate().for_each_init(Rows::default, |rows, (y, out)| {
            scene.evaluate(y, rows);
            for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
                pixel.copy_from_slice(&encode(scene.pixel(x, y, rows)));
            }
        });
        Ok(Image { width: sheet.width, height: sheet.height, rgb })
    }
}

/// Slope to which the steepest tenth of the land is exaggerated: the tangent of 45°.
const DRAWN_SLOPE: f64 = 1.0;

/// How much of the brightness texture shading may add or take.
const TEXTURE_STRENGTH: f32 = 0.28;

/// Texture that is this share of the relief or less is noise, and is not stretched to full strength.
const FAINTEST_TEXTURE: f32 = 2e-4;

/// Brightness that sunlit slopes may gain over level ground.
const SUNLIT_ROOM: f32 = 0.42;

/// The same on tints so light that little is left above them.
const LEAST_ROOM: f32 = 0.05;

/// Everything that a pixel needs to know.
struct Scene {
    sheet: Sheet,
    spline: Spline,
    height: Field,
    /// Height above `low`, and texture in units of its usual strength.
    texture: Field,
    land: Option<Field>,
    low: f32,
    relief: f32,
    /// Rise drawn for a rise of one metre a cell.
    steepness: [f32; 2],
    ramp: Ramp,
    lights: Lights,
    contours: Option<Contours>,
    contour_ink: Linear,
    lakes: Option<Lakes>,
    rivers: Option<Strokes>,
    river: Linear,
    haze: Linear,
}

/// The fields along one row of pixels.
#[derive(Default)]
struct Rows {
    height: SplineRow,
    texture: SplineRow,
    land: SplineRow,
    level: SplineRow,
    depth: SplineRow,
}

impl Scene {
    fn new(picture: &Relief, landscape: &Landscape, sheet: Sheet) -> Result<Self, Error> {
        let domain = &landscape.domain;
        let field = landscape.field(&picture.of.0)?;
        let (low, high) = field.range(domain.land.as_ref()).unwrap_or((0.0, 0.0));
        let relief = high - low;
        let mut height = drawable(field, domain.land.as_ref(), &sheet);
        height.values_mut().iter_mut().for_each(|height| *height -= low);
        let size = height.size();
        let spacing = [
            domain.cell * domain.size.columns as f64 / size.columns as f64,
            domain.cell * domain.size.rows as f64 / size.rows as f64,
        ];
        let exaggeration = picture.exaggeration.unwrap_or_else(|| automatic_exaggeration(&height, spacing));
        let interval =
            picture.contours.or_else(|| automatic_interval(f64::from(relief))).filter(|&i| i > 0.0);
        let layers = if picture.water { Water::of(landscape, &sheet) } else { Water::default() };
        Ok(Self {
            spline: Spline::new(&sheet, size.columns, size.rows),
            texture: normalised(texture(&height), FAINTEST_TEXTURE * relief),
            height,
            land: land_share(domain.land.as_ref(), &sheet),
            low,
            relief: relief.max(f32::MIN_POSITIVE),
            steepness: spacing.map(|spacing| (exaggeration / spacing) as f32),
            ramp: picture.ramp.ramp(),
            lights: Lights::new(picture.sun_azimuth_deg, picture.sun_altitude_deg),
            contours: interval.map(|i| Contours { interval: i as f32, line: 0.85 * sheet.line() }),
            contour_ink: linear_of_hex(0x6b_4a2f),
            lakes: layers.lakes,
            rivers: layers.rivers,
            river: linear_of_hex(0x2a_79b0),
            haze: linear_of_hex(0xd5_e2ea),
            sheet,
        })
    }

    fn evaluate(&self, y: usize, rows: &mut Rows) {
        self.spline.row(&self.height, y, &mut rows.height);
        self.spline.row(&self.texture, y, &mut rows.texture);
        if let Some(land) = &self.land {
            self.spline.row(land, y, &mut rows.land);
        }
        if let Some(lakes) = &self.lakes {
            self.spline.row(&lakes.level, y, &mut rows.level);
            self.spline.row(&lakes.depth, y, &mut rows.depth);
        }
    }

    fn pixel(&self, x: usize, y: usize, rows: &Rows) -> Linear {
        let land = match &self.land {
            Some(_) => land_cover(Rise::at(&rows.land, x, self.cells_a_pixel())),
            None => 1.0,
        };
        if land <= 0.0 {
            return PAPER;
        }
        let mut colour = self.ground(x, rows);
        if let Some(rivers) = &self.rivers {
            colour = mix(colour, self.river, rivers.row(y)[x]);
        }
        if let Some(lakes) = &self.lakes {
            let level = Rise::at(&rows.level, x, self.cells_a_pixel());
            let (lake, cover) = lakes.at(level, rows.depth.value[x], self.sheet.line());
            colour = mix(colour, lake, cover);
        }
        mix(PAPER, colour, land)
    }

    /// Lit and tinted ground with its contours.
    fn ground(&self, x: usize, rows: &Rows) -> Linear {
        let height = rows.height.value[x];
        let share = (height / self.relief).clamp(0.0, 1.0);
        let (east, south) = (rows.height.east[x], rows.height.south[x]);
        let light = self.lights.on(east * self.steepness[0], south * self.steepness[1]);
        let contrast = 0.84 + 0.28 * share;
        let texture = rows.texture.value[x];
        let bump = 1.0 + TEXTURE_STRENGTH * contrast * texture / (1.0 + texture * texture).sqrt();
        let tint = mix(self.ramp.at(share), self.haze, 0.14 * (1.0 - ramp(share, 0.0, 0.45)));
        let lit = |c: usize| {
            let room = (1.0 / tint[c] - 1.0).clamp(LEAST_ROOM, SUNLIT_ROOM);
            tint[c] * shoulder((1.0 + contrast * (light[c] - 1.0)).max(0.0) * bump, room)
        };
        let colour = std::array::from_fn(lit);
        let Some(contours) = &self.contours else { return colour };
        let rise = self.cells_a_pixel() * (east * east + south * south).sqrt();
        let ink = contours.ink(height + self.low, rise);
        mix(colour, std::array::from_fn(|c| colour[c] * self.contour_ink[c]), 0.62 * ink)
    }

    /// Cells of the drawn fields in one pixel.
    fn cells_a_pixel(&self) -> f32 {
        self.height.size().columns as f32 / self.sheet.width as f32
    }
}

/// Share of a pixel inside the half-land line.
fn land_cover(land: Rise) -> f32 {
    (0.5 + (land.value - 0.5) / land.by_pixel.max(1e-6)).clamp(0.0, 1.0)
}

/// What there is of water in a landscape.
#[derive(Default)]
struct Water {
    lakes: Option<Lakes>,
    rivers: Option<Strokes>,
}

impl Water {
    fn of(landscape: &Landscape, sheet: &Sheet) -> Self {
        let domain = &landscape.domain;
        let lakes = landscape.field("water").ok().and_then(|water| Lakes::of(water, domain, sheet));
        let flux = landscape.field("flux_x").ok().zip(landscape.field("flux_y").ok());
        let rivers = flux.and_then(|(x, y)| rivers::draw([x, y], domain, lakes.as_ref(), sheet));
        Self { lakes, rivers }
    }
}

/// The factor that draws the slope exceeded by one cell in ten as [`DRAWN_SLOPE`]; 1 on level ground.
fn automatic_exaggeration(height: &Field, spacing: [f64; 2]) -> f64 {
    let size = height.size();
    if size.columns < 2 || size.rows < 2 {
        return 1.0;
    }
    let rise = |x: usize, y: usize| {
        let east = f64::from(height.at(x + 1, y) - height.at(x, y)) / spacing[0];
        let south = f64::from(height.at(x, y + 1) - height.at(x, y)) / spacing[1];
        ((east * east + south * south).sqrt()) as f32
    };
    let rows = (0..size.rows - 1).into_par_iter();
    let mut slopes: Vec<f32> =
        rows.flat_map_iter(|y| (0..size.columns - 1).map(move |x| rise(x, y))).collect();
    let place = slopes.len() * 9 / 10;
    let steep = f64::from(*slopes.select_nth_unstable_by(place, f32::total_cmp).1);
    if steep > 0.0 { (DRAWN_SLOPE / steep).clamp(0.02, 50.0) } else { 1.0 }
}

/// The field over its root mean square, or over `least` where that is more.
fn normalised(mut field: Field, least: f32) -> Field {
    let squares: f64 = field.values().iter().map(|&value| f64::from(value) * f64::from(value)).sum();
    let usual = (squares / field.size().cells() as f64).sqrt() as f32;
    let scale = usual.max(least);
    if scale > 0.0 {
        field.values_mut().iter_mut().for_each(|value| *value /= scale);
    }
    field
}
