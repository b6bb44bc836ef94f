//! The `fluvial` step: floods carve ground over years, in metres and time.

use std::path::PathBuf;

use super::extent::empty_note;
use super::fluvial;
use super::fluvial_levels as levels;
use super::fluvial_materials::strata_of;
use super::hydraulic::Boundary;
use super::springs::{self, Source};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName, Nested, ScriptFile};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};

parameters! {
    /// Floods that carve ground over years: rivers, valleys, fans and lakes in metres and time. The grid only says how
    /// finely all this is computed: the length of a step follows from the cells, and their number with it.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::fluvial_step::Fluvial;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(32, 32)?, 40.0)); // columns, rows, metres
    /// let valley = |x, y| 6.0 * (x as f32 - 16.0).abs() + 4.0 * (32.0 - y as f32);
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// let outcome = Fluvial { flow_time: 0.5, ..Fluvial::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let deepest = landscape.field("erosion")?.range(None).expect("there are cells").1;
    /// assert!(deepest > 0.5, "the river has carved up to {deepest} m");
    /// assert!(outcome.budget.expect("is kept").solid.error().abs() < 1.0e-5, "nothing is lost");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Fluvial {
        /// Years that pass for the ground.
        duration: f64 = 10_000.0, range 0.0..=100_000_000.0, unit "a";
        /// Time of flow that stands for them: all of these years' floods as one. Water needs some hours to come down
        /// from a mountain range; the longer it flows, the less the ground changes under it at a time.
        flow_time: f64 = 3.0, range 0.001..=100_000.0, unit "h";
        /// Rain that runs off in a flood, over all of the ground.
        rain: f64 = 40.0, range 0.0..=10_000.0, unit "mm/h";
        /// Layer with the share of the rain that falls on each cell; 1 is `rain`. Default: 1 everywhere.
        rain_map: Option<LayerName> = None;
        /// Water that evaporates in a flood, from wherever it stands or runs, while there is any.
        evaporation: f64 = 0.0, range 0.0..=10_000.0, unit "mm/h";
        /// Rivers and springs that flow in: `{ x, y, radius, discharge }`.
        sources: Vec<Nested<Source>> = Vec::new();
        /// Ground that a unit of stream power takes up in a year (K). Hard rock has less than 1, loose soil 10 and more.
        erodibility: f64 = 3.0, range 0.0..=100_000.0, unit "m/a per m²/s";
        /// Layer that multiplies the erodibility: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        erodibility_map: Option<LayerName> = None;
        /// Whether each material wears and rests in its own way: `erodibility` is then that of the bedrock, those of
        /// the others stand to it as theirs do, and each has its own talus. What has settled or slid counts as the
        /// last material.
        materials: bool = false;
        /// Thickness of loose material that protects by half the rock it lies on, with `materials`.
        cover: f64 = 0.5, range 0.001..=1000.0, unit "m";
        /// Unit stream power below which nothing is taken up: discharge by width, times slope.
        threshold: f64 = 0.002, range 0.0..=1000.0, unit "m²/s";
        /// Speed at which sediment falls to the bed (v_s): the faster, the sooner it settles again. Fine sand and silt
        /// leave mountains with 0.0005; gravel, with 0.005, fills their valleys.
        settling: f64 = 0.0005, range 0.0..=10.0, unit "m/s";
        /// Width of a channel in which 1 m³/s flows; others are wider with the root of their discharge.
        channel_width: f64 = 4.0, range 0.01..=1000.0, unit "m";
        /// How fast a river that is wider than a cell wears its banks (β). By 0.05 it comes to be about as wide as `channel_width` says,
        /// whatever the cells; with 0 it only cuts down, and stays as narrow as a cell; more than 0.2 bends rivers back on fans.
        /// Banks wear as the bed beside them does, whatever they are of.
        lateral_wear: f64 = 0.05, range 0.0..=10.0;
        /// Distance of the channels in which water gathers that runs down a slope as a sheet. Where cells are longer than that, what
        /// has gathered in a cell wears more than it would on finer ones: `coarsest` should be no longer.
        gathering: f64 = 40.0, range 0.01..=10_000.0, unit "m";
        /// Friction of the bed (c_f, an eighth of the factor of Darcy and Weisbach): 0.003 for smooth, 0.1 for rough
        /// beds.
        friction: f64 = 0.01, range 0.0001..=10.0;
        /// Depth from which on water flows as if it were that deep. It bounds the speed of waves, and so the number of
        /// steps.
        deepest: f64 = 2.0, range 0.01..=1000.0, unit "m";
        /// Creep of the ground (D), which rounds what rivers do not reach.
        creep: f64 = 0.01, range 0.0..=1000.0, unit "m²/a";
        /// Steepest slope that rests, as a tangent.
        talus: f64 = 0.7, range 0.0..=10.0, unit "(a tangent: 35° is 0.7)";
        /// How fast steeper ground slides.
        slide: f64 = 1.0, range 0.0..=10_000.0, unit "m²/a";
        /// Grids that it runs on at most, each with cells twice as long as those of the next, up to `coarsest`: a tenth
        /// of the time passes on the finest, three hundredths on each between, and the rest on the coarsest. They hand ground,
        /// water and sediment down; three are some seven times as fast as one. The numbers of cells must divide, and none may be without data.
        levels: u32 = 1, range 1..=8;
        /// Longest cells of these grids. On the coarsest it is decided where valleys lie: a landscape of any size that
        /// begins on the same one has the same valleys.
        coarsest: f64 = 40.0, range 0.001..=100_000.0, unit "m";
        /// Number of steps, of the length that follows from the cells, in place of all that fill the time. Default: all.
        steps: Option<u32> = None, range 0..=100_000_000;
        /// Steps at the end over which `flux_x` and `flux_y` are averaged. Default: a tenth of all.
        mean_over: Option<u32> = None, range 1..=100_000_000, unit "steps";
        /// What happens at the edge and at no-data cells.
        boundary: Boundary = Boundary::Open;
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
        /// Layer with the depth of water that stands at the start. Default: none stands.
        initial_water: Option<LayerName> = None;
        /// Layer that says where to simulate: cells where it is below 0.5 stand still, and nothing passes
        /// their edge. Default: everywhere.
        region: Option<LayerName> = None;
        /// Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between the steps on
        /// the finest grid. Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Fluvial>(
    "fluvial",
    Stage::Erode,
    "carves ground by the floods of years, in metres and time",
    "Bates, Horritt, Fewtrell 2010, doi 10.1016/j.jhydrol.2010.03.027; Davy and Lague 2009, doi 10.1029/2008JF001146",
);

