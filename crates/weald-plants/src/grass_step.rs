//! The step `grass`: sets of blades by the soil, the light and the density that the ground has.

use crate::grass::curves::{LightCurve, SoilCurve};
use crate::grass::growth::{Bend, LEVELS};
use crate::grass::meadow::{Maps, Meadow};
use crate::grass::species::{MAX_SPECIES, SPECIES, Species};
use crate::vegetation::Vegetation;
use weald_core::condition::{self, Condition};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName, Nested, nearest};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Grass>(
    "grass",
    Stage::Grow,
    "grows grass by the soil and the light of the ground, in tufts of six blades",
    "Kim and Cho 2009, Modeling and rendering of growing grass",
);

parameters! {
    /// Grass, in sets: tufts of six blades. Sets are not kept but follow from these maps wherever they are wanted. Writes
    /// how many of them stand on a square metre, and how many of each species: the layer `grass`, and `grass_reed` for
    /// reeds.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_plants::grass_step::Grass;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// for (layer, value) in [("fertility", 0.8), ("light", 1.0), ("moisture", 0.5)] {
    ///     landscape.insert(layer, "1", Field::filled(landscape.domain.size, value));
    /// }
    /// let outcome = Grass { sets: 30.0, ..Grass::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("grass")?.at(4, 3), 15.0, "half of 30 sets on a square metre, as the moisture says");
    /// assert_eq!(outcome.measures["blades"], 6.0 * 15.0 * 4800.0, "six blades a set, on 80 m by 60 m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Grass {
        /// Name of the grass, and of the layer that counts its sets; those of the species begin with it.
        into: LayerName = LayerName::of("grass");
        /// Layer of how good the soil is, 0 to 1: of `soil`, or of an image by `load`.
        soil: LayerName = LayerName::of("fertility");
        /// Layer of how much light there is, 0 to 1: of `sunlight`, or of an image.
        light: LayerName = LayerName::of("light");
        /// Layer of how densely grass stands, 0 to 1: the wetness of `moisture`, or an image.
        density: LayerName = LayerName::of("moisture");
        /// Sets (tufts of six blades) per square metre where the density is 1: 40 are 240 blades.
        sets: f64 = 40.0, range 1.0e-6..=10_000.0, unit "1/m²";
        /// What grows: `[{ name = "reed", share = 2, where = [{ layer = "moisture", above = 0.9 }] }, …]`. Without any,
        /// ryegrass.
        species: Vec<Nested<Kind>> = Vec::new();
        /// How alike the sets of a tussock, 0.7 m wide, are: this share of them is of one species, and the soil of tussocks is up to half
        /// of it better or worse than the layer's. 0, as in the publication: each set stands alone.
        tussocks: f64 = 0.6, range 0.0..=1.0;
        /// Depth of the layer `water`, where there is one, up to which grass stands in it.
        water: f64 = 0.05, range 0.0..=1.0e4, unit "m";
        /// How far it has grown: 0 is bare ground, 1 full-grown; a blade has four segments, one for each quarter.
        age: f64 = 1.0, range 0.0..=1.0;
        /// Layer of where it is mown, 0 to 1.
        mown: Option<LayerName> = None;
        /// Height of what is mown.
        mown_height: f64 = 0.05, range 0.001..=10.0, unit "m", with mown;
        /// Layer of where it is trodden down, 0 to 1.
        trodden: Option<LayerName> = None;
        /// How far a blade bends. `total`: the bend is that of the whole blade. `printed`: it is that of each of its
        /// segments, as in the publication, so that tall blades dip into the ground.
        bend: Bend = Bend::Total;
    }
}

parameters! {
    /// A species, and where it grows.
    pub struct Kind {
        /// One of the built-in species: ryegrass, fescue, reed, feather-grass, oat-grass.
        name: String = "ryegrass".to_owned();
        /// Weight relative to the other species.
        share: f64 = 1.0, range 0.0..=1000.0;
        /// Conditions of the ground, as those of `select`. Their product multiplies the weight.
        r#where: Vec<Nested<Condition>> = Vec::new();
        /// Height of a straight blade at its best. Without it, that of the species.
        height: Option<f64> = None, range 0.001..=100.0, unit "m";
        /// Angle from upright at which blades leave the ground at most, each by chance. Without it, that of the species; 0, as in the
        /// publication: all stand upright there.
        splay_deg: Option<f64> = None, range 0.0..=45.0, unit "deg";
        /// Three control values of the response to soil: the curve passes through the first at soil 0 and the last at 1,
        /// and is pulled towards the second between. Without them, those of the species.
        soil_curve: Vec<f64> = Vec::new(), range 0.0..=1.0;
        /// Five control values of the response of width to light: the curve passes through the first at light 0, the third
        /// at 0.3 and the last at 1, and is pulled towards the others between.
        width_curve: Vec<f64> = Vec::new(), range 0.0..=1.0;
        /// Five control values of the response of height to light.
        height_curve: Vec<f64> = Vec::new(), range 0.0..=1.0;
    }
}

