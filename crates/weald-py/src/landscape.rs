//! A landscape as Python holds it.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::PyArray2;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use weald::Error;
use weald::prelude::LandscapeExt;

use crate::arrays;
use crate::calls;
use crate::domain::Place;
use crate::engines::Call;
use crate::errors::{exception, usage};
use crate::export;
use crate::plants;
use crate::stored::{self, Materials, Origin};
use crate::watch::{Caller, Line, watched};

/// Most frames of a film.
const MOST_FRAMES: u64 = 10_000;

/// A landscape: its grid, its layers, what grows on it. Methods that take time work on a copy, which shares its layers, and
/// take its place when they are done.
#[pyclass(frozen, subclass, module = "weald._weald")]
pub(crate) struct Landscape {
    held: Mutex<weald::Landscape>,
    /// The recipe whose fractals it carries.
    pub(crate) origin: Mutex<Option<Origin>>,
    busy: AtomicBool,
}

impl Landscape {
    pub(crate) fn of(landscape: weald::Landscape, origin: Option<Origin>) -> Self {
        Self { held: Mutex::new(landscape), origin: Mutex::new(origin), busy: AtomicBool::new(false) }
    }

    /// A panic elsewhere leaves it whole: it is only ever replaced.
    pub(crate) fn held(&self) -> MutexGuard<'_, weald::Landscape> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn origin(&self) -> Option<Origin> {
        self.origin.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Does something that changes the landscape, alone.
    fn change<T>(&self, py: Python<'_>, change: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
        if self.busy.swap(true, Ordering::Acquire) {
            return Err(usage(py, "another call is changing this landscape; give each thread a copy()"));
        }
        let result = change();
        self.busy.store(false, Ordering::Release);
        result
    }
}

#[pymethods]
impl Landscape {
    /// A landscape of one layer, `height`, or a copy of another landscape.
    #[new]
    #[pyo3(signature = (height, place=None, mask=None))]
    fn new(
        height: &Bound<'_, PyAny>,
        place: Option<Place>,
        mask: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = height.py();
        if let Ok(other) = height.cast::<Self>() {
            return Ok(Self::of(other.get().held().clone(), other.get().origin()));
        }
        let Some(place) = place else { return Err(usage(py, "give the place of the array")) };
        let taken = arrays::taken(height)?;
        let mut domain = place.domain(taken.field.size()).map_err(|error| exception(py, error))?;
        let mask = mask.map(|mask| arrays::taken_flags(mask, domain.size)).transpose()?.flatten();
        domain.valid = match (mask, taken.finite) {
            (Some(one), Some(other)) => {
                let both = one.flags().iter().zip(other.flags()).map(|(one, other)| *one && *other);
                weald::grid::Mask::new(domain.size, both.collect())
            }
            (one, other) => one.or(other),
        };
        if domain.valid_cells() == 0 {
            return Err(usage(py, "no cell of the array holds data, so there is no ground to work on"));
        }
        let mut landscape = weald::Landscape::new(domain);
        landscape.insert("height", "m", taken.field);
        Ok(Self::of(landscape, None))
    }

    /// A landscape without layers.
    #[staticmethod]
    fn make_empty(py: Python<'_>, columns: usize, rows: usize, cell: f64) -> PyResult<Self> {
        let landscape = <weald::Landscape as LandscapeExt>::empty(columns, rows, cell);
        landscape.map(|made| Self::of(made, None)).map_err(|error| exception(py, error))
    }

    /// The ground of a raster file, and notes on what was done to it.
    #[staticmethod]
    #[pyo3(signature = (path, cell=None))]
    fn open_file(py: Python<'_>, path: PathBuf, cell: Option<f64>) -> PyResult<(Self, Vec<String>)> {
        let caller = Caller { callback: None, threads: None };
        let opened = watched(py, &caller, move |_| weald::Landscape::open_with(path, cell))?;
        Ok((Self::of(opened.0, None), opened.1))
    }

    /// Names of all layers, in order.
    fn names(&self) -> Vec<String> {
        self.held().layers().map(|(name, _)| name.to_owned()).collect()
    }

    /// The unit of a layer.
    fn unit(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        let held = self.held();
        held.layer(name).map(|layer| layer.unit.clone()).map_err(|error| no_layer(py, &error))
    }

