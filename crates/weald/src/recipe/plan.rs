//! The checked recipe. Nothing runs before the whole of it has been checked, and one look shows all faults.

mod files;
mod films;
mod finest_ground;
mod fractals;
mod grids;
mod landscape;
mod layers;
mod materials;
mod names;
mod numbers;
mod outputs;
mod steps;
#[cfg(test)]
mod tests;
mod treatments;
mod unknown_keys;
mod words;

pub(super) use self::words::Vocabulary;
use std::cell::RefCell;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

pub use films::{EXTENSIONS as FILM_EXTENSIONS, Film, FilmKeys, Motion};
pub use fractals::{FractalKeys, FractalSource, PlannedFractal, PlantRole};
pub use landscape::{Ground, LandscapeKeys};
pub use materials::{BuiltIn, MaterialKeys, PlannedMaterial};
pub(super) use names::{Name, WORK_FOLDER};
pub use outputs::{Content, Output, OutputKeys};
pub(in crate::recipe) use steps::OFF;
pub use steps::Planned;

use self::files::Files;
use self::layers::Made;
use super::canonical;
use super::format;
use super::overrides::Overrides;
use super::parameter::Diagnostics;
use super::source::{self, Table};
use weald_core::domain::Domain;
use weald_core::error::{Diagnostic, Error, RecipeError};
use weald_core::files::File;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_export::{Export, report};

/// A recipe that can run.
#[derive(Debug)]
pub struct Recipe {
    /// Name of the recipe file, as the user gave it.
    pub file: String,
    /// What the landscape starts from.
    pub ground: Ground,
    /// Height of the sea in metres, where there is one.
    pub sea_level: Option<f64>,
    /// Seed of the landscape.
    pub seed: u64,
    /// What the ground is made of, bedrock first.
    pub materials: Vec<PlannedMaterial>,
    /// Plants and sets that outputs name.
    pub fractals: Vec<PlannedFractal>,
    /// What is done, in order.
    pub steps: Vec<Planned>,
    /// What is written at the end.
    pub outputs: Vec<Output>,
    /// How many of its first steps run on the finest grid.
    on_finest: usize,
    /// Files that it names, with the line of the key.
    named: Vec<(PathBuf, usize)>,
    text: String,
}