impl Step for Grass {
    fn reads(&self) -> Vec<String> {
        let maps = [&self.soil, &self.light, &self.density];
        let masks = [&self.mown, &self.trodden].into_iter().flatten();
        let conditions = self.kinds().into_iter().flat_map(|kind| kind.r#where);
        let conditions = conditions.map(|Nested(condition)| condition.layer.0);
        maps.into_iter().chain(masks).map(|name| name.0.clone()).chain(conditions).collect()
    }

    fn reads_where_there(&self) -> Vec<String> {
        vec!["water".to_owned()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let species = self.kinds().into_iter().map(|kind| self.layer_of(&kind.name));
        std::iter::once(self.into.0.clone()).chain(species).map(|name| (name, "1/m²")).collect()
    }

    fn meadows(&self) -> Vec<String> {
        vec![self.into.0.clone()]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, self.sets))
    }

    fn faults(&self) -> Vec<Fault> {
        let kinds = self.kinds();
        let many = (kinds.len() > MAX_SPECIES)
            .then(|| format!("there are {} species; grass has at most {MAX_SPECIES}", kinds.len()));
        let many = many.map(|message| Fault::of("species", message));
        let twice = (1..kinds.len()).filter(|&i| kinds[..i].iter().any(|kind| kind.name == kinds[i].name));
        let twice = twice.map(|i| {
            let message = format!("{:?} is there twice; give it one share", kinds[i].name);
            Fault::of("name", message).within(&format!("species.{}", i + 1))
        });
        let own = kinds.iter().zip(1..).flat_map(|(kind, number)| kind.faults(number));
        many.into_iter().chain(twice).chain(own).collect()
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let kinds = self.kinds();
        let weights: Vec<_> = kinds.iter().map(|kind| kind.weight(landscape)).collect::<Result<_, _>>()?;
        let maps = self.maps(landscape, &weights)?;
        let meadow = Meadow {
            species: kinds
                .iter()
                .map(Kind::species)
                .collect::<Result<_, _>>()
                .map_err(|fault: Fault| Error::Run(fault.message))?,
            bend: self.bend,
            seed: job.seed,
            densest: self.sets,
            level: (self.age * LEVELS as f64) as f32,
            mown_height: self.mown_height as f32,
            deepest: self.water as f32,
            tussocks: self.tussocks as f32,
            maps,
        };
        let notes = [&self.soil, &self.light, &self.density]
            .into_iter()
            .filter_map(|name| beyond(landscape, &name.0));
        let notes = notes.collect();
        self.count(landscape, &meadow, &kinds);
        let sets = meadow.expected(&meadow.area());
        let measures = [("sets", sets), ("blades", f64::from(crate::grass::BLADES) * sets)].into();
        landscape.sow(&self.into.0, meadow);
        Ok(Outcome { iterations: 1, measures, notes, ..Outcome::default() })
    }
}

impl Grass {
    fn kinds(&self) -> Vec<Kind> {
        let kinds: Vec<_> = self.species.iter().map(|Nested(kind)| kind.clone()).collect();
        if kinds.is_empty() { vec![Kind::default()] } else { kinds }
    }

    fn layer_of(&self, species: &str) -> String {
        format!("{}_{}", self.into.0, species.replace('-', "_"))
    }

