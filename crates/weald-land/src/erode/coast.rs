//! The `coast` step: waves cut cliffs where a coast lies open, and lay beaches where it is sheltered.
//!
//! The coast retreats at `retreat · exposure · softness / (1 + height / high)`: exposure is the fetch by the winds and how
//! squarely their waves meet the coast (as in the models of Ashton and Murray 2006, doi 10.1029/2005JF000422), and a high
//! cliff must be carried off first (Sunamura 1992). A front that moves at that speed is followed for the duration. Behind it ground stands as a
//! cliff, before it lies a platform that falls gently under the sea (Trenhaile 2000, doi 10.1016/S0025-3227(00)00013-X).
//! A share of what was cut is sand, which lies along the sheltered coast as beaches of one slope: as wide as there is sand
//! for. The rest is carried out to sea. Waves are not simulated: no drift along the coast, no bars.

mod exposure;
mod march;
#[cfg(test)]
mod tests;

use exposure::Wind;
use march::{March, Reached};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::{parameters, sea};
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::{Budget, Job, SolidBudget};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Coast>(
    "coast",
    Stage::Erode,
    "lets waves cut cliffs where a coast lies open, and lay beaches where it is sheltered",
    "Sunamura 1992; Ashton and Murray 2006, doi 10.1029/2005JF000422; Trenhaile 2000, doi 10.1016/S0025-3227(00)00013-X",
);

parameters! {
    /// Waves at the coast of a landscape with a `sea_level`.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::coast::Coast;
    /// let domain = Domain { sea_level: Some(0.0), ..Domain::new(Size::new(64, 48)?, 20.0) }; // columns, rows, metres
    /// let mut landscape = Landscape::new(domain);
    /// let coast = |x, _| 4.0 * (x as f32 - 30.0); // the sea lies in the west
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, coast));
    /// Coast { duration: 2000.0, ..Coast::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert!(height.at(33, 24) < 0.0 && height.at(60, 24) == 120.0, "the coast has retreated, the land behind it stands");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Coast {
        /// Years for which waves work.
        duration: f64 = 3000.0, range 0.0..=10_000_000.0, unit "a";
        /// Direction from which wind and waves mostly come, clockwise from north; 270 is west.
        wind_from_deg: f64 = 270.0, range -360.0..=360.0, unit "deg";
        /// How far the direction varies (standard deviation); 180 and more is from everywhere alike.
        wind_spread_deg: f64 = 40.0, range 1.0..=10_000.0, unit "deg";
        /// Way over water after which waves grow no more. Beyond the border lies open sea.
        fetch: f64 = 20_000.0, range 1.0..=1.0e7, unit "m";
        /// How fast a low coast of bedrock retreats that lies wholly open.
        retreat: f64 = 0.1, range 0.0..=1000.0, unit "m/a";
        /// Height of a cliff that retreats half as fast.
        high: f64 = 50.0, range 0.01..=10_000.0, unit "m";
        /// Layer that multiplies the retreat: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        erodibility_map: Option<LayerName> = None;
        /// Steepest cliff that stands.
        cliff_deg: f64 = 55.0, range 5.0..=85.0, unit "deg";
        /// Fall of the platform that waves leave under the sea, rise over run.
        platform_slope: f64 = 0.02, range 0.0001..=1.0;
        /// Share of what waves cut that is sand and stays.
        sand: f64 = 0.3, range 0.0..=1.0;
        /// Exposure, from 0 to 1, below which sand stays.
        sheltered: f64 = 0.35, range 0.0..=1.0;
        /// Fall of beaches, rise over run.
        beach_slope: f64 = 0.03, range 0.001..=1.0;
        /// Height of the top of a beach above the sea.
        beach_top: f64 = 2.0, range 0.0..=100.0, unit "m";
        /// Widest beach, from the old coast out; sand beyond that is carried off.
        widest_beach: f64 = 300.0, range 0.0..=1.0e6, unit "m";
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
    }
}

impl Step for Coast {
    fn reads(&self) -> Vec<String> {
        std::iter::once(&self.layer).chain(&self.erodibility_map).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = [("exposure", "1"), ("erosion", "m"), ("deposition", "m")];
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        match layer {
            "exposure" => Some((0.0, 1.0)),
            "erosion" | "deposition" => Some((0.0, f64::INFINITY)),
            _ => None,
        }
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        let message = "`coast` needs a sea: give `sea_level` in [landscape], in metres";
        domain.sea_level.map(drop).ok_or_else(|| Error::Run(message.to_owned()))
    }