impl Recipe {
    /// All files that a run reads beside the recipe.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let ground = match &self.ground {
            Ground::File { path, .. } => Some(path.clone()),
            Ground::Empty { .. } => None,
        };
        let materials = self.materials.iter().filter_map(|planned| Some(planned.file.as_ref()?.0.clone()));
        let steps = self.steps.iter().flat_map(|planned| planned.step.files());
        let flames = self.fractals.iter().filter_map(|planned| match &planned.fractal_source {
            FractalSource::Flame { path, .. } => Some(path.clone()),
            FractalSource::Known(_) => None,
        });
        ground.into_iter().chain(materials).chain(flames).chain(steps).collect()
    }

    /// The place in the recipe that names a file, as `land.toml:7`.
    pub fn place_of(&self, input: &Path) -> String {
        match self.named.iter().find(|(path, _)| path == input) {
            Some((_, line)) if *line > 0 => format!("{}:{line}", self.file),
            _ => self.file.clone(),
        }
    }

    /// Reads and checks the recipe in a file. No other file is opened.
    ///
    /// # Errors
    /// As [`Recipe::parse`], and [`Error::Recipe`] for a file that cannot be read.
    pub fn load(path: &Path, overrides: &Overrides) -> Result<Self, Error> {
        Self::parse(&path.display().to_string(), &Self::text_of(path)?, overrides)
    }

    /// The text of a recipe in a file.
    ///
    /// # Errors
    /// [`RecipeError`] for a file that cannot be read.
    pub fn text_of(path: &Path) -> Result<String, RecipeError> {
        read_text(path).map_err(|cause| {
            let message = format!("the recipe cannot be read: {cause}{}", remedy(cause.kind()));
            let file = path.display().to_string();
            RecipeError { file, diagnostics: vec![Diagnostic { line: Diagnostic::NO_LINE, message }] }
        })
    }

    /// A recipe that was put together as a table.
    pub(super) fn of_table(file: &str, table: &Table) -> Result<Self, Error> {
        Self::checked(&Vocabulary::FULL, file, table, Diagnostics::default())
    }

    /// The same of one that was read from a file, with the complaints about its changes.
    pub(super) fn of_changed_table(
        file: &str,
        table: &Table,
        diagnostics: Diagnostics,
    ) -> Result<Self, Error> {
        Self::checked(&Vocabulary::FULL, file, table, diagnostics)
    }

    /// Reads and checks a recipe. `file` is its name; paths in it are relative to the folder of that name. No
    /// file is opened.
    ///
    /// # Errors
    /// [`Error::Recipe`] with all faults in the order of their lines; [`Error::Limit`] for a grid too large.
    pub fn parse(file: &str, text: &str, overrides: &Overrides) -> Result<Self, Error> {
        Self::parse_with(&Vocabulary::FULL, file, text, overrides)
    }

    pub(super) fn parse_with(
        vocabulary: &Vocabulary,
        file: &str,
        text: &str,
        overrides: &Overrides,
    ) -> Result<Self, Error> {
        let mut table = source::parse(file, text)?;
        let mut diagnostics = Diagnostics::default();
        overrides.apply(&mut table, &mut diagnostics);
        let recipe = Self::planned(vocabulary, file, &table, diagnostics)?;
        recipe.check_on_its_grid(overrides.larger_than_memory)?;
        Ok(recipe)
    }

    fn checked(
        vocabulary: &Vocabulary,
        file: &str,
        table: &Table,
        diagnostics: Diagnostics,
    ) -> Result<Self, Error> {
        let recipe = Self::planned(vocabulary, file, table, diagnostics)?;
        recipe.check_on_its_grid(false)?;
        Ok(recipe)
    }

    /// Checks what depends on the grid, where the recipe says it.
    fn check_on_its_grid(&self, may_be_larger_than_memory: bool) -> Result<(), Error> {
        let Ground::Empty { size, cell, finest } = self.ground else { return Ok(()) };
        let first = self.first_grid(size, cell, finest);
        if !may_be_larger_than_memory {
            Size::new(first.size.columns, first.size.rows)?;
        }
        self.check_on(&first)
    }

    /// The grid that the first step finds, for cells of a length in metres and the finest grid.
    pub(super) fn first_grid(&self, size: Size, cell: f64, finest: Option<Size>) -> Domain {
        let first = match finest {
            Some(finest) if self.on_finest > 0 => finest_ground::grid(size, cell, finest),
            _ => Domain { finest, ..Domain::new(size, cell) },
        };
        Domain { sea_level: self.sea_level, ..first }
    }

    /// The landscape after so many steps on the recipe's grid, whatever grid they have left it on.
    pub(super) fn on_own_grid(&self, steps: usize, landscape: Landscape) -> Result<Landscape, Error> {
        if steps >= self.on_finest {
            Ok(landscape)
        } else {
            finest_ground::on_own_grid(&self.ground, landscape)
        }
    }

    /// What a table says, before it is known on which grid.
    fn planned(
        vocabulary: &Vocabulary,
        file: &str,
        table: &Table,
        mut diagnostics: Diagnostics,
    ) -> Result<Self, Error> {
        let recipe = check(vocabulary, file, table, &mut diagnostics);
        if !diagnostics.found.is_empty() {
            diagnostics.found.sort_by_key(|diagnostic| diagnostic.line);
            return Err(RecipeError { file: file.to_owned(), diagnostics: diagnostics.found }.into());
        }
        recipe
    }

    /// Names of all files that a run may write, beside its report: a line for each, and one for all frames of a film.
    pub fn names(&self) -> Vec<String> {
        let names = self.outputs.iter().flat_map(|output| output.names(&self.steps));
        names.map(|name| name.to_string()).collect()
    }

    /// The recipe in its canonical spelling, after overrides: a recipe that gives the same run.
    pub fn effective(&self) -> &str {
        &self.text
    }

    /// The recipe with one output alone: a page about the run, with the keys of the recipe's own page if it has one.
    /// The hash stays that of the recipe as written.
    ///
    /// # Errors
    /// [`Error::Recipe`] where nothing makes the layer `height`, which a page needs that no recipe describes.
    pub fn for_page(mut self, file: &Path) -> Result<Self, Error> {
        let is_page = |output: &Output| matches!(output.content, Content::Export { name, .. } if name == report::ENTRY.name);
        let mut outputs = std::mem::take(&mut self.outputs);
        let own = outputs.iter().position(is_page).map(|at| outputs.swap_remove(at));
        let page = own.map_or_else(|| self.usual_page(), Ok)?;
        self.outputs = vec![Output { file: file.to_owned(), ..page }];
        Ok(self)
    }

    fn usual_page(&self) -> Result<Output, Error> {
        let page = report::Page::default();
        if let Some(message) = page.left_out(Path::new("")) {
            return Err(self.refused(message));
        }
        let name = &page.of.0;
        let written = self.steps.iter().flat_map(|planned| planned.step.writes());
        let is_there = matches!(self.ground, Ground::File { .. })
            || written.into_iter().any(|(layer, _)| layer == *name);
        if !is_there {
            return Err(self.refused(format!(
                "a page needs layer `{name}`, which no step writes; an [[output]] with export = \"report\" can say `of` \
                 which layer of heights it is"
            )));
        }
        let content = Content::Export { name: report::ENTRY.name, export: Box::new(page) };
        Ok(Output { line: 0, file: PathBuf::new(), content })
    }

    /// The fault of the recipe as a whole.
    fn refused(&self, message: String) -> Error {
        let diagnostics = vec![Diagnostic { line: 1, message }];
        RecipeError { file: self.file.clone(), diagnostics }.into()
    }

    /// Whether another recipe is the same up to a step: ground, materials, and so many steps with their keys and places.
    pub(super) fn begins_as(&self, other: &Self, steps: usize) -> bool {
        let start = |recipe: &Self| {
            let steps = recipe.steps.iter().take(steps);
            let steps: Vec<_> = steps
                .map(|planned| {
                    format!(
                        "{} {} {} {:?}",
                        planned.place, planned.occurrence, planned.entry.name, planned.step
                    )
                })
                .collect();
            // The lines on which things stand are no part of what they are.
            let materials: Vec<_> =
                recipe.materials.iter().map(|planned| format!("{:?}", planned.material)).collect();
            let files: Vec<_> =
                recipe.materials.iter().map(|planned| format!("{:?}", planned.file)).collect();
            (recipe.seed, format!("{:?}", recipe.ground), materials, files, steps)
        };
        let reads_files = self.steps.iter().take(steps).any(|planned| !planned.step.files().is_empty());
        self.steps.len() >= steps && other.steps.len() >= steps && !reads_files && start(self) == start(other)
    }

    /// BLAKE3 hash of [`Recipe::effective`], in hexadecimal.
    pub fn hash(&self) -> String {
        blake3::hash(self.text.as_bytes()).to_hex().to_string()
    }
}

