//! Recipes as Python holds them, and their runs.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use weald::recipe::{FractalRequest, Options, Overrides, Report, Run};

use crate::engines::{Call, drawing};
use crate::errors::exception;
use crate::landscape::Landscape;
use crate::stored::Origin;
use crate::watch::{Line, watched};

/// A checked recipe.
#[pyclass(frozen, subclass, module = "weald._weald")]
pub(crate) struct Recipe {
    recipe: Arc<weald::recipe::Recipe>,
}

/// Changes to a recipe, as the command line has them.
#[derive(FromPyObject)]
struct Changes {
    #[pyo3(item)]
    size: Option<u64>,
    #[pyo3(item)]
    preview: bool,
    #[pyo3(item)]
    seed: Option<u64>,
    #[pyo3(item)]
    set: Vec<(String, String)>,
}

/// How a recipe is run.
#[derive(FromPyObject)]
struct How {
    #[pyo3(item)]
    out: PathBuf,
    #[pyo3(item)]
    write: bool,
    #[pyo3(item)]
    resume: bool,
    #[pyo3(item)]
    memory: Option<u64>,
}

#[pymethods]
impl Recipe {
    /// Reads and checks a recipe; `file` is its name, and paths in it start at the folder of that name.
    #[new]
    fn new(py: Python<'_>, file: &str, text: &str, changes: Changes) -> PyResult<Self> {
        let Changes { size, preview, seed, set } = changes;
        let overrides = Overrides { size, preview, seed, set, ..Overrides::default() };
        let recipe = weald::recipe::Recipe::parse(file, text, &overrides);
        recipe.map(Self::of).map_err(|error| exception(py, error))
    }

    /// Name of its file.
    #[getter]
    fn file(&self) -> &str {
        &self.recipe.file
    }

    /// The recipe in its canonical spelling, after all changes.
    #[getter]
    fn text(&self) -> &str {
        self.recipe.effective()
    }

    /// BLAKE3 hash of the text, in hexadecimal.
    #[getter]
    fn hash(&self) -> String {
        self.recipe.hash()
    }

    /// Seed of the landscape.
    #[getter]
    fn seed(&self) -> u64 {
        self.recipe.seed
    }

    /// Names of the steps in their order.
    #[getter]
    fn steps(&self) -> Vec<&'static str> {
        self.recipe.steps.iter().map(|planned| planned.entry.name).collect()
    }

    /// Names of the files that a run writes, beside its report.
    #[getter]
    fn files(&self) -> Vec<String> {
        self.recipe.names()
    }

    /// Opens the files that it names and gives what a run would tell, and the bytes of memory that it would take.
    fn look_ahead(&self, py: Python<'_>) -> PyResult<(Vec<String>, u64)> {
        let looked = py.detach(|| self.recipe.look_ahead()).map_err(|error| exception(py, error))?;
        Ok((looked.notes, looked.memory.bytes))
    }

    /// Runs it; gives the landscape, unless a run that was done is only looked up, and the report as JSON.
    fn execute(&self, py: Python<'_>, how: How, call: Call) -> PyResult<(Option<Landscape>, String)> {
        let How { out, write, resume, memory } = how;
        let Call { engine, caller } = call;
        let threads = caller.threads;
        let recipe = Arc::clone(&self.recipe);
        let draws = recipe.outputs.iter().any(|output| output.render().is_some());
        let work = move |line: &Line| {
            let engine = engine.open(line)?;
            let (adapter, engine_name) = (engine.adapter(), engine.name().to_owned());
            let render = (write && draws).then(drawing);
            let options = Options { engine, threads, resume, memory, render, ..Options::into_folder(out) };
            let run = Run { recipe: &recipe, options };
            let report = if write { Some(run.execute(line)?) } else { run.landscape(line).map(|_| None)? };
            let (landscape, steps) = line.made().unzip();
            let report = report.unwrap_or_else(|| Report {
                engine: engine_name,
                adapter,
                seed: recipe.seed,
                recipe_blake3: recipe.hash(),
                version: env!("CARGO_PKG_VERSION").to_owned(),
                steps: steps.unwrap_or_default(),
                outputs: Vec::new(),
                notes: Vec::new(),
            });
            Ok((landscape, report))
        };
        let (landscape, report) = watched(py, &caller, work)?;
        let report = serde_json::to_string(&report).expect("numbers, texts and lists are JSON");
        Ok((landscape.map(|made| Landscape::of(made, self.origin())), report))
    }
}

impl Recipe {
    fn of(recipe: weald::recipe::Recipe) -> Self {
        Self { recipe: Arc::new(recipe) }
    }

    /// What a landscape of it must remember.
    pub(crate) fn origin(&self) -> Option<Origin> {
        let has_fractals = !self.recipe.fractals.is_empty();
        has_fractals.then(|| (self.recipe.file.clone(), self.recipe.effective().to_owned()))
    }
}

/// The recipe of files of one fractal; values are TOML.
#[pyfunction]
pub(crate) fn fractal_recipe(
    py: Python<'_>,
    of: String,
    deform: Vec<(String, String)>,
    outputs: Vec<Vec<(String, String)>>,
) -> PyResult<Recipe> {
    let request = FractalRequest { of, deform, outputs };
    request.recipe().map(Recipe::of).map_err(|error| exception(py, error))
}