    fn maps(&self, landscape: &Landscape, weights: &[Field]) -> Result<Maps, Error> {
        let domain = &landscape.domain;
        let layer = |name: &LayerName| Ok::<_, Error>(landscape.field(&name.0)?.clone());
        let masked = |name: &Option<LayerName>| name.as_ref().map(layer).transpose();
        let wanted = landscape.field(&self.density.0)?;
        let sum = |x, y| weights.iter().map(|weight| weight.at(x, y)).sum::<f32>();
        let is_valid = |x, y| domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y));
        let density = Field::from_function(domain.size, |x, y| {
            if is_valid(x, y) { wanted.at(x, y).clamp(0.0, 1.0) * sum(x, y).min(1.0) } else { 0.0 }
        });
        let shares = (1..=weights.len()).map(|count| {
            Field::from_function(domain.size, |x, y| match sum(x, y) {
                whole if whole > 0.0 && is_valid(x, y) => {
                    weights[..count].iter().map(|weight| weight.at(x, y)).sum::<f32>() / whole
                }
                _ => 0.0,
            })
        });
        Ok(Maps {
            cell: domain.cell,
            valid: domain.valid.clone(),
            shares: shares.collect(),
            density,
            soil: layer(&self.soil)?,
            light: layer(&self.light)?,
            water: landscape.field("water").ok().cloned(),
            mown: masked(&self.mown)?,
            trodden: masked(&self.trodden)?,
        })
    }

    /// Writes the layers of sets on a square metre.
    fn count(&self, landscape: &mut Landscape, meadow: &Meadow, kinds: &[Kind]) {
        let Maps { density, shares, .. } = &meadow.maps;
        let size = density.size();
        let all = Field::from_function(size, |x, y| (f64::from(density.at(x, y)) * self.sets) as f32);
        for (number, kind) in kinds.iter().enumerate() {
            let before = |x, y| if number == 0 { 0.0 } else { shares[number - 1].at(x, y) };
            let of =
                Field::from_function(size, |x, y| all.at(x, y) * (shares[number].at(x, y) - before(x, y)));
            landscape.insert(&self.layer_of(&kind.name), "1/m²", of);
        }
        landscape.insert(&self.into.0, "1/m²", all);
    }
}