/// What to do about a recipe that cannot be read, as far as the cause tells.
fn remedy(cause: ErrorKind) -> &'static str {
    match cause {
        ErrorKind::NotFound => "; `weald new NAME` writes one to start from",
        ErrorKind::IsADirectory => "; give the recipe in it",
        ErrorKind::InvalidData => "; save it as UTF-8 text",
        _ => "",
    }
}

/// The text of a file, of which no more is read than shows that it is too long.
fn read_text(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(source::MAX_BYTES as u64 + 1).read_to_string(&mut text)?;
    Ok(text)
}

/// Reads all sections, whatever is wrong with one of them. The result counts only without complaints.
fn check(
    vocabulary: &Vocabulary,
    file: &str,
    recipe: &Table,
    diagnostics: &mut Diagnostics,
) -> Result<Recipe, Error> {
    diagnostics.subject.clear();
    let recipe = &format::with_new_names(recipe, diagnostics);
    diagnostics.subject.clear();
    format::check(recipe, diagnostics);
    diagnostics.unknown_keys(recipe, &[format::KEY, "landscape", "material", "fractal", "step", "output"]);
    let named = RefCell::new(Vec::new());
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let files = Files { vocabulary, folder, named: &named };
    let start = landscape::read(files, recipe, diagnostics);
    let before = diagnostics.found.len();
    let materials = materials::read(files, recipe, diagnostics);
    let materials_understood = diagnostics.found.len() == before;
    let before = diagnostics.found.len();
    let fractals = fractals::read(files, recipe, diagnostics);
    let fractals_understood = diagnostics.found.len() == before;
    let (mut steps, all_understood) = steps::read(files, recipe, diagnostics);
    let outputs = outputs::read(vocabulary, recipe, diagnostics);
    if fractals_understood {
        fractals::check_names(&fractals, &steps, &outputs, diagnostics);
    }
    diagnostics.subject.clear();
    if recipe.get("output").is_none() {
        diagnostics.add(1, "a recipe needs an [[output]] table, or its run would leave nothing behind");
    }
    if let (true, Ok(ground)) = (all_understood && materials_understood, &start.ground) {
        let made = Made { ground, sea: start.sea_level.is_some(), materials: &materials, steps: &steps };
        layers::check(&made, &outputs, diagnostics);
        numbers::check(made.steps, &outputs, diagnostics);
    }
    if all_understood {
        names::check(&outputs, &steps, diagnostics);
    }
    if materials_understood {
        steps::check_materials(&steps, &materials, diagnostics);
    }
    steps::check_sizes(&steps)?;
    let text = format!("{} = {}\n{}", format::KEY, format::NEWEST, canonical::text(recipe));
    let (file, named) = (file.to_owned(), named.into_inner());
    let (ground, seed, sea_level) = (start.ground?, start.seed, start.sea_level);
    let on_finest = finest_ground::run_on_finest(&ground, &mut steps, &materials);
    Ok(Recipe { file, ground, sea_level, seed, materials, fractals, steps, outputs, on_finest, named, text })
}