impl Fluvial {
    /// On how many grids it runs over cells of that many metres.
    pub(super) fn grids(&self, cell: f64) -> u32 {
        levels::grids(self.levels, self.coarsest, cell)
    }

    /// Layers with a number a cell.
    pub(super) fn maps(&self) -> [Option<&LayerName>; 2] {
        [self.rain_map.as_ref(), self.erodibility_map.as_ref()]
    }
}

impl Step for Fluvial {
    fn reads(&self) -> Vec<String> {
        let others =
            [self.initial_water.as_ref(), self.region.as_ref()].into_iter().chain(self.maps()).flatten();
        std::iter::once(&self.layer).chain(others).map(|name| name.0.clone()).collect()
    }

    fn layered(&self) -> Layered {
        if self.materials { Layered::Changes } else { Layered::Never }
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        let hard = materials.first().is_some_and(|bedrock| bedrock.erodibility > 0.0);
        let fault = || {
            let message =
                "`materials` is true, but the `erodibility` of the bedrock is 0: those of the others are \
                           measured by it"
                    .to_owned();
            Fault::of("materials", message)
        };
        (self.materials && !hard).then(fault).into_iter().collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = [
            ("water", "m"),
            ("sediment", "m"),
            ("flux_x", "m³/s"),
            ("flux_y", "m³/s"),
            ("erosion", "m"),
            ("deposition", "m"),
        ];
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    /// Years.
    fn watched(&self) -> u64 {
        self.duration as u64
    }

    fn watched_after(&self, _: u64) -> Option<u64> {
        None
    }

    fn faults(&self) -> Vec<Fault> {
        let fault = || {
            let message = format!("`levels` is {}, but must be 1 with a `region`", self.levels);
            Fault::of("levels", message)
        };
        (self.levels > 1 && self.region.is_some()).then(fault).into_iter().collect()
    }

    fn files(&self) -> Vec<PathBuf> {
        self.edits.as_ref().map(ScriptFile::path).into_iter().collect()
    }

    fn look_ahead(&self, materials: &[Material], _: &Domain) -> Result<(), Error> {
        self.script(materials).map(drop)
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        levels::check(domain, self.grids(domain.cell))
    }

    fn bytes_per_cell(&self) -> u64 {
        300
    }

    fn runs_over_ranks(&self) -> bool {
        true
    }

    /// The steps on each grid, as many cells as that has.
    fn work(&self, domain: &Domain) -> Work {
        let grids = self.grids(domain.cell);
        let on = |level: u32| {
            let there = self.for_level(level, grids);
            let all = there.steps(domain.cell * f64::from(1 << level)).count;
            let steps = there.steps.map_or(all, |steps| all.min(u64::from(steps)));
            steps as f64 / f64::from(1 << (2 * level))
        };
        Work::of((0..grids).map(on).sum::<f64>()).by(if self.materials { "materials" } else { "" })
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        levels::check(&landscape.domain, self.grids(landscape.domain.cell))?;
        let maps = self.maps().into_iter().flatten();
        let mut told: Vec<_> = maps.filter_map(|map| negative_note(landscape, map)).collect();
        told.extend(empty_note(landscape, self.region.as_ref()));
        let mut outcome = self.run_levels(landscape, job)?;
        outcome.notes.extend(told);
        let springs: Vec<_> =
            self.sources.iter().map(|Nested(source)| Nested(source.spring(&landscape.domain))).collect();
        outcome.notes.extend(springs::out_of_reach(&landscape.domain, "sources", &springs));
        Ok(outcome)
    }
}

/// Tells where what multiplies rain or erodibility is below 0, and counts as 0.
fn negative_note(landscape: &Landscape, LayerName(name): &LayerName) -> Option<String> {
    let map = landscape.field(name).ok()?;
    let (least, _) = map.range(landscape.domain.valid.as_ref())?;
    (least < 0.0).then(|| {
        format!("layer `{name}` goes down to {least}; what multiplies rain or erodibility counts as 0 where it is below")
    })
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    let flood = Fluvial {
        flow_time: 0.002,
        rain: 20_000.0,
        duration: 0.3,
        deepest: 0.5,
        gathering: 1.0,
        channel_width: 0.3,
        ..Fluvial::default()
    };
    let painted = || Some(LayerName::of("painted"));
    let source = Source { x: 20.0, y: 20.0, radius: 10.0, discharge: 100.0 };
    let mapped = Fluvial { rain_map: painted(), erodibility_map: painted(), ..flood.clone() };
    // Soil wears forty times as fast as rock: where the last digit of a thin cover decides, engines would differ by more.
    let several =
        |flood: &Fluvial| Fluvial { materials: true, erodibility: 0.1, cover: 5.0, ..flood.clone() };
    vec![
        Box::new(Fluvial { boundary: Boundary::Closed, evaporation: 5000.0, ..flood.clone() }),
        Box::new(Fluvial { region: painted(), sources: vec![Nested(source)], ..flood.clone() }),
        // Rivers many cells wide, which wear their banks.
        Box::new(Fluvial { channel_width: 30.0, lateral_wear: 0.5, ..flood.clone() }),
        Box::new(Fluvial { channel_width: 3.0, ..several(&mapped) }),
        Box::new(several(&flood)),
        Box::new(several(&mapped)),
        Box::new(mapped),
        Box::new(flood),
    ]
}

/// Its programs in every variant, for tests of the shaders.
pub(super) fn programs() -> impl Iterator<Item = weald_engine::program::Program> {
    let borders = [(Boundary::Closed, false), (Boundary::Closed, true), (Boundary::Open, true)];
    let variants = borders.into_iter().flat_map(|border| (0..=4).map(move |materials| (border, materials)));
    variants.map(|((boundary, masked), materials)| {
        let map = (materials % 2 == 1).then(|| LayerName::of("painted"));
        let rain_map = map.clone();
        let evaporation = f64::from(u8::from(masked));
        let step = Fluvial { boundary, rain_map, erodibility_map: map, evaporation, ..Fluvial::default() };
        let stack = vec![Material::built_in("rock").expect("built in"); materials];
        let numbers = step.numbers(10.0, strata_of(&stack, 0.1));
        fluvial::program(&numbers, masked, numbers.pipeline().reach())
    })
}
