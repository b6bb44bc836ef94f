//! The picture of a fractal in a recipe: a look, deformations, wind.

use std::sync::{Arc, Mutex, PoisonError};

use super::fractal::{Extent, Look, Motion, Setting, Subject};
use super::{Cutout, Image, Picture, Watch};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Diagnostics, LayerName, Nested, Parameter, Parameters};
use weald_core::source::Table;
use weald_plants::Fractal;
use weald_plants::Vegetation;
use weald_plants::ifs::lanes::LANES;
use weald_plants::ifs::wind::Posed;
use weald_plants::ifs::{Block, Code, Deformation, Packer, Point, Pose, Sway, Wind};

weald_core::parameters! {
    /// Which fractal is drawn, and what moves it.
    pub struct GrowthKeys {
        /// Name of a `[[fractal]]` or of a built-in one.
        fractal: LayerName = LayerName::needed();
        /// The wind it stands in; without, the frames of a film go around it.
        wind: Option<Nested<Wind>> = None;
        /// Seed of its points.
        seed: u64 = 1, range 0..=9_007_199_254_740_991_u64;
    }
}

/// The picture of a fractal.
#[derive(Clone, Debug, Default)]
pub struct Growth {
    /// What is drawn.
    pub keys: GrowthKeys,
    /// How.
    pub look: Look,
    moment: Option<Moment>,
    /// What the frames of a film share, found by the first of them.
    setting: Arc<Mutex<Option<Setting>>>,
}

/// A moment of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment {
    share: f64,
    seconds: f64,
}

/// Moments of a film whose extents make up what its frames show.
const SAMPLES: u32 = 12;

impl Parameters for Growth {
    fn parameters() -> Vec<Parameter> {
        GrowthKeys::parameters().into_iter().chain(Look::parameters()).collect()
    }

    fn read_values(table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let keys = GrowthKeys::read_values(table, diagnostics);
        let look = Look::read_values(table, diagnostics);
        Self { keys, look, ..Self::default() }
    }

    fn changed(&self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let keys = self.keys.changed(table, diagnostics);
        Self { keys, look: self.look.changed(table, diagnostics), ..self.clone() }
    }
}

impl Picture for Growth {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn fractals(&self) -> Vec<String> {
        vec![self.keys.fractal.0.clone()]
    }

    fn turned(&self, share: f64, seconds: f64) -> Option<Box<dyn Picture>> {
        Some(Box::new(Self { moment: Some(Moment { share, seconds }), ..self.clone() }))
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        self.cutout(landscape, &mut |_, _| Ok(())).map(|cutout| cutout.image)
    }

    fn cutout(&self, landscape: &Landscape, watch: &mut Watch<'_>) -> Result<Cutout, Error> {
        self.shown(landscape, |subject, setting| self.look.draw(subject, setting, watch))
    }

    fn svg(&self, landscape: &Landscape) -> Result<String, Error> {
        self.shown(landscape, |subject, setting| self.look.svg(subject, setting))
    }
}