    fn bytes_per_cell(&self) -> u64 {
        120
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        self.check_on(&landscape.domain)?;
        let start = landscape.field(&self.layer.0)?.clone();
        let Some(shore) = Shore::of(self, landscape, &start)? else {
            let note = "there is no coast: the sea reaches no land, or there is none";
            self.store(landscape, (&start, &start), Field::filled(start.size(), 0.0));
            return Ok(Outcome { iterations: 1, notes: vec![note.to_owned()], ..Outcome::default() });
        };
        let mut after = shore.cut(&start);
        let taken = shore.difference(&start, &after);
        let laid = shore.lay_beaches(&mut after, self.sand * taken);
        let budget = shore.budget(&start, &after, taken - laid);
        let exposure = shore.exposure_of_land();
        self.store(landscape, (&start, &after), exposure);
        Ok(Outcome { iterations: 1, budget: Some(budget), ..Outcome::default() })
    }
}

impl Coast {
    fn store(&self, landscape: &mut Landscape, (start, after): (&Field, &Field), exposure: Field) {
        let change = |sign: f32| {
            let cells = start.values().iter().zip(after.values());
            let change = cells.map(|(start, after)| (sign * (after - start)).max(0.0)).collect();
            Field::from_values(start.size(), change)
        };
        landscape.insert("exposure", "1", exposure);
        landscape.insert("erosion", "m", change(-1.0));
        landscape.insert("deposition", "m", change(1.0));
        landscape.insert(&self.layer.0, "m", after.clone());
    }
}

/// A coast and the waves on it.
struct Shore<'a> {
    step: &'a Coast,
    domain: Domain,
    level: f64,
    sea: Vec<bool>,
    /// Cells of the sea beside land.
    coast: Vec<u32>,
    /// Of each cell of the coast.
    exposure: Vec<f64>,
    softness: Option<Field>,
    heights: Field,
}

/// How many times as steep as above the water sand lies under it, before it meets the floor.
const FRONT: f64 = 5.0;

/// Metres into the sea as far as which waves plane its floor off at most.
const PLANED: f64 = 500.0;

/// Widths of beaches that are tried, each half as far from the last as the one before.
const TRIALS: u32 = 40;

impl<'a> Shore<'a> {
    /// `None` where no land lies beside the sea.
    fn of(step: &'a Coast, landscape: &Landscape, start: &Field) -> Result<Option<Self>, Error> {
        let domain = landscape.domain.clone();
        let (Some(sea), Some(level)) = (sea::cells(landscape, start), domain.sea_level) else {
            return Ok(None);
        };
        let map = step.erodibility_map.as_ref();
        let softness = map.map(|LayerName(name)| landscape.field(name).cloned()).transpose()?;
        let is_ground =
            |cell: usize| !sea[cell] && domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let at_coast = |&cell: &usize| sea[cell] && domain.size.neighbours(cell).any(is_ground);
        let coast: Vec<u32> = (0..domain.size.cells()).filter(at_coast).map(|cell| cell as u32).collect();
        if coast.is_empty() {
            return Ok(None);
        }
        let wind = Wind {
            size: domain.size,
            cell: domain.cell,
            sea: &sea,
            from_deg: step.wind_from_deg,
            spread_deg: step.wind_spread_deg,
            fetch: step.fetch,
        };
        let exposure = wind.exposure(&coast);
        Ok(Some(Self { step, level, coast, exposure, softness, heights: start.clone(), sea, domain }))
    }

