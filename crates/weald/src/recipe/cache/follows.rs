//! What each part of a landscape follows from, as a hash.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use crate::recipe::canonical;
use crate::recipe::plan::{FractalSource, Ground, Planned, Recipe};
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::landscape::Landscape;
use weald_core::material::{BEDROCK, layer_names};
use weald_engine::Engine;
use weald_engine::step::{Layered, Stage};
use weald_plants::Vegetation;

/// Layer that layered simulations read wherever it is.
const REGOLITH: &str = "regolith";

/// What the parts of a landscape follow from.
#[derive(Clone, Debug)]
pub(super) struct Follows {
    /// The program and the engine.
    program: String,
    /// The grid, with its place, its cells without data and its sea.
    grid: String,
    /// Materials and fractals.
    declared: String,
    layers: BTreeMap<String, String>,
    /// Plants and grass, all together.
    grown: String,
}

fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// The contents of a file.
fn contents(path: &Path) -> Result<String, Error> {
    let wrong = |cause: std::io::Error| Error::input(path, format!("cannot be read: {cause}"));
    let (mut file, mut hasher) = (File::open(path).map_err(wrong)?, blake3::Hasher::new());
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece).map_err(wrong)? {
            0 => return Ok(hasher.finalize().to_hex().to_string()),
            length => hasher.update(&piece[..length]),
        };
    }
}

/// This build of the program: bits may differ from one to the next.
fn build() -> String {
    let version = env!("CARGO_PKG_VERSION");
    let about = std::env::current_exe().and_then(std::fs::metadata);
    let Ok(about) = about else { return version.to_owned() };
    let changed = about.modified().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    format!("{version} {} {}", about.len(), changed.map_or(0, |time| time.as_nanos()))
}

/// The engine, where bits depend on it.
fn machine(engine: &Engine) -> String {
    match engine {
        Engine::Cpu | Engine::Bands(_) | Engine::Tiles(_) | Engine::Ranks(_) => "cpu".to_owned(),
        Engine::Device(_) | Engine::DeviceElseCpu(_) => engine.adapter().unwrap_or_default(),
    }
}

impl Follows {
    /// What a landscape before the first step follows from.
    pub(super) fn start(recipe: &Recipe, landscape: &Landscape, engine: &Engine) -> Result<Self, Error> {
        let said = format!("{:?}\n{:?}", recipe.ground, recipe.sea_level);
        let ground = match &recipe.ground {
            Ground::Empty { .. } => hash(&said),
            Ground::File { path, .. } => hash(&format!("{said}\n{}", contents(path)?)),
        };
        let mut layers = BTreeMap::new();
        for (name, _) in landscape.layers() {
            let material = recipe.materials.iter().find(|planned| planned.material.name == name);
            let file = material.and_then(|planned| planned.file.as_ref());
            let from =
                file.map(|file| contents(&file.0).map(|read| format!("{file:?}\n{read}"))).transpose()?;
            layers.insert(name.to_owned(), hash(&format!("{name}\n{ground}\n{}", from.unwrap_or_default())));
        }
        let mut declared = vec![format!("{:?}", landscape.materials)];
        for fractal in &recipe.fractals {
            let maps = match &fractal.fractal_source {
                FractalSource::Known(ifs) => format!("{ifs:?}"),
                FractalSource::Flame { path, number } => format!("{} {number}", contents(path)?),
            };
            declared.push(format!("{} {:?} {maps}", fractal.name, fractal.deform));
        }
        let declared = declared.join("\n");
        let program = format!("{}\n{}", build(), machine(engine));
        Ok(Self { program, grid: hash(&ground), declared: hash(&declared), layers, grown: String::new() })
    }

    /// All that the result of a step depends on, as a text.
    pub(super) fn text(
        &self,
        recipe: &Recipe,
        planned: &Planned,
        landscape: &Landscape,
    ) -> Result<String, Error> {
        let Self { program, grid, declared, grown, .. } = self;
        let (name, seed) = (planned.entry.name, planned.seed(recipe.seed));
        let mut lines = vec![
            program.clone(),
            format!("step = {name}\nseed = {seed}\n{}", canonical::keys(&planned.keys)),
            format!("grid = {grid}\ndeclared = {declared}"),
            // The same keys leave another grid where the step is the last on the finest.
            format!("resized = {:?}", planned.step.resized()),
        ];
        for file in planned.step.files() {
            lines.push(format!("file = {}", contents(&file)?));
        }
        if planned.entry.stage == Stage::Grow {
            lines.push(format!("grown = {grown}"));
        }
        for name in self.read_by(planned, landscape) {
            let from = self.layers.get(&name).map_or("none", String::as_str);
            lines.push(format!("layer = {name:?} {from}"));
        }
        Ok(lines.join("\n"))
    }

    /// Layers that a step may read. A simulation may look at any; all else says what it reads.
    fn read_by(&self, planned: &Planned, landscape: &Landscape) -> Vec<String> {
        let mut names = planned.step.reads();
        names.extend(planned.step.reads_where_there());
        if planned.entry.stage == Stage::Erode || planned.step.resized().is_some() {
            names.extend(self.layers.keys().cloned());
        }
        if planned.step.layered() != Layered::Never {
            names.extend(layer_names(&landscape.materials).map(str::to_owned));
            names.extend([BEDROCK, REGOLITH].map(str::to_owned));
        }
        names.sort();
        names.dedup();
        names
    }

    /// Says that what differs between two landscapes follows from a text and all that was there.
    pub(super) fn hold(&mut self, text: &str, landscapes: [&Landscape; 2]) {
        let all = format!("{text}\n{}\n{}\n{}\n{:?}", self.program, self.grid, self.declared, self.layers);
        self.follow(&all, landscapes);
    }

    /// Says that what differs between two landscapes follows from a text.
    pub(super) fn follow(&mut self, text: &str, [before, after]: [&Landscape; 2]) {
        let text = hash(text);
        let other_grid = before.domain != after.domain;
        if other_grid {
            self.grid = hash(&format!("grid of {text}"));
        }
        self.layers.retain(|name, _| after.layer(name).is_ok());
        for (name, _) in after.layers() {
            if other_grid || !after.shares_layer(before, name) {
                self.layers.insert(name.to_owned(), hash(&format!("{name:?} of {text}")));
            }
        }
        if grown_differs(before, after) {
            self.grown = hash(&format!("grown of {text} on {}", self.grown));
        }
    }
}

/// Whether plants or grass differ, or may do.
pub(super) fn grown_differs(before: &Landscape, after: &Landscape) -> bool {
    let plants = |landscape: &Landscape| -> Vec<_> {
        let all =
            landscape.all_plants().map(|(name, plants)| (name.to_owned(), std::sync::Arc::as_ptr(plants)));
        all.collect()
    };
    let meadows = |landscape: &Landscape| -> Vec<_> {
        let all =
            landscape.all_meadows().map(|(name, meadow)| (name.to_owned(), std::sync::Arc::as_ptr(&meadow)));
        all.collect()
    };
    plants(before) != plants(after) || meadows(before) != meadows(after)
}
