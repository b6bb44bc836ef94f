//! A landscape: one domain and the named layers on it.

use std::collections::BTreeMap;

use crate::domain::Domain;
use crate::error::Error;
use crate::grid::Field;
use crate::grow::Fractal;
use crate::material::Material;

/// A named field with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Unit of the values: `m`, `m/step`, `1` …
    pub unit: String,
    /// One value a cell.
    pub field: Field,
}

/// A domain and its layers. Layers come out in the order of their names, whatever the order they went in.
#[derive(Clone, Debug, PartialEq)]
pub struct Landscape {
    /// Grid, cell size, georeference, mask.
    pub domain: Domain,
    /// What the ground is made of, bedrock first: 1 to [`MOST`](crate::material::MOST).
    pub materials: Vec<Material>,
    /// The fractals of the recipe; built-in ones are there without.
    pub fractals: Vec<Fractal>,
    layers: BTreeMap<String, Layer>,
}

impl Landscape {
    /// A landscape without layers, of the default materials.
    pub fn new(domain: Domain) -> Self {
        Self { domain, materials: Material::default_stack(), fractals: Vec::new(), layers: BTreeMap::new() }
    }

    /// Adds or replaces a layer.
    ///
    /// # Panics
    /// If the field's size is not the domain's: a bug of the caller.
    pub fn insert(&mut self, name: &str, unit: &str, field: Field) {
        assert_eq!(field.size(), self.domain.size, "a layer has the size of its domain");
        self.layers.insert(name.to_owned(), Layer { unit: unit.to_owned(), field });
    }

    /// The layer of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the layers that exist.
    pub fn layer(&self, name: &str) -> Result<&Layer, Error> {
        self.layers.get(name).ok_or_else(|| {
            let known: Vec<_> = self.layers.keys().map(String::as_str).collect();
            Error::Run(format!("there is no layer `{name}`; the landscape has: {}", known.join(", ")))
        })
    }

    /// The field of the layer of that name.
    ///
    /// # Errors
    /// As [`Landscape::layer`].
    pub fn field(&self, name: &str) -> Result<&Field, Error> {
        Ok(&self.layer(name)?.field)
    }

    /// Takes a layer out.
    pub fn remove(&mut self, name: &str) -> Option<Layer> {
        self.layers.remove(name)
    }

    /// All layers in the order of their names.
    pub fn layers(&self) -> impl Iterator<Item = (&str, &Layer)> {
        self.layers.iter().map(|(name, layer)| (name.as_str(), layer))
    }
}
