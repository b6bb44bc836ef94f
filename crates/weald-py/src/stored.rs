//! What Python keeps of a landscape to make it again, and what steps report, in words that Python reads.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;
use weald::Landscape;
use weald::grow::Vegetation;
use weald::material::Material;
use weald::recipe::{BudgetReport, Overrides, Recipe, pack_landscape, unpack_landscape};
use weald::step::Outcome;

use crate::errors::{exception, usage};

/// Name and text of the recipe whose fractals a landscape carries.
pub(crate) type Origin = (String, String);

/// The landscape as bytes, its materials, and its recipe.
pub(crate) type State<'py> = (Bound<'py, PyBytes>, Materials, Option<Origin>);

/// All that is needed to make a landscape again.
pub(crate) fn state<'py>(py: Python<'py>, landscape: &Landscape, origin: Option<Origin>) -> State<'py> {
    let bytes = py.detach(|| pack_landscape(landscape));
    let materials = landscape.materials.iter().map(MaterialFields::of).collect();
    (PyBytes::new(py, &bytes), Materials(materials), origin)
}

/// The landscape of a state.
pub(crate) fn landscape(
    py: Python<'_>,
    (bytes, materials, origin): State<'_>,
) -> PyResult<(Landscape, Option<Origin>)> {
    let materials = materials.read().map_err(|message| usage(py, message))?;
    let bytes = bytes.as_bytes();
    let made = py.detach(|| {
        let mut landscape = unpack_landscape(bytes)?;
        landscape.materials = materials;
        if let Some((file, text)) = &origin {
            landscape.set_fractals(Recipe::parse(file, text, &Overrides::default())?.make_fractals()?);
        }
        Ok((landscape, origin))
    });
    made.map_err(|error| exception(py, error))
}

/// Materials as Python has them: dictionaries, bedrock first.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) struct Materials(Vec<MaterialFields>);

/// One material; what is not said is that of the built-in one of its name.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct MaterialFields {
    name: String,
    #[pyo3(default)]
    erodibility: Option<f64>,
    #[pyo3(default)]
    solubility: Option<f64>,
    #[pyo3(default)]
    talus_deg: Option<f64>,
    #[pyo3(default)]
    colour: Option<[f32; 3]>,
    #[pyo3(default)]
    thickness: Option<f64>,
    #[pyo3(default)]
    bottom: Option<f64>,
}

impl Materials {
    /// The materials, checked as far as a recipe checks them.
    pub(crate) fn read(&self) -> Result<Vec<Material>, String> {
        let most = weald::material::MAX_MATERIALS;
        let count = self.0.len();
        if !(1..=most).contains(&count) {
            return Err(format!("{count} materials; a landscape has 1 to {most}, bedrock first"));
        }
        self.0.iter().map(MaterialFields::read).collect()
    }
}

impl MaterialFields {
    fn of(material: &Material) -> Self {
        Self {
            name: material.name.clone(),
            erodibility: Some(material.erodibility),
            solubility: Some(material.solubility),
            talus_deg: Some(material.talus_deg),
            colour: Some(material.colour),
            thickness: Some(material.thickness),
            bottom: material.bottom,
        }
    }

    fn read(&self) -> Result<Material, String> {
        let name = &self.name;
        let usual = Material::built_in(name).or_else(|| Material::built_in("rock"));
        let usual = usual.expect("rock is built in");
        let within = |key: &str, value: Option<f64>, usual: f64, most: f64| match value.unwrap_or(usual) {
            value if (0.0..=most).contains(&value) => Ok(value),
            value => Err(format!("material `{name}`: `{key}` is {value}, outside its range: 0 to {most}")),
        };
        Ok(Material {
            name: name.clone(),
            erodibility: within("erodibility", self.erodibility, usual.erodibility, 1.0)?,
            solubility: within("solubility", self.solubility, usual.solubility, 1.0)?,
            talus_deg: within("talus_deg", self.talus_deg, usual.talus_deg, 90.0)?,
            colour: self.colour.unwrap_or(usual.colour),
            thickness: within("thickness", self.thickness, usual.thickness, 1.0e5)?,
            bottom: self.bottom,
        })
    }
}

/// The materials as dictionaries.
pub(crate) fn materials<'py>(py: Python<'py>, all: &[Material]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    all.iter().map(|material| MaterialFields::of(material).into_pyobject(py)).collect()
}

/// What a step reports, as JSON with the names of `report.json`.
pub(crate) fn outcome(outcome: &Outcome) -> String {
    let budget = outcome.budget.map(BudgetReport::from);
    json!({
        "iterations": outcome.iterations,
        "budget": budget,
        "measures": outcome.measures,
        "notes": outcome.notes,
    })
    .to_string()
}