    fn is_ground(&self, cell: usize) -> bool {
        !self.sea[cell] && self.domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell))
    }

    /// Metres a year at which a coast that lies so open retreats into a cell.
    fn speed(&self, cell: usize, exposure: f64) -> f64 {
        let softness = self.softness.as_ref().map_or(1.0, |map| f64::from(map.values()[cell]).max(0.0));
        let cliff = (f64::from(self.heights.values()[cell]) - self.level).max(0.0);
        self.step.retreat * exposure * softness / (1.0 + cliff / self.step.high)
    }

    /// A front from the coast, which carries its exposure.
    fn march(&self, until: f64) -> March<'_> {
        let Domain { size, cell, .. } = self.domain;
        March { size, cell, starts: &self.coast, values: &self.exposure, until }
    }

    /// The ground with cliffs and platforms.
    fn cut(&self, start: &Field) -> Field {
        let steepness = libm::tan(self.step.cliff_deg.to_radians());
        let is_ground = |cell: usize| f64::from(u8::from(self.is_ground(cell)));
        // Ground lies as open as the coast that is nearest.
        let exposure = self.march(f64::INFINITY).follow(is_ground).value;
        let speed = |cell: usize| is_ground(cell) * self.speed(cell, exposure[cell]);
        // Some way on, for the cliffs behind the front.
        let Reached { time, .. } = self.march(3.0 * self.step.duration).follow(speed);
        let mut after = start.clone();
        for (cell, height) in after.values_mut().iter_mut().enumerate() {
            if time[cell].is_infinite() || !self.is_ground(cell) {
                continue;
            }
            // Metres that the front has gone beyond the cell, below 0 before it.
            let beyond = (self.step.duration - time[cell]) * speed(cell);
            let (platform, cliff) = (-self.step.platform_slope * beyond, -steepness * beyond);
            let cut = self.level + if beyond > 0.0 { platform } else { cliff };
            *height = height.min(cut as f32);
        }
        self.plane_off(&mut after, speed);
        after
    }

    /// Lets the platform go on into the sea, where the floor before the old coast stands higher.
    fn plane_off(&self, ground: &mut Field, speed: impl Fn(usize) -> f64) {
        let retreat = |&cell: &u32| {
            let beside = self.domain.size.neighbours(cell as usize);
            self.step.duration * beside.map(&speed).fold(0.0, f64::max)
        };
        let retreat: Vec<f64> = self.coast.iter().map(retreat).collect();
        let march = March { values: &retreat, ..self.march(PLANED) };
        let offshore = march.follow(|cell| f64::from(u8::from(self.sea[cell])));
        for (cell, height) in ground.values_mut().iter_mut().enumerate() {
            let (distance, retreat) = (offshore.time[cell], offshore.value[cell]);
            // No further out than the coast has gone back: the floor of a shallow sea is not all a platform.
            if self.sea[cell] && distance < retreat {
                *height = height.min((self.level - self.step.platform_slope * (retreat + distance)) as f32);
            }
        }
    }

    /// Volume in m³ by which the second ground is lower.
    fn difference(&self, start: &Field, after: &Field) -> f64 {
        let cells = start.values().iter().zip(after.values()).enumerate();
        let valid = self.domain.valid.as_ref();
        let cells = cells.filter(|(cell, _)| valid.is_none_or(|valid| valid.is_valid_at(*cell)));
        cells.map(|(_, (&start, &after))| f64::from(start) - f64::from(after)).sum::<f64>()
            * self.domain.cell_area()
    }

    /// Lays so many m³ of sand along the sheltered coast, as far as there is room; gives what lies there.
    fn lay_beaches(&self, ground: &mut Field, sand: f64) -> f64 {
        let widest = self.step.widest_beach + self.step.beach_top / self.step.beach_slope;
        let offshore = self.march(widest).follow(|cell| f64::from(u8::from(self.sea[cell])));
        let (mut narrow, mut wide) = (0.0, self.step.widest_beach);
        let volume = |width: f64| -self.difference(ground, &self.with_beaches(ground, &offshore, width));
        if volume(wide) > sand {
            for _ in 0..TRIALS {
                let width = 0.5 * (narrow + wide);
                *(if volume(width) > sand { &mut wide } else { &mut narrow }) = width;
            }
            wide = narrow;
        }
        let after = self.with_beaches(ground, &offshore, wide);
        let laid = -self.difference(ground, &after);
        *ground = after;
        laid
    }

    /// The ground with beaches, as wide as that where no waves come.
    fn with_beaches(&self, ground: &Field, offshore: &Reached, widest: f64) -> Field {
        let mut after = ground.clone();
        for (cell, height) in after.values_mut().iter_mut().enumerate() {
            if !self.sea[cell] || offshore.time[cell].is_infinite() {
                continue;
            }
            let shelter = 1.0 - offshore.value[cell] / self.step.sheltered.max(1e-9);
            if shelter > 0.0 {
                let shelter = shelter.min(1.0);
                let inside = widest * shelter - offshore.time[cell];
                // The steeper the less sheltered, so that a beach has no end that stands like a step.
                let steeper = if inside > 0.0 { 1.0 } else { FRONT / shelter };
                let above = (self.step.beach_slope * steeper * inside).min(self.step.beach_top);
                *height = height.max((self.level + above) as f32);
            }
        }
        after
    }

    /// Exposure of the coast itself, 0 elsewhere.
    fn exposure_of_land(&self) -> Field {
        let mut field = Field::filled(self.domain.size, 0.0);
        for (&cell, &exposure) in self.coast.iter().zip(&self.exposure) {
            field.values_mut()[cell as usize] = exposure.clamp(0.0, 1.0) as f32;
        }
        field
    }

    fn budget(&self, start: &Field, after: &Field, outgoing: f64) -> Budget {
        let valid = self.domain.valid.as_ref();
        let (lowest, _) = start.range(valid).unwrap_or_default();
        let above = |field: &Field| self.difference(field, &Field::filled(field.size(), lowest));
        let solid = SolidBudget {
            start: above(start),
            ground: above(after),
            outgoing,
            moved: outgoing.abs(),
            ..SolidBudget::default()
        };
        Budget { solid, ..Budget::default() }
    }
}