impl Growth {
    /// Hands over what is drawn at this moment.
    fn shown<T>(
        &self,
        landscape: &Landscape,
        draw: impl FnOnce(&Subject<'_>, &Setting) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let fractal = landscape.fractal(&self.keys.fractal.0)?;
        let deformation = fractal.deformation().map_err(|faults| Error::Run(faults.join("; ")))?;
        let plant = Plant { deformation: &deformation, sway: Sway::of(&fractal.ifs), growth: self };
        let setting = self.setting(&fractal, &plant)?;
        let share = self.moment.map_or(0.0, |moment| moment.share);
        plant.at(&fractal, share, |subject| draw(subject, &setting))
    }

    /// What is shown: of a still what it is, of a film what all its frames are in.
    fn setting(&self, fractal: &Fractal, plant: &Plant<'_>) -> Result<Setting, Error> {
        let extent = |share| plant.at(fractal, share, |subject| Ok(Extent::of(subject)));
        if self.moment.is_none() {
            return Setting::of_still(&self.look, &extent(0.0)?);
        }
        // A panic elsewhere leaves what is locked whole, since it is only ever replaced.
        let mut kept = self.setting.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(setting) = *kept {
            return Ok(setting);
        }
        let shares = (0..SAMPLES).map(|look| f64::from(look) / f64::from(SAMPLES));
        let whole = shares.map(extent).try_fold(Extent::NONE, |whole, one| one.map(|one| whole.with(one)))?;
        let setting = plant.at(fractal, 0.0, |subject| Setting::of_film(&self.look, subject, &whole))?;
        *kept = Some(setting);
        Ok(setting)
    }

    /// The wind of a share of the film; a still is its first moment.
    fn pose(&self, share: f64) -> Option<Pose> {
        let Nested(wind) = self.keys.wind.as_ref()?;
        let Some(moment) = self.moment else { return Some(wind.pose(0.0)) };
        // The film begins again after its last frame, and so must the wind.
        let seconds = Some(wind.seconds.unwrap_or(moment.seconds).clamp(0.1, 3600.0));
        let looped = Wind { seconds, ..wind.clone() };
        Some(looped.pose(share * moment.seconds))
    }
}

/// A fractal with what moves it.
struct Plant<'a> {
    deformation: &'a Deformation<'a>,
    sway: Sway,
    growth: &'a Growth,
}

impl Plant<'_> {
    /// Hands over the plant at a share of the film.
    fn at<T>(
        &self,
        fractal: &Fractal,
        share: f64,
        draw: impl FnOnce(&Subject<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let pose = self.growth.pose(share);
        let turn = if pose.is_some() { 0.0 } else { share };
        let moved = Moved { deformation: self.deformation, sway: &self.sway, pose: pose.as_ref() };
        let wind = pose.as_ref().map(|pose| Posed::new(&self.sway, pose));
        let swaying = wind.map(|wind| Swaying { moved, wind });
        let motion: Option<&dyn Motion> = match &swaying {
            Some(swaying) => Some(swaying),
            None if self.deformation.is_nothing() => None,
            None => Some(&moved),
        };
        draw(&self.growth.look.subject(&fractal.ifs, motion, self.growth.keys.seed, turn))
    }
}

/// What moves one point after the other.
#[derive(Clone, Copy)]
struct Moved<'a> {
    deformation: &'a Deformation<'a>,
    sway: &'a Sway,
    pose: Option<&'a Pose>,
}

impl Moved<'_> {
    fn bent(&self, point: Point, code: &Code) -> Point {
        if self.deformation.is_nothing() { point } else { self.deformation.apply(point, code) }
    }
}

impl Motion for Moved<'_> {
    fn moved(&self, point: Point, code: &Code) -> Point {
        let bent = self.bent(point, code);
        let Some(pose) = self.pose else { return bent };
        self.sway.at(pose, bent.map(|x| x as f32), |place| code.digit(place)).map(f64::from)
    }
}

/// What moves rows of points where there is wind.
struct Swaying<'a> {
    moved: Moved<'a>,
    wind: Posed<'a>,
}

impl Motion for Swaying<'_> {
    fn moved(&self, point: Point, code: &Code) -> Point {
        self.moved.moved(point, code)
    }

    fn row(&self, block: &Block, row: usize, packer: &Packer) -> [[f64; LANES]; 3] {
        let mut rests = block.rows()[row];
        if !self.moved.deformation.is_nothing() {
            for lane in 0..LANES.min(block.len() - row * LANES) {
                let number = row * LANES + lane;
                let bent = self.moved.bent(block.point(number).map(f64::from), &packer.code(number));
                for (axis, x) in rests.iter_mut().zip(bent) {
                    axis[lane] = x as f32;
                }
            }
        }
        self.wind.row(|place| block.digits(row, place), &rests).map(|axis| axis.map(f64::from))
    }
}