impl Kind {
    /// What is wrong with the species of this number, counted from 1.
    fn faults(&self, number: usize) -> Vec<Fault> {
        let all = self.species().err().into_iter().chain(condition::faults(&self.r#where));
        all.map(|fault| fault.within(&format!("species.{number}"))).collect()
    }

    /// The species with what is changed of it.
    fn species(&self) -> Result<Species, Fault> {
        let mut species =
            Species::named(&self.name).ok_or_else(|| Fault::of("name", unknown(&self.name)))?.clone();
        species.height = self.height.map_or(species.height, |height| height as f32);
        species.splay = self.splay_deg.map_or(species.splay, |splay| splay.to_radians() as f32);
        let at = |key| move |message: String| Fault::of(key, message);
        if let Some(values) = values("soil_curve", &self.soil_curve).map_err(at("soil_curve"))? {
            species.curves.soil = SoilCurve::new(values).map_err(at("soil_curve"))?;
        }
        if let Some(values) = values("width_curve", &self.width_curve).map_err(at("width_curve"))? {
            species.curves.width = LightCurve::new(values).map_err(at("width_curve"))?;
        }
        if let Some(values) = values("height_curve", &self.height_curve).map_err(at("height_curve"))? {
            species.curves.height = LightCurve::new(values).map_err(at("height_curve"))?;
        }
        Ok(species)
    }

    /// How much of the grass it would be, in each cell.
    fn weight(&self, landscape: &Landscape) -> Result<Field, Error> {
        let conditions: Vec<(&Condition, &Field)> = self
            .r#where
            .iter()
            .map(|Nested(condition)| Ok((condition, landscape.field(&condition.layer.0)?)))
            .collect::<Result<_, Error>>()?;
        Ok(Field::from_function(landscape.domain.size, |x, y| {
            let masks = conditions.iter().map(|(condition, field)| condition.mask(f64::from(field.at(x, y))));
            (self.share * masks.product::<f64>()) as f32
        }))
    }
}

fn unknown(name: &str) -> String {
    let known: Vec<_> = SPECIES.iter().map(|species| species.name).collect();
    let hint = match nearest(name, &known) {
        Some(near) => format!("did you mean {near:?}?"),
        None => format!("there are: {}", known.join(", ")),
    };
    format!("there is no grass {name:?}; {hint}")
}

/// As many control values as a curve has, where there are any.
fn values<const N: usize>(name: &str, given: &[f64]) -> Result<Option<[f32; N]>, String> {
    if given.is_empty() {
        return Ok(None);
    }
    let values: Vec<_> = given.iter().map(|&value| value as f32).collect();
    match values.try_into() {
        Ok(values) => Ok(Some(values)),
        Err(_) => Err(format!("`{name}` has {} numbers; it needs {N}", given.len())),
    }
}

/// What to say of a map that goes beyond 0 and 1.
fn beyond(landscape: &Landscape, name: &str) -> Option<String> {
    let (low, high) = landscape.field(name).ok()?.range(landscape.domain.valid.as_ref())?;
    (low < 0.0 || high > 1.0).then(|| {
        format!("layer `{name}` goes from {low} to {high}; below 0 and above 1 makes no difference here: see `remap`")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grass::Instance;
    use weald_core::domain::Domain;
    use weald_core::grid::Size;

    /// Ground that is richer to the east, and wetter to the south.
    fn valid() -> Landscape {
        let size = Size::square(32).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.insert("fertility", "1", Field::from_function(size, |x, _| x as f32 / 31.0));
        landscape.insert("light", "1", Field::filled(size, 0.8));
        landscape.insert("moisture", "1", Field::from_function(size, |_, y| y as f32 / 31.0));
        landscape
    }

    fn kind(name: &str, above: f64) -> Nested<Kind> {
        let layer = LayerName::of("moisture");
        let condition = Condition { layer, above: Some(above), ..Condition::default() };
        Nested(Kind { name: name.to_owned(), r#where: vec![Nested(condition)], ..Kind::default() })
    }

    #[test]
    fn species_stand_where_their_conditions_hold_and_their_layers_add_up() {
        let mut landscape = valid();
        let grass = Grass { species: vec![kind("fescue", 0.25), kind("reed", 0.75)], ..Grass::default() };
        let outcome = grass.run(&mut landscape, &Job::unwatched(4)).expect("grows");
        let meadow = landscape.meadow("grass").expect("grown").clone();
        let sets = meadow.sets(&meadow.area());
        assert!((sets.len() as f64 / outcome.measures["sets"] - 1.0).abs() < 0.1, "{}", sets.len());
        let mut reeds = 0;
        for packed in sets {
            let Instance { place: [_, y], species, .. } = Instance::unpack(packed);
            assert!(y > 7.0 && (species == 0 || y > 23.0), "species {species} at {y}");
            reeds += species;
        }
        assert!(reeds > 1000, "{reeds}");
        let of = |name: &str| landscape.field(name).expect("written").sum();
        assert!((of("grass") - of("grass_fescue") - of("grass_reed")).abs() < 1e-3 * of("grass"));
        assert!(of("grass_reed") > 0.2 * of("grass"));
    }

    #[test]
    fn what_a_recipe_changes_of_a_species_is_told_by_its_meadow() {
        let mut landscape = valid();
        let changed = Kind {
            height: Some(2.0),
            soil_curve: vec![0.0, 0.5, 1.0],
            width_curve: vec![0.5; 5],
            ..Kind::default()
        };
        let grass = Grass { species: vec![Nested(changed)], age: 0.25, ..Grass::default() };
        assert_eq!(grass.faults(), []);
        grass.run(&mut landscape, &Job::unwatched(4)).expect("grows");
        let meadow = landscape.meadow("grass").expect("grown");
        assert_eq!((meadow.species[0].height, meadow.level), (2.0, 1.0));
        assert_eq!(meadow.species[0].curves.soil.values(), [0.0, 0.5, 1.0]);
        assert_eq!(meadow.species[0].curves.height, SPECIES[0].curves.height);
    }

    #[test]
    fn what_is_wrong_with_species_is_told_with_a_remedy() {
        let of = |kinds: Vec<Kind>| {
            let grass = Grass { species: kinds.into_iter().map(Nested).collect(), ..Grass::default() };
            let told: Vec<_> = grass.faults().iter().map(|one| format!("{}: {one}", one.key)).collect();
            told.join("; ")
        };
        let named = |name: &str| Kind { name: name.to_owned(), ..Kind::default() };
        assert!(of(vec![named("read")]).contains("did you mean \"reed\"?"));
        let twice = of(vec![named("reed"), named("fescue"), named("reed")]);
        assert!(twice.starts_with("species.3.name: ") && twice.contains("is there twice"), "{twice}");
        let short = Kind { soil_curve: vec![0.1, 0.2], ..Kind::default() };
        assert!(of(vec![short]).contains("`soil_curve` has 2 numbers; it needs 3"));
        let none = Kind { r#where: vec![Nested(Condition::default())], ..Kind::default() };
        let none = of(vec![none]);
        assert!(none.starts_with("species.1.where.1.layer: "), "{none}");
        assert!(none.contains("neither `above` nor `below`"), "{none}");
    }

    #[test]
    fn a_map_beyond_0_and_1_is_told() {
        let mut landscape = valid();
        let size = landscape.domain.size;
        landscape.insert("soil_depth", "m", Field::filled(size, 3.0));
        let grass = Grass { soil: LayerName::of("soil_depth"), ..Grass::default() };
        let outcome = grass.run(&mut landscape, &Job::unwatched(4)).expect("grows");
        assert!(
            outcome.notes.iter().any(|note| note.contains("`soil_depth` goes from 3 to 3")),
            "{:?}",
            outcome.notes
        );
    }
}