    /// A layer, whose memory the array shares.
    fn lent<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let held = self.held();
        held.layer(name).map_err(|error| no_layer(py, &error))?;
        arrays::lent(py, &held, name)
    }

    /// Adds or replaces a layer.
    fn put(&self, name: &str, unit: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = values.py();
        let field = arrays::taken(values)?;
        self.change(py, || {
            let mut held = self.held();
            let size = held.domain.size;
            if field.field.size() != size {
                let given = field.field.size();
                return Err(usage(py, format!("`{name}` has {given} cells; the landscape has {size}")));
            }
            let outside = |finite: &weald::grid::Mask| {
                let valid = held.domain.valid.as_ref();
                (0..size.cells())
                    .find(|&at| !finite.is_valid_at(at) && valid.is_none_or(|valid| valid.is_valid_at(at)))
            };
            if let Some(at) = field.finite.as_ref().and_then(outside) {
                let (x, y) = (at % size.columns, at / size.columns);
                return Err(usage(
                    py,
                    format!("`{name}` is not finite at column {x}, row {y}, which holds data"),
                ));
            }
            held.insert(name, unit, field.field);
            Ok(())
        })
    }

    /// Takes a layer out.
    fn remove(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.change(py, || {
            let mut held = self.held();
            held.layer(name).map_err(|error| no_layer(py, &error))?;
            held.remove(name);
            Ok(())
        })
    }

    /// Which cells hold data.
    fn valid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<bool>>> {
        arrays::flags(py, &self.held().domain)
    }

    /// Whether there are cells without data.
    #[getter]
    fn masked(&self) -> bool {
        self.held().domain.valid.is_some()
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        let size = self.held().domain.size;
        (size.rows, size.columns)
    }

    /// Width of a cell in metres.
    #[getter]
    fn cell(&self) -> f64 {
        self.held().domain.cell
    }

    /// Height of the sea in metres; `None` without one.
    #[getter]
    fn sea_level(&self) -> Option<f64> {
        self.held().domain.sea_level
    }

    /// Gives the landscape a sea of that height in metres, or none; it stands at once in `water` and `sea_depth`.
    #[setter]
    fn set_sea_level(&self, py: Python<'_>, level: Option<f64>) -> PyResult<()> {
        if let Some(level) = level.filter(|level| !level.is_finite()) {
            return Err(usage(
                py,
                format!("`sea_level` is {level}, but must be a height in metres, or None"),
            ));
        }
        self.change(py, || {
            let mut landscape = self.held().clone();
            landscape.domain.sea_level = level;
            weald::sea::stand(&mut landscape).map_err(|error| usage(py, error.to_string()))?;
            *self.held() = landscape;
            Ok(())
        })
    }

    /// EPSG code, origin and pixel; `None` for a landscape that lies nowhere.
    #[getter]
    fn place(&self) -> Option<(Option<u32>, [f64; 2], [f64; 2])> {
        self.held().domain.georeference.as_ref().map(|place| (place.epsg, place.origin, place.pixel))
    }

    /// Whether its file named a CRS that has no EPSG code.
    #[getter]
    fn has_crs_without_code(&self) -> bool {
        let held = self.held();
        held.domain.georeference.as_ref().is_some_and(|place| place.epsg.is_none() && place.keys.is_some())
    }

    /// What the ground is made of, bedrock first.
    #[getter]
    fn materials<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        stored::materials(py, &self.held().materials)
    }

    /// Makes the ground of other materials, bedrock first.
    #[setter]
    fn set_materials(&self, py: Python<'_>, materials: Materials) -> PyResult<()> {
        let materials = materials.read().map_err(|message| usage(py, message))?;
        self.change(py, || {
            self.held().materials = materials;
            Ok(())
        })
    }

    /// Runs a step of the catalogue; gives what it reports, as JSON, and the names of the layers that it wrote.
    fn run_step(
        &self,
        name: &str,
        keys: &Bound<'_, PyDict>,
        seed: u64,
        call: Call,
    ) -> PyResult<(String, Vec<String>)> {
        let (py, Call { engine, caller }) = (keys.py(), call);
        let step = calls::step(calls::entry(py, name)?, keys)?;
        self.change(py, || {
            let mut landscape = self.held().clone();
            let work = move |line: &Line| {
                let engine = engine.open(line)?;
                let outcome = calls::run(&*step, &mut landscape, (seed, engine), line)?;
                let written = calls::written(&*step, &landscape);
                Ok((landscape, outcome, written))
            };
            let (landscape, outcome, written) = watched(py, &caller, work)?;
            *self.held() = landscape;
            Ok((stored::outcome(&outcome), written))
        })
    }

    /// Paints a stroke; gives cubic metres of ground added and taken, and of water added and taken.
    fn paint_stroke(&self, keys: &Bound<'_, PyDict>) -> PyResult<(f64, f64, f64, f64)> {
        let py = keys.py();
        self.change(py, || {
            let mut landscape = self.held().clone();
            let materials: Vec<_> = landscape.materials.iter().map(|one| one.name.clone()).collect();
            let brush = export::brush(keys, &materials)?;
            let work = move |_: &Line| landscape.paint(&brush).map(|volumes| (landscape, volumes));
            let (landscape, volumes) = watched(py, &Caller { callback: None, threads: None }, work)?;
            *self.held() = landscape;
            Ok((volumes.solid_added, volumes.solid_removed, volumes.water_added, volumes.water_removed))
        })
    }

    /// Draws a picture: PNG, or SVG where that is asked for.
    #[pyo3(signature = (kind, keys, svg=false, threads=None))]
    fn draw<'py>(
        &self,
        kind: &str,
        keys: &Bound<'py, PyDict>,
        svg: bool,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let picture = export::picture(kind, keys)?;
        let (py, landscape) = (keys.py(), self.held().clone());
        let work = move |line: &Line| export::drawn(&*picture, &landscape, svg, line);
        let bytes = watched(py, &Caller { callback: None, threads }, work)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Draws a film that turns around the landscape or moves in the wind: an animated PNG.
    fn draw_film<'py>(
        &self,
        kind: &str,
        keys: &Bound<'py, PyDict>,
        frames: u64,
        frames_per_second: f64,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let py = keys.py();
        if !(2..=MOST_FRAMES).contains(&frames) || !(0.1..=100.0).contains(&frames_per_second) {
            let message = format!(
                "{frames} frames, {frames_per_second} a second; a film has 2 to {MOST_FRAMES}, 0.1 to 100 a second"
            );
            return Err(usage(py, message));
        }
        let (picture, landscape) = (export::picture(kind, keys)?, self.held().clone());
        let work = move |line: &Line| export::film(&*picture, &landscape, (frames, frames_per_second), line);
        let bytes = watched(py, &Caller { callback: None, threads: None }, work)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes files for other programs, and gives their names and what is to be known of them.
    #[pyo3(signature = (kind, path, keys, threads=None))]
    fn export_files(
        &self,
        kind: &str,
        path: PathBuf,
        keys: &Bound<'_, PyDict>,
        threads: Option<usize>,
    ) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
        let export = export::export(kind, keys)?;
        let landscape = self.held().clone();
        let work = move |_: &Line| export::written(&*export, &landscape, &path);
        watched(keys.py(), &Caller { callback: None, threads }, work)
    }

    /// Writes a layer into a raster file.
    fn save_layer(&self, py: Python<'_>, layer: String, path: PathBuf) -> PyResult<()> {
        let landscape = self.held().clone();
        let caller = Caller { callback: None, threads: None };
        watched(py, &caller, move |_| landscape.save(&layer, path))
    }

    /// Names of all plants, each with what they are and how far apart they stand.
    fn plant_names(&self) -> Vec<(String, String, f64)> {
        let held = self.held();
        let plants = held.all_plants().map(|(name, all)| (name.to_owned(), all.kind.clone(), all.spacing));
        plants.collect()
    }

    /// A column for each number of the plants of that name.
    fn plant_columns<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let found = self.held().plants(name).cloned().map_err(|error| exception(py, error))?;
        plants::columns(py, &found)
    }

    /// All that is needed to make it again, to the bit.
    fn state<'py>(&self, py: Python<'py>) -> stored::State<'py> {
        let (landscape, origin) = (self.held().clone(), self.origin());
        stored::state(py, &landscape, origin)
    }

    /// The landscape of such a state.
    #[staticmethod]
    fn of_state(py: Python<'_>, state: stored::State<'_>) -> PyResult<Self> {
        let (landscape, origin) = stored::landscape(py, state)?;
        Ok(Self::of(landscape, origin))
    }

    /// Whether both have the same grid, layers, plants and materials, to the bit.
    fn equals(&self, other: &Self) -> bool {
        let other = other.held().clone();
        *self.held() == other
    }
}

/// Python asks a mapping for what it does not have by `KeyError`.
fn no_layer(_: Python<'_>, error: &Error) -> PyErr {
    PyKeyError::new_err(error.to_string())
}
